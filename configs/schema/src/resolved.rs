//! The model as it was understood: every value that was read or assumed, in SI, as TOML again or as what
//! is read once more.

use engine::units::{self, Dimension};
use toml_edit::Value as TomlValue;

use crate::diagnostics::{SourceId, Span};
use crate::document::{Entry, Node, Table, Value};

/// A value of the resolved model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Written {
    /// A number of a dimension (SI).
    Number(f64, Dimension),
    /// A list of them.
    Numbers(Vec<f64>, Dimension),
    /// A whole number.
    Integer(u64),
    /// True or false.
    Boolean(bool),
    /// A string.
    Text(String),
    /// Anything else, as TOML.
    Toml(String),
}

impl Written {
    pub(crate) fn toml(&self) -> String {
        let number = |value: f64, dimension: Dimension| match dimension == Dimension::NONE {
            true => format!("{value:?}"),
            false => quoted(&units::format_si(value, dimension)),
        };
        match self {
            Self::Number(value, dimension) => number(*value, *dimension),
            Self::Numbers(values, dimension) => {
                let items: Vec<String> =
                    values.iter().map(|&one| number(one, *dimension)).collect();
                format!("[{}]", items.join(", "))
            }
            Self::Integer(value) => value.to_string(),
            Self::Boolean(value) => value.to_string(),
            Self::Text(text) => quoted(text),
            Self::Toml(text) => text.clone(),
        }
    }

    /// The same as it is read; `span` is where its text stands.
    fn value(&self, span: Span) -> Value {
        match self {
            Self::Number(value, _) => Value::Si(*value),
            Self::Numbers(values, _) => Value::Array(
                values.iter().map(|&one| Node { span, value: Value::Si(one) }).collect(),
            ),
            Self::Integer(value) => Value::Integer(*value as i64),
            Self::Boolean(value) => Value::Boolean(*value),
            Self::Text(text) => Value::Text(text.clone()),
            // No model of grains has one.
            Self::Toml(text) => Value::Text(text.clone()),
        }
    }
}

/// What was read of every table, in the order of reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Resolved {
    sections: Vec<Section>,
}

#[derive(Clone, Debug, PartialEq)]
struct Section {
    header: String,
    lines: Vec<(String, Written)>,
}

impl Section {
    fn write(&self, keep: impl Fn(&str) -> bool, out: &mut String) {
        if !out.is_empty() {
            out.push('\n');
        }
        out.push_str(&self.header);
        out.push('\n');
        for (key, value) in self.lines.iter().filter(|(key, _)| keep(key)) {
            out.push_str(&format!("{key} = {}\n", value.toml()));
        }
    }
}

impl Resolved {
    /// Starts a section under `header`, such as `[run]` or `[[effect]]`, and gives its number.
    pub(crate) fn open(&mut self, header: String) -> usize {
        self.sections.push(Section { header, lines: Vec::new() });
        self.sections.len() - 1
    }

    /// Adds a line.
    pub(crate) fn line(&mut self, section: usize, key: &str, value: Written) {
        self.sections[section].lines.push((key.to_owned(), value));
    }

    /// The whole model of grains as it is read, without a text; messages name `source`, which is empty.
    pub(crate) fn tree(&self, source: SourceId) -> Table {
        let span = Span { source, start: 0, end: 0 };
        let mut root = Table::empty(span);
        for section in self.sections.iter().filter(|section| !section.lines.is_empty()) {
            let entry = |(key, value): &(String, Written)| Entry {
                key: key.clone(),
                key_span: span,
                node: Node { span, value: value.value(span) },
            };
            let table = Table { header: span, entries: section.lines.iter().map(entry).collect() };
            let path = section.header.trim_matches(['[', ']']);
            let node = Node { span, value: Value::Table(table) };
            let (home, key) = match path.rsplit_once('.') {
                Some((outer, key)) => (root.below(outer), key),
                None => (Some(&mut root), path),
            };
            match (home, section.header.starts_with("[[")) {
                (Some(home), true) => home.push(key, node),
                (Some(home), false) => home.put(key, node),
                (None, _) => {}
            }
        }
        root
    }

    /// The whole model; sections without a line are left out.
    pub(crate) fn text(&self) -> String {
        let mut out = String::new();
        for section in self.sections.iter().filter(|section| !section.lines.is_empty()) {
            section.write(|_| true, &mut out);
        }
        out
    }

    /// The whole model but for the place of its table of grains.
    pub(crate) fn hashed_text(&self) -> String {
        let mut out = String::new();
        for section in self.sections.iter().filter(|section| !section.lines.is_empty()) {
            let is_bed = section.header == "[bed]";
            section.write(|key| !(is_bed && key == "file"), &mut out);
        }
        out
    }

    /// Everything that the prepared bed depends on and nothing else: the seed, the gravity, the
    /// container, the recipe, and the contact law as far as it acts without an intruder.
    pub(crate) fn bed_key_text(&self) -> String {
        let mut out = String::new();
        for section in &self.sections {
            let keep: fn(&str) -> bool = match section.header.as_str() {
                "[run]" => |key| key == "seed",
                "[contact_law]" => |key| !key.starts_with("intruder_"),
                "[bed]" => |key| key != "file",
                "[medium]" => |key| key != "grain_inertia",
                "[container]" | "[[bed.grains]]" | "[[bed.effect]]" => |_| true,
                _ => continue,
            };
            section.write(keep, &mut out);
        }
        out
    }
}

/// `text` as a TOML string.
pub fn quoted(text: &str) -> String {
    TomlValue::from(text).to_string().trim().to_owned()
}
