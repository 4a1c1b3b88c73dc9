//! What a campaign sets and varies: keys of models, and values as they stand in the file.

use configs::document::{Entry, Node, Table, Value};
use configs::reader::Reader;
use configs::{Diagnostic, Span, shorten};

/// One key of a model and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The key with its tables, as in `impact.speed`.
    pub key: String,
    /// The value, as TOML.
    pub value: String,
    /// Where the value stands; nowhere if it was drawn.
    pub span: Option<Span>,
}

/// One key of a model and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The key with its tables.
    pub key: String,
    /// Each a setting of the key; not empty.
    pub values: Vec<Setting>,
}

/// One key of a model and the range that its values are drawn from.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledRange {
    /// The key with its tables.
    pub key: String,
    /// One end, in the unit.
    pub from: f64,
    /// The other end, in the unit.
    pub to: f64,
    /// The unit of both, as written; none of a pure number.
    pub unit: Option<String>,
    /// What the values are spread evenly over.
    pub scale: Scale,
    /// Where it stands.
    pub span: Option<Span>,
}

/// What drawn values are spread evenly over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The values themselves.
    Linear,
    /// Their logarithms.
    Logarithmic,
}

impl Setting {
    /// As `--set` takes it.
    pub fn assignment(&self) -> String {
        format!("{}={}", self.key, self.value)
    }
}

impl SampledRange {
    /// The value at `share` of the range, 0 at one end and 1 at the other.
    pub fn at(&self, share: f64) -> Setting {
        let Self { from, to, .. } = *self;
        let value = match self.scale {
            Scale::Linear => from + share * (to - from),
            Scale::Logarithmic => from * libm::pow(to / from, share),
        };
        // Rounding must not lead beyond an end that a model just takes.
        let value = value.clamp(from.min(to), from.max(to));
        let value = match &self.unit {
            Some(unit) => format!("\"{value} {unit}\""),
            None => format!("{value:?}"),
        };
        Setting { key: self.key.clone(), value, span: None }
    }
}

/// The keys of `table` down to what is no table of keys, with their tables before them.
pub(super) fn leaves(table: &Table) -> Vec<(String, &Entry)> {
    let mut found = Vec::new();
    for entry in &table.entries {
        match &entry.node.value {
            Value::Table(inner) if !is_range(inner) => {
                let inner = leaves(inner).into_iter();
                found.extend(inner.map(|(key, leaf)| (format!("{}.{key}", entry.key), leaf)));
            }
            _ => found.push((entry.key.clone(), entry)),
        }
    }
    found
}

fn is_range(table: &Table) -> bool {
    table.has("from") && table.has("to")
}

/// One setting per key of `table`.
pub(super) fn settings(reader: &Reader<'_>, table: &Table) -> Vec<Setting> {
    leaves(table).into_iter().map(|(key, entry)| setting(reader, key, &entry.node)).collect()
}

fn setting(reader: &Reader<'_>, key: String, node: &Node) -> Setting {
    let Span { start, end, source } = node.span;
    let value = reader.sources.text(source)[start..end].to_owned();
    Setting { key, value, span: Some(node.span) }
}

/// The key and the list of values of an entry of `[product]`.
pub(super) fn axis(reader: &Reader<'_>, key: String, entry: &Entry) -> Option<Axis> {
    match &entry.node.value {
        Value::Array(nodes) if !nodes.is_empty() => {
            let values = nodes.iter().map(|node| setting(reader, key.clone(), node)).collect();
            Some(Axis { key, values })
        }
        other => {
            let found =
                if matches!(other, Value::Array(_)) { "an empty list" } else { other.kind() };
            reader.report(
                Diagnostic::error(format!(
                    "`{}` is {found}; expected a list of values",
                    shorten(&key)
                ))
                .at(entry.node.span, "expected a list of values")
                .help("put one value for all points into [set]"),
            );
            None
        }
    }
}

/// The key and the range of an entry of `[sample.ranges]`.
pub(super) fn range(reader: &Reader<'_>, key: String, entry: &Entry) -> Option<SampledRange> {
    let refuse = |why: &str| {
        reader.report(
            Diagnostic::error(format!("`{}`: {why}", shorten(&key))).at(entry.node.span, "").help(
                "write both ends with the same unit, as in [\"1 m/s\", \"4 m/s\"] or [0.1, 0.5], or \
                 { from = \"1 mm\", to = \"1 m\", scale = \"logarithmic\" }",
            ),
        );
        None
    };
    let (ends, scale) = match &entry.node.value {
        Value::Array(nodes) if nodes.len() == 2 => {
            ([&nodes[0].value, &nodes[1].value], Scale::Linear)
        }
        Value::Table(table) if is_range(table) && table.entries.len() <= 3 => {
            let value = |key| table.get(key).map(|entry| &entry.node.value);
            let scale = match value("scale") {
                None if table.entries.len() == 2 => Scale::Linear,
                Some(Value::Text(text)) if text == "linear" => Scale::Linear,
                Some(Value::Text(text)) if text == "logarithmic" => Scale::Logarithmic,
                _ => return refuse("the scale is neither \"linear\" nor \"logarithmic\""),
            };
            let (Some(from), Some(to)) = (value("from"), value("to")) else {
                return refuse("this is not a range");
            };
            ([from, to], scale)
        }
        _ => return refuse("this is not a range"),
    };
    let [Some((from, unit)), Some((to, other))] = ends.map(quantity) else {
        return refuse("an end is no number");
    };
    if unit != other {
        return refuse("the ends have different units");
    }
    if from.total_cmp(&to).is_eq() || (scale == Scale::Logarithmic && !(from > 0.0 && to > 0.0)) {
        return refuse("nothing can be drawn from this range");
    }
    Some(SampledRange { key, from, to, unit, scale, span: Some(entry.node.span) })
}

/// A finite number, and its unit if it is a string with one.
fn quantity(value: &Value) -> Option<(f64, Option<String>)> {
    let (number, unit) = match value {
        Value::Integer(number) => (*number as f64, None),
        Value::Float(number) => (*number, None),
        Value::Text(text) => {
            let (number, unit) = text.trim().split_once(char::is_whitespace)?;
            (number.parse().ok()?, Some(unit.trim().to_owned()))
        }
        _ => return None,
    };
    number.is_finite().then_some((number, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(scale: Scale, share: f64) -> String {
        let (key, unit) = ("impact.speed".to_owned(), Some("m/s".to_owned()));
        SampledRange { key, from: 1.0, to: 4.0, unit, scale, span: None }.at(share).assignment()
    }

    #[test]
    fn shares_are_spread_over_values_or_over_their_logarithms() {
        assert_eq!(at(Scale::Linear, 0.0), "impact.speed=\"1 m/s\"");
        assert_eq!(at(Scale::Linear, 0.5), "impact.speed=\"2.5 m/s\"");
        assert_eq!(at(Scale::Logarithmic, 0.5), "impact.speed=\"2 m/s\"");
    }
}
