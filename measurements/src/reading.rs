//! Numbers with their errors.

/// A number that was read, with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The number.
    pub value: f64,
    /// Its standard error, in the same unit.
    pub se: f64,
}
