//! The schema of one value.

use engine::params::{ParamSpec, Range};
use engine::units::{self, Dimension};
use serde_json::{Value, json};

use crate::limits;
use crate::reader::{Answer, interval};
use crate::specs;

/// What may stand at a key, and what is said of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Leaf {
    pub(super) answer: Answer,
    pub(super) meaning: String,
    pub(super) default: Option<String>,
}

/// Writes schemas of values.
#[derive(Clone, Copy)]
pub(super) struct Writer {
    /// Whether bare numbers in SI may stand for quantities, as in measurement sets.
    pub(super) takes_bare: bool,
}

impl Writer {
    /// The schema of a key that may hold any of `leaves`.
    pub(super) fn value(self, leaves: &[Leaf]) -> Value {
        let leaves = with_one_choice(leaves);
        let leaves = without_plain_tables(leaves);
        let mut kinds: Vec<(Value, Vec<String>)> = Vec::new();
        for leaf in &leaves {
            let kind = self.constraint(&leaf.answer);
            let says = self.describe(leaf);
            match kinds.iter_mut().find(|(known, _)| *known == kind) {
                Some((_, said)) if said.contains(&says) || says.is_empty() => {}
                Some((_, said)) => said.push(says),
                None => kinds.push((kind, Vec::from_iter((!says.is_empty()).then_some(says)))),
            }
        }
        let mut options =
            kinds.into_iter().map(|(kind, said)| described(kind, &said.join("; or ")));
        let mut value = match (options.next(), options.next()) {
            (Some(only), None) => only,
            (first, second) => {
                let all: Vec<Value> = first.into_iter().chain(second).chain(options).collect();
                json!({ "anyOf": all })
            }
        };
        if let Some(default) = common_default(&leaves) {
            value["default"] = default;
        }
        value
    }

    fn constraint(self, answer: &Answer) -> Value {
        match answer {
            Answer::Number(spec) => self.number(spec),
            Answer::Numbers(spec, length) => {
                let mut list = json!({ "type": "array", "items": self.number(spec) });
                list["minItems"] = json!(length.unwrap_or(1));
                list["maxItems"] = json!(length.unwrap_or(limits::CONDITIONS));
                list
            }
            Answer::Coefficient(spec) => self.coefficient(spec),
            Answer::NumberInUnit(dimension) => {
                json!({ "anyOf": [{ "type": "number" }, quantity(*dimension)] })
            }
            Answer::Integer(range) => {
                json!({ "type": "integer", "minimum": range.start(), "maximum": range.end() })
            }
            Answer::Integers(range) => {
                let one = json!({ "type": "integer", "minimum": 0 });
                let count =
                    json!({ "type": "integer", "minimum": range.start(), "maximum": range.end() });
                json!({ "anyOf": [count, { "type": "array", "items": one, "minItems": 1 }] })
            }
            Answer::Boolean => json!({ "type": "boolean" }),
            Answer::Text => text(),
            Answer::Slug => json!({ "type": "string", "pattern": "^[a-z0-9_-]{1,64}$" }),
            Answer::Texts => json!({ "type": "array", "items": { "type": "string" } }),
            Answer::Choice(words) => json!({ "type": "string", "enum": words }),
            // The object is written by who knows its keys.
            Answer::Table => json!({ "type": "object" }),
            Answer::Tables => json!({ "type": "array" }),
            Answer::TableOrTables => json!({ "type": ["object", "array"] }),
            Answer::Defined(name) => json!({ "$ref": format!("#/definitions/{name}") }),
        }
    }

    fn number(self, spec: &ParamSpec) -> Value {
        match (spec.dimension, self.takes_bare) {
            (Dimension::NONE, _) => number(spec.allowed),
            (dimension, false) => quantity(dimension),
            (dimension, true) => {
                json!({ "anyOf": [number(spec.allowed), quantity(dimension)] })
            }
        }
    }

    fn coefficient(self, spec: &ParamSpec) -> Value {
        let values = json!({ "type": "array", "items": self.number(spec), "minItems": 1 });
        let angles = json!({ "type": "array", "items": self.number(&specs::ANGLE), "minItems": 1 });
        let object = |properties: Value, required: &[&str]| {
            json!({
                "type": "object", "properties": properties, "required": required,
                "additionalProperties": false,
            })
        };
        let formula = described(text(), "a formula in SI");
        json!({ "anyOf": [
            self.number(spec),
            object(json!({ "expression": formula }), &["expression"]),
            object(json!({
                "angle": described(angles, "impact angles below the horizontal, rising"),
                "value": described(values, "one value per angle"),
            }), &["angle", "value"]),
        ] })
    }

