//! A change of a model of grains.

/// What is changed: in what the bed is made of, and in what acts during the impact.
///
/// Assignments are as `--set` has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variation {
    /// Of the bed and of the impact.
    pub before: Vec<String>,
    /// Of the impact alone: it falls on the bed that the model has without it.
    pub during: Vec<String>,
    /// Effects that are added during the impact, each with its keys and their values as TOML.
    pub effects: Vec<(String, Vec<(String, String)>)>,
}

impl Variation {
    /// Both changes.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.before.extend(other.before);
        self.during.extend(other.during);
        self.effects.extend(other.effects);
        self
    }
}
