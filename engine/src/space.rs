//! Planar and spatial beds.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};

use serde::{Deserialize, Serialize};

/// How many dimensions the grains live in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Space {
    /// Discs in the x–z plane.
    Planar,
    /// Spheres.
    Spatial,
}

impl Space {
    /// Volume of a grain (m³), or its area (m²) in a plane, from its diameter (m).
    #[must_use]
    pub fn grain_content(self, diameter: f64) -> f64 {
        match self {
            Self::Planar => FRAC_PI_4 * diameter * diameter,
            Self::Spatial => FRAC_PI_6 * diameter * diameter * diameter,
        }
    }

    /// Moment of inertia of a grain over m r²: ½ of a disc, ⅖ of a sphere.
    #[must_use]
    pub fn inertia_coefficient(self) -> f64 {
        match self {
            Self::Planar => 0.5,
            Self::Spatial => 0.4,
        }
    }

    /// Moment of inertia (kg m²) of a grain.
    #[must_use]
    pub fn grain_inertia(self, mass: f64, radius: f64) -> f64 {
        self.inertia_coefficient() * mass * radius * radius
    }

    /// Cross-section of a sphere (m²), or the diameter of a disc (m).
    #[must_use]
    pub(crate) fn grain_cross_section(self, radius: f64) -> f64 {
        match self {
            Self::Planar => 2.0 * radius,
            Self::Spatial => std::f64::consts::PI * radius * radius,
        }
    }
}