    /// The meaning with the ranges, in words.
    fn describe(self, leaf: &Leaf) -> String {
        let (Answer::Number(spec) | Answer::Numbers(spec, _) | Answer::Coefficient(spec)) =
            &leaf.answer
        else {
            return leaf.meaning.clone();
        };
        let mut said = vec![leaf.meaning.clone()];
        let all = Range::closed(-f64::MAX, f64::MAX);
        if spec.allowed != all {
            said.push(format!("allowed: {}", interval(spec.allowed, spec.dimension)));
        }
        if spec.plausible != spec.allowed && spec.plausible != all {
            said.push(format!("usual: {}", interval(spec.plausible, spec.dimension)));
        }
        if self.takes_bare && spec.dimension != Dimension::NONE {
            said.push(format!("a bare number is in {}", spec.dimension.si_unit()));
        }
        said.join("; ")
    }
}

/// `value`, of which `text` is said.
pub(super) fn described(mut value: Value, text: &str) -> Value {
    match (text.is_empty(), value.get("$ref").is_some()) {
        (true, _) => value,
        // What stands beside a reference is not read.
        (false, true) => json!({ "allOf": [value], "description": text }),
        (false, false) => {
            value["description"] = json!(text);
            value
        }
    }
}

fn text() -> Value {
    json!({ "type": "string", "maxLength": limits::STRING_BYTES })
}

/// A quantity by the definition of its dimension.
fn quantity(dimension: Dimension) -> Value {
    json!({ "$ref": format!("#/definitions/{}", name_of(dimension)) })
}

/// The definition of quantities of `dimension`, with its name.
pub(super) fn definition(dimension: Dimension) -> (String, Value) {
    let definition = json!({
        "type": "string",
        "description": format!("{}, such as {}", dimension.name(), dimension.examples("3")),
        // A message about an alternative does not show the pattern, which nobody can read.
        "anyOf": [{ "pattern": units::pattern(dimension) }],
    });
    (name_of(dimension), definition)
}

/// What a schema calls quantities of `dimension`: `speed`, `angular-velocity`.
fn name_of(dimension: Dimension) -> String {
    let name = dimension.name();
    let name = name.strip_prefix("a ").or(name.strip_prefix("an ")).unwrap_or(&name);
    name.replace([' ', '*'], "-").replace('^', "")
}

/// The dimensions of the quantities that `answer` takes.
pub(super) fn dimensions(answer: &Answer) -> Vec<Dimension> {
    let all = match answer {
        Answer::Number(spec) | Answer::Numbers(spec, _) => vec![spec.dimension],
        Answer::Coefficient(spec) => vec![spec.dimension, Dimension::ANGLE],
        Answer::NumberInUnit(dimension) => vec![*dimension],
        _ => Vec::new(),
    };
    all.into_iter().filter(|dimension| *dimension != Dimension::NONE).collect()
}

fn number(allowed: Range) -> Value {
    let mut value = json!({ "type": "number" });
    if allowed.min > -f64::MAX {
        let key = if allowed.includes_min { "minimum" } else { "exclusiveMinimum" };
        value[key] = json!(allowed.min);
    }
    if allowed.max < f64::MAX {
        value["maximum"] = json!(allowed.max);
    }
    value
}

/// The leaves without the plain tables that a definition says more of.
fn without_plain_tables(mut leaves: Vec<Leaf>) -> Vec<Leaf> {
    if leaves.iter().any(|leaf| matches!(leaf.answer, Answer::Defined(_))) {
        leaves.retain(|leaf| {
            !matches!(leaf.answer, Answer::Table | Answer::Tables | Answer::TableOrTables)
        });
    }
    leaves
}

/// The leaves with all their choices as one.
fn with_one_choice(leaves: &[Leaf]) -> Vec<Leaf> {
    let mut merged: Vec<Leaf> = Vec::new();
    for leaf in leaves {
        let known = merged.iter_mut().find_map(|other| match &mut other.answer {
            Answer::Choice(words) => Some(words),
            _ => None,
        });
        match (&leaf.answer, known) {
            (Answer::Choice(words), Some(known)) => {
                known.extend(words.iter().filter(|word| !known.contains(word)).collect::<Vec<_>>());
            }
            _ => merged.push(leaf.clone()),
        }
    }
    merged
}

/// The default, where all agree on one.
fn common_default(leaves: &[Leaf]) -> Option<Value> {
    let mut given = leaves.iter().map(|leaf| &leaf.default);
    let first = given.next()?.as_ref()?;
    // Scalars of TOML as we write them are JSON.
    given.all(|other| other.as_ref() == Some(first)).then(|| serde_json::from_str(first).ok())?
}
