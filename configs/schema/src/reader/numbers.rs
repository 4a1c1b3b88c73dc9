//! Numbers, quantities and lists of them.

use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};
use engine::units::{self, Dimension};

use super::{Answer, FileKind, Found, TableReader};
use crate::diagnostics::{Diagnostic, Span, shorten};
use crate::document::{Node, Value};
use crate::limits;
use crate::resolved::{Written, quoted};

/// Speed of an impact (m/s) in examples: ranges reach to far larger ones.
const USUAL_SPEED: f64 = 2.0;

impl TableReader<'_> {
    /// A number or quantity as its specification says.
    pub fn number(&self, spec: &ParamSpec) -> Option<Found<f64>> {
        self.asks_number(spec, Answer::Number);
        self.plain_number(spec)
    }

    /// The same without a note of it.
    pub(super) fn plain_number(&self, spec: &ParamSpec) -> Option<Found<f64>> {
        let found = match self.entry(spec.key) {
            Some(entry) => self.number_at(&entry.node, spec),
            None => match spec.default {
                // What a contact law lends is filled in by [`TableReader::params_on`].
                ParamDefault::Required | ParamDefault::FromBase(_) => {
                    self.missing(spec.key, &self.example(spec), spec.meaning);
                    None
                }
                ParamDefault::Value(value) => Some(Found { value, span: None }),
                ParamDefault::SameAs(other) => {
                    let numbers = self.numbers.borrow();
                    let value = numbers.iter().find(|(key, _)| *key == other);
                    value.and_then(|(_, value)| *value).map(|value| Found { value, span: None })
                }
            },
        };
        self.numbers.borrow_mut().push((spec.key, found.map(|found| found.value)));
        if let Some(found) = found {
            self.write_number(spec.key, found.value, spec.dimension);
        }
        found
    }

    /// A number that may be left out; the outer `None` is an error that was reported.
    pub fn optional_number(&self, spec: &ParamSpec) -> Option<Option<Found<f64>>> {
        self.asks_number(spec, Answer::Number);
        match self.has(spec.key) {
            true => self.plain_number(spec).map(Some),
            false => Some(None),
        }
    }

    /// A number in `unit`, or a string with a unit of its own, in SI; the outer `None` is an error that was
    /// reported.
    pub fn number_in(
        &self,
        key: &'static str,
        unit: &str,
        dimension: Dimension,
    ) -> Option<Option<Found<f64>>> {
        self.asks(key, "", || Answer::NumberInUnit(dimension));
        let Some(entry) = self.entry(key) else { return Some(None) };
        let text = match &entry.node.value {
            Value::Float(number) => format!("{number:?} {unit}"),
            Value::Integer(number) => format!("{number} {unit}"),
            Value::Text(text) => text.clone(),
            _ => {
                self.wrong_kind(entry, "a number", &quoted(&format!("12.0 {unit}")));
                return None;
            }
        };
        match units::parse(&text, dimension) {
            Ok(value) => Some(Some(Found { value, span: Some(entry.node.span) })),
            Err(error) => {
                self.reader.report(
                    Diagnostic::error(format!("`{key}`: {}", error.reason()))
                        .at(entry.node.span, format!("{} is expected", dimension.name()))
                        .help(format!("a bare number is in {unit}; or {}", error.advice())),
                );
                None
            }
        }
    }

    /// All parameters of a registry entry.
    pub(crate) fn params(&self, specs: &'static [ParamSpec]) -> Option<ParamTable> {
        self.params_on(specs, &ParamTable::new())
    }

    /// All parameters of a registry entry that acts on a law with the parameters `base`.
    pub(crate) fn params_on(
        &self,
        specs: &'static [ParamSpec],
        base: &ParamTable,
    ) -> Option<ParamTable> {
        let mut table = ParamTable::new();
        let mut complete = true;
        for spec in specs {
            let lent = match spec.default {
                ParamDefault::FromBase(key) => base.iter().find(|(own, _)| *own == key),
                _ => None,
            };
            let default = lent.map_or(spec.default, |(_, value)| ParamDefault::Value(value));
            match self.number(&ParamSpec { default, ..*spec }) {
                Some(found) => table.set(spec.key, found.value),
                None => complete = false,
            }
        }
        complete.then_some(table)
    }

    /// A list of quantities, each as its specification says.
    pub fn numbers(&self, spec: &ParamSpec) -> Option<Option<Vec<Found<f64>>>> {
        self.asks_number(spec, |spec| Answer::Numbers(spec, None));
        let Some(entry) = self.entry(spec.key) else {
            return Some(None);
        };
        let Value::Array(nodes) = &entry.node.value else {
            let item = match &entry.node.value {
                Value::Text(text) => quoted(&shorten(text)),
                _ => self.example(spec),
            };
            self.wrong_kind(entry, "a list", &format!("[{item}]"));
            return None;
        };
        if nodes.is_empty() || nodes.len() > limits::CONDITIONS {
            self.reader.report(
                Diagnostic::error(format!("`{}` has {} values", spec.key, nodes.len()))
                    .at(entry.node.span, format!("expected 1 to {}", limits::CONDITIONS)),
            );
            return None;
        }
        let read: Vec<_> = nodes.iter().map(|node| self.number_at(node, spec)).collect();
        let values: Option<Vec<Found<f64>>> = read.into_iter().collect();
        let values = values?;
        let numbers: Vec<f64> = values.iter().map(|found| found.value).collect();
        self.note_list(spec, &numbers);
        Some(Some(values))
    }

    /// Reports that a required list is missing, with an example of what to write.
    pub(crate) fn missing_list(&self, spec: &ParamSpec, example: &str) {
        self.asks_number(spec, |spec| Answer::Numbers(spec, None));
        self.missing(spec.key, example, spec.meaning);
    }

    pub(crate) fn number_at(&self, node: &Node, spec: &ParamSpec) -> Option<Found<f64>> {
        let value = match (self.is_bare(spec), &node.value) {
            (_, Value::Si(value)) | (true, Value::Float(value)) => *value,
            (true, Value::Integer(value)) => *value as f64,
            // A set takes both: a bare SI number, or what a model would say.
            (bare, Value::Text(text)) if !bare || self.takes(text, spec) => {
                match units::parse(text, spec.dimension) {
                    Ok(value) => value,
                    Err(error) => {
                        self.reader.report(
                            Diagnostic::error(format!("`{}`: {}", spec.key, error.reason()))
                                .at(node.span, format!("expected {}", spec.dimension.name()))
                                .help(self.unit_help(spec, &error)),
                        );
                        return None;
                    }
                }
            }
            (true, Value::Text(text)) => {
                self.report_quoted(text, node.span, spec);
                return None;
            }
            (false, Value::Float(_) | Value::Integer(_)) => {
                let number = self.reader.sources.quote(node.span);
                let finite = !number.is_empty() && !number.contains(['n', 'N']);
                let shown = if finite { number.as_str() } else { "3" };
                self.reader.report(
                    Diagnostic::error(format!("`{}` has no unit", spec.key))
                        .at(node.span, format!("expected {}", spec.dimension.name()))
                        .help(format!(
                            "write it in quotes, with its unit: {}",
                            spec.dimension.examples(shown)
                        )),
                );
                return None;
            }
            (_, other) => {
                let wanted = spec.dimension.name();
                self.reader.report(
                    Diagnostic::error(format!(
                        "`{}` is {}; expected {wanted}",
                        spec.key,
                        other.kind()
                    ))
                    .at(node.span, format!("expected {wanted}"))
                    .help(format!(
                        "write {} = {}",
                        spec.key,
                        self.example(spec)
                    )),
                );
                return None;
            }
        };
        self.in_range(value, node.span, spec)
    }

    /// Whether `text` may stand where a bare number is usual: a quantity of a set, with its unit.
    fn takes(&self, text: &str, spec: &ParamSpec) -> bool {
        let is_number = text.trim().parse::<f64>().is_ok();
        let is_set = self.reader.kind == FileKind::MeasurementSet;
        is_set && spec.dimension != Dimension::NONE && !is_number
    }

    /// Whether a number without a unit is wanted.
    fn is_bare(&self, spec: &ParamSpec) -> bool {
        spec.dimension == Dimension::NONE || self.reader.kind == FileKind::MeasurementSet
    }

    /// Something plausible to write for a parameter.
    pub(super) fn example(&self, spec: &ParamSpec) -> String {
        let Range { min, max, .. } = spec.plausible;
        let usual = spec.dimension == Dimension::SPEED && spec.plausible.contains(USUAL_SPEED);
        let middle = match min > 0.0 && max.is_finite() {
            _ if usual => USUAL_SPEED,
            true => (min * max).sqrt(),
            false if max < f64::MAX => max / 5.0,
            false => 1.0,
        };
        let middle = match spec.default {
            ParamDefault::Value(value) => value,
            _ => format!("{middle:.0e}").parse().unwrap_or(middle),
        };
        match spec.dimension {
            _ if self.is_bare(spec) => format!("{middle:?}"),
            Dimension::ANGLE => "\"45 deg\"".to_owned(),
            dimension => quoted(&units::format_si(middle, dimension)),
        }
    }

    /// Reports a string where a bare number is wanted; a quantity is shown in SI.
    fn report_quoted(&self, text: &str, span: Span, spec: &ParamSpec) {
        let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
        let percent = text.trim().strip_suffix('%').filter(|_| spec.dimension == Dimension::NONE);
        let value = match (percent.and_then(number), units::parse(text, spec.dimension)) {
            _ if number(text).is_some() => text.trim().to_owned(),
            (Some(percent), _) => format!("{}", percent / 100.0),
            (None, Ok(value)) => format!("{value:?}"),
            (None, Err(_)) => self.example(spec),
        };
        let what = match spec.dimension {
            Dimension::NONE => "it is a pure number".to_owned(),
            dimension => format!("it is a number in {}", dimension.si_unit()),
        };
        self.reader.report(
            Diagnostic::error(format!("`{}` is a string; {what}", spec.key))
                .at(span, "expected a bare number, without unit and quotes")
                .help(format!("write {} = {value}", spec.key)),
        );
    }

    fn unit_help(&self, spec: &ParamSpec, error: &units::UnitError) -> String {
        let planar = spec.dimension == Dimension::AREA_DENSITY
            && error.fault == units::UnitFault::Dimension(Dimension::DENSITY);
        match planar {
            true => "a planar medium has a density per area, such as \"20 kg/m^2\": \
                     density × thickness"
                .to_owned(),
            false => error.advice(),
        }
    }

    fn in_range(&self, value: f64, span: Span, spec: &ParamSpec) -> Option<Found<f64>> {
        if !value.is_finite() || !spec.allowed.contains(value) {
            let what = match value.is_finite() {
                true => format!("`{}` is out of its range", spec.key),
                false => format!("`{}` is not a finite number", spec.key),
            };
            self.reader.report(
                Diagnostic::error(what)
                    .at(span, format!("allowed: {}", interval(spec.allowed, spec.dimension)))
                    .help(format!("`{}` is {}", spec.key, spec.meaning)),
            );
            return None;
        }
        if !spec.plausible.contains(value) {
            let usual = interval(spec.plausible, spec.dimension);
            self.reader.report(
                Diagnostic::warning(format!("`{}` has an unusual value", spec.key))
                    .at(span, format!("usual: {usual}"))
                    .help(format!("`{}` is {}", spec.key, spec.meaning)),
            );
        }
        Some(Found { value, span: Some(span) })
    }

    /// A number that is not written to the resolved model; something derived from it is.
    pub(crate) fn quiet_number(&self, spec: &ParamSpec) -> Option<Found<f64>> {
        self.asks_number(spec, Answer::Number);
        self.entry(spec.key).and_then(|entry| self.number_at(&entry.node, spec))
    }

    /// Writes a list of numbers.
    pub(crate) fn note_list(&self, spec: &ParamSpec, values: &[f64]) {
        self.write(spec.key, Written::Numbers(values.to_vec(), spec.dimension));
    }

    /// Writes a line that was derived from what was read.
    pub(crate) fn note(&self, spec: &ParamSpec, value: f64) {
        self.write_number(spec.key, value, spec.dimension);
    }

    fn write_number(&self, key: &str, value: f64, dimension: Dimension) {
        self.write(key, Written::Number(value, dimension));
    }
}

/// An interval of SI values in words: `above 0 m`, `0 to 1.5`; angles in degrees.
pub fn interval(range: Range, dimension: Dimension) -> String {
    let show = |value: f64| match dimension {
        Dimension::ANGLE => format!("{} deg", (value.to_degrees() * 1e6).round() / 1e6),
        _ => units::format_si(value, dimension),
    };
    let Range { min, max, includes_min } = range;
    match (includes_min, max < f64::MAX) {
        (true, true) => format!("{} to {}", show(min), show(max)),
        (false, true) => format!("above {}, up to {}", show(min), show(max)),
        (true, false) => format!("{} or more", show(min)),
        (false, false) => format!("above {}", show(min)),
    }
}
