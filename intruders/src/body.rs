//! A shape with its mass.

use std::sync::Arc;

use engine::math::Vec3;
use engine::surface::Surface;

use crate::outline::Revolved;

/// A shape with its distribution of mass, in the body frame: the centre of mass at the origin, the
/// axis of symmetry along z, and what enters first towards −z.
pub struct Body {
    /// Its surface; in a planar medium, the mid-plane of it is what counts.
    pub surface: Arc<dyn Surface>,
    /// Principal moments of inertia of one kilogram of it (m²); planar, of its mid-plane.
    pub inertia_per_mass: Vec3,
    /// What it looks like.
    pub drawing: Drawing,
}

/// How a shape is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// A ball about the origin, of this radius (m).
    Ball(f64),
    /// A body of revolution about z: heights, and the half width there (m), from bottom to top.
    Revolved(Vec<(f64, f64)>),
}

impl Body {
    /// With these moments of inertia per mass (m²).
    pub(crate) fn revolved(surface: Revolved, inertia_per_mass: Vec3) -> Self {
        let drawing = Drawing::Revolved(surface.sections());
        Self { surface: Arc::new(surface), inertia_per_mass, drawing }
    }
}
