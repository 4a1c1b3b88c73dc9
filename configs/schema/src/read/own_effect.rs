//! `[[effect]]` and `[[candidate]]` of the name `expression`: a force as a formula.

use engine::params::Range;
use engine::units::{self, Dimension};
use resistive::Space;
use resistive::formula::{FormulaError, SyntaxError};
use resistive::{Acts, Direction, Draft, OwnEffect, OwnEffectError, OwnParameter, STATE_VARIABLES};

use super::Places;
use crate::diagnostics::{Diagnostic, Span, nearest, shorten};
use crate::document::{Entry, Table, Value};
use crate::reader::{Answer, Found, TableReader};
use crate::resolved::quoted;

/// What says in `name` that an effect is a formula.
pub(super) const EXPRESSION: &str = "expression";

/// What schemas call the parameters of a formula.
pub(crate) const PARAMETERS: &str = "parameters-of-a-formula";

/// The keys of one of them.
pub(crate) const KEYS_OF_PARAMETER: [&str; 3] = ["value", "unit", "range"];

/// What a table of a formula is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// It is part of the model, with an amplitude.
    Part,
    /// A diagnosis may find that it belongs to it.
    Candidate,
}

const DIRECTIONS: [(&str, Direction); 6] = [
    ("against-motion", Direction::AgainstMotion),
    ("up", Direction::Up),
    ("down", Direction::Down),
    ("forward", Direction::Forward),
    ("backward", Direction::Backward),
    ("normal", Direction::Normal),
];

const KINDS: [(&str, Direction); 2] =
    [("drag", Direction::AgainstMotion), ("friction", Direction::Friction)];

const PLACES: [(&str, Acts); 2] = [("in-bed", Acts::InBed), ("everywhere", Acts::Everywhere)];

/// The effect that `table` describes and where its name stands; `None` is an error that was reported.
pub(super) fn own_effect(
    table: &TableReader<'_>,
    space: Space,
    purpose: Purpose,
    places: &mut Places,
) -> Option<(OwnEffect, Option<Span>)> {
    let id = table.text("id", None, "late-drag", "the name of the effect");
    let summary = table.text("summary", Some(""), "", "what it is, in a sentence");
    let example = "q * rho * A * v^2 * z / D";
    let force = table.text("force", None, example, "the force, as a formula in newtons");
    let direction = one_of(table, "direction", &DIRECTIONS, "along what the force acts");
    let direction = direction.and_then(|direction| kind(table, direction));
    let acts = one_of(table, "acts", &PLACES, "where the force acts");
    let parameters = parameters(table, purpose);
    let (id, force) = (id?, force?);
    places.own_forces.push((id.value.clone(), force.span));
    let draft = Draft {
        id: id.value.clone(),
        summary: summary?.value,
        force: force.value.clone(),
        direction: direction?,
        acts: acts?,
        parameters: parameters?,
        space,
    };
    match OwnEffect::new(draft, |id| contact_laws::find(id).is_some()) {
        Ok(effect) => Some((effect, id.span)),
        Err(error) => {
            table.reader.report(explain(table, &error, &id, &force));
            None
        }
    }
}

/// What to say of a description that is no effect.
fn explain(
    table: &TableReader<'_>,
    error: &OwnEffectError,
    id: &Found<String>,
    force: &Found<String>,
) -> Diagnostic {
    let says = |what: &str| Diagnostic::error(what);
    match error {
        OwnEffectError::Id(_) | OwnEffectError::Taken(_) => {
            says("this cannot be the name of an effect").at(id.span, error.to_string())
        }
        OwnEffectError::Formula(fault) => formula_fault(table, force, fault)
            .help(format!("variables: {}; and the parameters", variables())),
        OwnEffectError::Dimension(_) => {
            says("this formula is not a force").at(force.span, error.to_string()).help(format!(
                "variables: {}; `plunge effects expression` has their units",
                variables()
            ))
        }
        OwnEffectError::Name { .. } => {
            says("this cannot be a parameter").at(table.span_of("parameters"), error.to_string())
        }
        OwnEffectError::NoAmplitude => says("this effect has no amplitude")
            .at(table.span_of("parameters").or(table.header()), error.to_string())
            .help("write parameters.q = { unit = \"1\", range = [0, 5] }"),
        OwnEffectError::NeverAbsent | OwnEffectError::NeverPresent => {
            says("this cannot be the range of an amplitude")
                .at(table.span_of("parameters"), error.to_string())
        }
        OwnEffectError::Unused(name) => says("a parameter is not used")
            .at(force.span, error.to_string())
            .with(table.span_of("parameters"), format!("`{name}` is declared here")),
    }
}

