//! A change of a model of grains.

use configs::Change;

/// What is changed: in what the bed is made of, and in what acts during the impact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variation {
    /// Of the bed and of the impact.
    pub before: Vec<Change>,
    /// Of the impact alone: it falls on the bed that the model has without it.
    pub during: Vec<Change>,
}

impl Variation {
    /// `change` in the bed and in the impact.
    pub fn before(change: Change) -> Self {
        Self { before: vec![change], during: Vec::new() }
    }

    /// `change` in the impact alone.
    pub fn during(change: Change) -> Self {
        Self { before: Vec::new(), during: vec![change] }
    }

    /// Both changes.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.before.extend(other.before);
        self.during.extend(other.during);
        self
    }
}
