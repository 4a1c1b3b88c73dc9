//! Where the rows get their impacts from.

use std::path::PathBuf;

use crate::beds::Place;
use crate::three_shapes;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Every row at a reduced cost: minutes, with beds that are there.
    Quick,
    /// What the sources ran: hours.
    Full,
}

/// What the rows are judged with.
#[derive(Clone)]
pub struct Laboratory<'a> {
    /// How much is run.
    pub effort: Effort,
    /// Where impacts on beds of grains are run and kept: what is there is not run again.
    pub place: Place<'a>,
    /// Where the impacts of three shapes are kept, likewise.
    pub shapes: three_shapes::Places,
    /// The folder of measurement sets.
    pub sets: PathBuf,
}

impl Laboratory<'_> {
    /// The first of a pair when quick, else the second.
    #[must_use]
    pub fn quick_or_full<T>(&self, quick: T, full: T) -> T {
        match self.effort {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }
}
