//! A sphere and its motion, for tests of laws.

use std::f64::consts::PI;

use crate::{Immersion, Motion, Surroundings};
use engine::math::Vec3;

/// A sphere in contact with a bed.
pub(super) struct Sphere {
    radius: f64,
}

/// Of one inch.
pub(super) const SPHERE: Sphere = Sphere { radius: 0.0127 };

impl Sphere {
    pub(super) fn frontal_area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// The sphere with its lowest point at `depth` (m), not more than its diameter.
    pub(super) fn at(&self, depth: f64) -> Immersion {
        let (r, z) = (self.radius, depth.min(2.0 * self.radius));
        let section = PI * z * (2.0 * r - z);
        Immersion {
            depth,
            diameter: 2.0 * r,
            frontal_area: self.frontal_area(),
            immersed_area: if z < r { section } else { self.frontal_area() },
            reference_area: self.frontal_area(),
            end_area: 0.0,
            volume: PI * z * z * (r - z / 3.0),
            section,
            volume_rate: 0.0,
            body_volume: 4.0 / 3.0 * PI * r * r * r,
            mass: 0.0692,
            effective_depth: depth,
            loaded_area: self.frontal_area(),
            drag_factor: 1.0,
            friction_factor: 1.0,
            sideways_drag: 1.0,
            sideways_friction: 1.0,
        }
    }
}

/// Straight down at `speed` (m/s).
pub(super) fn sinking(speed: f64) -> Motion {
    Motion {
        velocity: Vec3::new(0.0, 0.0, -speed),
        speed,
        direction: Vec3::new(0.0, 0.0, -1.0),
        sense: [0.0, -1.0],
        spin: 0.0,
        time: 0.0,
    }
}

/// Glass beads.
pub(super) fn surroundings() -> Surroundings {
    Surroundings { bulk_density: 1520.0, gravity: 9.8, packing: None, bed_depth: None, fluid: None }
}
