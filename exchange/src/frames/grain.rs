//! A grain of a frame.

/// A grain as the log has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grain {
    /// Its number, the same in all frames.
    pub id: u32,
    /// Centre; z points up from the undisturbed surface (m).
    pub position: [f32; 3],
    /// Radius (m).
    pub radius: f32,
    /// Velocity (m/s).
    pub velocity: [f32; 3],
    /// Magnitude of the velocity (m/s).
    pub speed: f32,
    /// Magnitude of the sum of contact forces (N).
    pub force: f32,
}
