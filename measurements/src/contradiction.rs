//! A contradiction within a set.

use configs::Diagnostic;

/// What a set says of itself that its frames deny.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// What of it.
    pub kind: ContradictionKind,
    /// In words, with the place and what to write.
    pub diagnostic: Diagnostic,
}

/// What a contradiction is about; each can be overruled on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContradictionKind {
    /// Speeds at contact, and the units of the trajectories.
    Speeds,
    /// The zero of depth or clock.
    Zeros,
    /// Stopping times, final depths and ranges: their definition or unit.
    Scalars,
}

impl ContradictionKind {
    /// Every kind, in the order in which one explains the next.
    pub const ALL: [Self; 3] = [Self::Speeds, Self::Zeros, Self::Scalars];
}