/// What to say of a text that is no formula: it points at the character.
pub(crate) fn formula_fault(
    table: &TableReader<'_>,
    text: &Found<String>,
    fault: &FormulaError,
) -> Diagnostic {
    let within = table.reader.sources.within(text.span, &text.value, fault.at.clone());
    let label = match &fault.fault {
        SyntaxError::Unknown { unknown, known } => {
            let near = nearest(unknown, known.iter().map(String::as_str));
            let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            format!("`{}` is not known here{near}", shorten(unknown))
        }
        other => other.to_string(),
    };
    Diagnostic::error("this is not a formula").at(within, label)
}

/// The names of the variables of the state.
fn variables() -> String {
    let names: Vec<&str> = STATE_VARIABLES.iter().map(|variable| variable.name).collect();
    names.join(", ")
}

/// The value that one of a few words stands for; the first where none is given.
fn one_of<T: Copy>(
    table: &TableReader<'_>,
    key: &'static str,
    known: &[(&'static str, T)],
    meaning: &str,
) -> Option<T> {
    if !table.has(key) {
        let (word, value) = known[0];
        table.note_text(key, word);
        return Some(value);
    }
    let words: Vec<&'static str> = known.iter().map(|(word, _)| *word).collect();
    let word = table.choice(key, &words, &[], meaning)?;
    known.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
}

/// Whether what opposes the motion is there at rest too.
fn kind(table: &TableReader<'_>, direction: Direction) -> Option<Direction> {
    if direction == Direction::AgainstMotion {
        return one_of(table, "kind", &KINDS, "drag that vanishes at rest, or friction");
    }
    if !table.has("kind") {
        return Some(direction);
    }
    table.reader.report(
        Diagnostic::error("`kind` is for a force against the motion")
            .at(table.span_of("kind"), "only that one is a drag or a friction")
            .with(table.span_of("direction"), "this force acts along a direction of its own"),
    );
    None
}

/// The parameters, written to the resolved model in SI.
fn parameters(table: &TableReader<'_>, purpose: Purpose) -> Option<Vec<OwnParameter>> {
    table.asks("parameters", "the numbers of the formula", || Answer::Defined(PARAMETERS));
    let Some(node) = table.node("parameters") else { return Some(Vec::new()) };
    let Value::Table(list) = &node.value else {
        table.reader.report(
            Diagnostic::error("`parameters` is a table")
                .at(node.span, format!("this is {}", node.value.kind()))
                .help("write parameters.q = { unit = \"1\", range = [0, 5] }"),
        );
        return None;
    };
    let read: Vec<Option<OwnParameter>> =
        list.entries.iter().map(|entry| Declaration { table, entry, purpose }.read()).collect();
    let parameters: Vec<OwnParameter> = read.into_iter().collect::<Option<_>>()?;
    let lines: Vec<String> = parameters.iter().map(resolved).collect();
    table.note_toml("parameters", format!("{{ {} }}", lines.join(", ")));
    Some(parameters)
}

/// A parameter as TOML, in SI.
fn resolved(parameter: &OwnParameter) -> String {
    let OwnParameter { name, dimension, value, range } = parameter;
    let unit = Some(dimension.si_unit()).filter(|unit| !unit.is_empty());
    let unit = quoted(unit.as_deref().unwrap_or("1"));
    let value = value.map_or(String::new(), |value| format!("value = {value:?}, "));
    let range = match range.max < f64::MAX {
        true => format!(", range = [{:?}, {:?}]", range.min, range.max),
        false => String::new(),
    };
    format!("{name} = {{ {value}unit = {unit}{range} }}")
}

/// One parameter in the file.
struct Declaration<'a> {
    table: &'a TableReader<'a>,
    entry: &'a Entry,
    purpose: Purpose,
}

impl Declaration<'_> {
    fn read(&self) -> Option<OwnParameter> {
        let Value::Table(own) = &self.entry.node.value else {
            let what = format!("this is {}; expected a table", self.entry.node.value.kind());
            let help = "write { value = 0.2, unit = \"1\", range = [0, 5] }";
            return self.fail(self.entry.node.span, what, help);
        };
        if let Some(unknown) =
            own.entries.iter().find(|entry| !KEYS_OF_PARAMETER.contains(&entry.key.as_str()))
        {
            let near = nearest(&unknown.key, KEYS_OF_PARAMETER);
            let label =
                near.map_or("unknown key".to_owned(), |near| format!("did you mean `{near}`?"));
            return self.fail(unknown.key_span, label, "keys: value, unit, range");
        }
        let (unit, dimension) = self.unit(own)?;
        let is_amplitude = self.entry.key == "q";
        let value = match own.get("value") {
            Some(entry) => {
                Some(self.in_si(entry.node.span, &entry.node.value, &unit, dimension)?)
            }
            None => None,
        };
        let range = self.range(own, &unit, dimension)?;
        let place = own.get("value").map_or(self.entry.key_span, |entry| entry.node.span);
        match (value, self.purpose) {
            (Some(value), Purpose::Candidate) if is_amplitude && value != 0.0 => {
                return self.fail(
                    place,
                    "a candidate is not in the model: its amplitude is 0",
                    "leave it out, or write the table as [[effect]]",
                );
            }
            (None, purpose) if !is_amplitude || purpose == Purpose::Part => {
                return self.fail(
                    place,
                    "`value` is missing",
                    "write value = 0.2, in the unit of the parameter",
                );
            }
            (Some(value), _) if !range.contains(value) => {
                return self.fail(
                    place,
                    "outside of its own range",
                    "the range is in the same unit",
                );
            }
            _ => {}
        }
        let value = value.filter(|_| !(is_amplitude && self.purpose == Purpose::Candidate));
        Some(OwnParameter { name: self.entry.key.clone(), dimension, value, range })
    }

    fn unit(&self, own: &Table) -> Option<(String, Dimension)> {
        let Some(entry) = own.get("unit") else { return Some(("1".to_owned(), Dimension::NONE)) };
        let help = "expected a unit such as \"1\", \"N\", \"kg/m\" or \"1/s\"";
        match &entry.node.value {
            Value::Text(unit) => match units::dimension_of(unit) {
                Some(dimension) => Some((unit.clone(), dimension)),
                None => self.fail(entry.node.span, format!("`{}` is no unit", shorten(unit)), help),
            },
            other => self.fail(entry.node.span, format!("this is {}", other.kind()), help),
        }
    }

    fn range(&self, own: &Table, unit: &str, dimension: Dimension) -> Option<Range> {
        let help = "write range = [0, 5], in the unit of the parameter";
        let Some(entry) = own.get("range") else {
            if self.entry.key == "q" {
                return self.fail(self.entry.key_span, "the amplitude has no `range`", help);
            }
            return Some(Range::closed(-f64::MAX, f64::MAX));
        };
        let span = entry.node.span;
        let Value::Array(bounds) = &entry.node.value else {
            return self.fail(span, format!("this is {}", entry.node.value.kind()), help);
        };
        let [min, max] = bounds.as_slice() else {
            return self.fail(span, "expected two numbers", help);
        };
        let min = self.in_si(min.span, &min.value, unit, dimension)?;
        let max = self.in_si(max.span, &max.value, unit, dimension)?;
        match min < max {
            true => Some(Range::closed(min, max)),
            false => self.fail(span, "the first number is not below the second", help),
        }
    }

    fn in_si(&self, span: Span, value: &Value, unit: &str, dimension: Dimension) -> Option<f64> {
        let number = match value {
            Value::Float(number) => *number,
            Value::Integer(number) => *number as f64,
            other => {
                let help = "write the number alone; its unit stands in `unit`";
                return self.fail(span, format!("this is {}", other.kind()), help);
            }
        };
        match units::parse(&format!("{number:?} {unit}"), dimension) {
            Ok(value) => Some(value),
            Err(_) => self.fail(span, "this number cannot be taken", "expected a finite number"),
        }
    }

    fn fail<T>(&self, at: Span, label: impl Into<String>, help: impl Into<String>) -> Option<T> {
        let name = shorten(&self.entry.key);
        let what = Diagnostic::error(format!("the parameter `{name}` is not understood"));
        self.table.reader.report(what.at(at, label).help(help));
        None
    }
}
