//! How a reader notes what it asks.

use engine::params::{ParamDefault, ParamSpec};
use engine::units::Dimension;

use super::{Answer, FileKind, Question, TableReader};
use crate::resolved::{Written, quoted};

impl TableReader<'_> {
    /// Notes that `answer` may stand at `key`, which means `meaning`: for keys that are read by hand.
    pub fn asks(&self, key: &'static str, meaning: &str, answer: impl FnOnce() -> Answer) {
        self.asks_or(key, meaning, answer, || None);
    }

    /// The same with what stands in where the file says nothing, as TOML.
    pub(super) fn asks_or(
        &self,
        key: &'static str,
        meaning: &str,
        answer: impl FnOnce() -> Answer,
        default: impl FnOnce() -> Option<String>,
    ) {
        let Some(notes) = &self.reader.notes else { return };
        let question = Question {
            of: self.noted,
            key,
            answer: answer(),
            meaning: meaning.to_owned(),
            default: default(),
        };
        notes.borrow_mut().questions.push(question);
    }

    /// Notes that `spec` may stand there.
    pub(super) fn asks_number(&self, spec: &ParamSpec, answer: impl FnOnce(ParamSpec) -> Answer) {
        let default = || match spec.default {
            ParamDefault::Value(value) => Some(self.written(value, spec.dimension)),
            _ => None,
        };
        self.asks_or(spec.key, spec.meaning, || answer(*spec), default);
    }

    fn written(&self, value: f64, dimension: Dimension) -> String {
        match self.reader.kind {
            FileKind::MeasurementSet => format!("{value:?}"),
            _ if dimension == Dimension::ANGLE => {
                quoted(&format!("{} deg", (value.to_degrees() * 1e6).round() / 1e6))
            }
            _ => Written::Number(value, dimension).toml(),
        }
    }

    /// Notes that another key can stand in for `key`.
    pub(crate) fn can_do_without(&self, key: &'static str) {
        if let Some(notes) = &self.reader.notes {
            notes.borrow_mut().tables[self.noted].replaceable.push(key);
        }
    }

    /// Notes that `key` has to be there: for keys whose absence is reported by hand.
    pub fn misses(&self, key: &'static str) {
        if let Some(notes) = &self.reader.notes {
            notes.borrow_mut().tables[self.noted].missing.push(key);
        }
    }
}
