//! The intruder, and how it meets the surface.

use std::f64::consts::FRAC_PI_2;

use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::ShapeEntry;

/// The body that hits the bed.
#[derive(Clone)]
pub struct Intruder {
    /// Its name in logs and reports.
    pub name: String,
    /// The registry's entry.
    pub shape: &'static ShapeEntry,
    /// All parameters of the shape (SI).
    pub params: ParamTable,
    /// Mass (kg).
    pub mass: f64,
    /// Whether a shaft on its top, which it does not feel, keeps grains off that.
    pub recessive_wall: bool,
}

impl PartialEq for Intruder {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
            && self.shape.name == other.shape.name
            && self.params == other.params
            && self.mass.to_bits() == other.mass.to_bits()
            && self.recessive_wall == other.recessive_wall
    }
}

impl std::fmt::Debug for Intruder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Intruder")
            .field("name", &self.name)
            .field("shape", &self.shape.name)
            .field("params", &self.params)
            .field("mass", &self.mass)
            .field("recessive_wall", &self.recessive_wall)
            .finish()
    }
}

/// How the intruder meets the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Speed at first contact (m/s).
    pub speed: f64,
    /// Angle of the velocity below the horizontal (rad): π/2 is straight down.
    pub angle_rad: f64,
    /// Angular velocity (rad/s).
    pub spin: Vec3,
    /// Angle of the axis to the vertical in the x–z plane (rad), positive when the top leans towards
    /// +x.
    pub attitude_rad: f64,
    /// Depth of the lowest point (m) to which a drive pushes the intruder at this speed and angle (`[intrusion]`);
    /// `None` where it moves freely.
    pub pushed_to: Option<f64>,
}

impl Impact {
    /// The table of the model file that says it.
    pub fn table(&self) -> &'static str {
        if self.pushed_to.is_some() { INTRUSION } else { IMPACT }
    }
}

/// The table of an intruder that moves freely after first contact.
pub(crate) const IMPACT: &str = "impact";
/// The table of one that a drive pushes.
pub(crate) const INTRUSION: &str = "intrusion";

/// How a body comes in at first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch {
    /// Speed (m/s).
    pub speed: f64,
    /// Angle of the velocity below the horizontal (rad).
    pub angle_rad: f64,
    /// Angular velocity (rad/s).
    pub spin: Vec3,
    /// Angle of the axis to the vertical in the x–z plane (rad), positive when the top leans towards
    /// +x.
    pub attitude_rad: f64,
    /// Depth of the lowest point (m) to which a drive pushes the body with this velocity, if one does.
    pub pushed_to: Option<f64>,
}

impl Launch {
    /// Velocity (m/s) in the x–z plane, towards +x and down.
    pub fn velocity(&self) -> Vec3 {
        // Straight down is exactly down: a cosine of round-off size is no horizontal speed.
        let (sine, cosine) = if self.angle_rad >= FRAC_PI_2 {
            (1.0, 0.0)
        } else {
            (libm::sin(self.angle_rad), libm::cos(self.angle_rad))
        };
        Vec3::new(cosine, 0.0, -sine) * self.speed
    }

    /// How long (s) a run lasts at most that may last `duration` (s): a push is over at its depth.
    pub fn time(&self, duration: f64) -> f64 {
        let sinking = -self.velocity().z;
        self.pushed_to.map_or(duration, |depth| duration.min(depth / sinking))
    }
}

/// The lists of `[conditions]`; one that is not given is the single value of `[impact]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionLists {
    /// Speeds (m/s).
    pub speed: Option<Vec<f64>>,
    /// Angles (rad).
    pub angle_rad: Option<Vec<f64>>,
    /// Start positions (m).
    pub x: Option<Vec<f64>>,
    /// Number of drawn start positions.
    pub positions: Option<u64>,
}

/// One impact of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Speed at first contact (m/s).
    pub speed: f64,
    /// Angle below the horizontal (rad).
    pub angle_rad: f64,
    /// Counts the start positions of one speed and angle, from 0.
    pub position_index: usize,
    /// Where the centre starts.
    pub x: StartX,
}

impl Condition {
    /// Angle below the horizontal (deg), as a file says it.
    pub fn angle_deg(&self) -> f64 {
        degrees(self.angle_rad)
    }
}

/// An angle (rad) in degrees, to 1e-9: what a file says as 30 deg is 30 here, and not the
/// 29.999999999999996 that comes back from radians.
pub(crate) fn degrees(angle_rad: f64) -> f64 {
    (angle_rad.to_degrees() * 1e9).round() / 1e9
}

/// Where an intruder starts along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StartX {
    /// Here (m).
    At(f64),
    /// Drawn in [`StartPositions::x_range`](super::StartPositions::x_range), from the seed and [`Condition::position_index`].
    Drawn,
}
