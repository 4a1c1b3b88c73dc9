//! An impact as it is seen: which grains, from where, in which colours, at which times.
//!
//! [`Impact`] is what the logs of a run tell of it, [`View`] a way to look at it, and [`Scene`] what is seen at one
//! time. The page of a run (`run/impact.rs`) and films (`movie`) draw the same scenes.

mod colour;
mod forces;
mod impact;
mod layout;
mod scenes;
mod shapes;
mod view;

pub use colour::Quantity;
pub(crate) use colour::{STEPS, ramp};
pub use forces::Forces;
pub use impact::{Impact, SceneError};
pub(crate) use layout::{BODY, LINES, PATH};
pub use layout::{height_for, sheet};
pub use view::{Extent, Look, View};

pub(crate) use shapes::hull;

/// What is seen at one time, in the coordinates of a view: to the right and upward (m).
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Which frame of the log.
    pub frame: usize,
    /// Simulated time (s).
    pub time: f64,
    /// What is shown.
    pub window: Extent,
    /// Grains, the nearest last.
    pub discs: Vec<Disc>,
    /// Bodies.
    pub bodies: Vec<Outline>,
    /// Where centres of mass have been until now.
    pub paths: Vec<Vec<[f64; 2]>>,
    /// Forces of the ground on bodies.
    pub forces: Vec<Force>,
}

/// A grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The number of the grain.
    pub id: u32,
    /// Centre, and how near it is to the viewer (m).
    pub place: [f64; 3],
    /// Radius (m).
    pub radius: f64,
    /// Speed (m/s), force (N), displacement (m).
    pub values: [f64; 3],
}

/// What is seen of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Its corners, counter-clockwise (m).
    pub corners: Vec<[f64; 2]>,
    /// How near it is (m); what is nearer lies over it.
    pub near: f64,
}

/// A force on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force {
    /// Where the body is (m).
    pub at: [f64; 2],
    /// (N), to the right and upward.
    pub newton: [f64; 2],
}
