//! What a set does not say, in sentences for the report.

/// Optional keys that are not there.
#[derive(Default)]
pub(crate) struct Unstated {
    assumed: Vec<String>,
    absent: Vec<String>,
    zero: Vec<&'static str>,
}

impl Unstated {
    /// A value that stands in for a key, as it would be written.
    pub(crate) fn assume(&mut self, line: String) {
        self.assumed.push(line);
    }

    /// A key that nothing stands in for.
    pub(crate) fn absent_if(&mut self, absent: bool, path: &str) {
        if absent {
            self.absent.push(path.to_owned());
        }
    }

    /// An error of zero is none that can be weighed with: it counts as not stated.
    pub(crate) fn positive(&mut self, value: Option<f64>, path: &'static str) -> Option<f64> {
        if value == Some(0.0) {
            self.zero.push(path);
        }
        value.filter(|value| *value > 0.0)
    }

    /// At most one sentence of each kind.
    pub(crate) fn sentences(self) -> Vec<String> {
        let mut sentences = Vec::new();
        if !self.assumed.is_empty() {
            sentences
                .push(format!("Assumed, as the set does not say: {}.", self.assumed.join(", ")));
        }
        if !self.absent.is_empty() {
            sentences.push(format!("Not stated: {}.", self.absent.join(", ")));
        }
        if !self.zero.is_empty() {
            let keys = self.zero.join(", ");
            sentences.push(format!("An error of zero is taken as not stated: {keys}."));
        }
        sentences
    }
}
