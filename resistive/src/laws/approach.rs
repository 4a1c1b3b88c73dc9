//! How a body comes to the bed.

/// Velocity of a body at the start, which is first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// (m/s)
    pub speed: f64,
    /// Below the horizontal (rad).
    pub angle: f64,
}
