//! The container: planar walls.

use crate::grains::Space;
use crate::math::Vec3;
use crate::surface::{Surface, SurfacePoint};

/// The half space behind a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// A point of the plane (m).
    pub origin: Vec3,
    /// Unit normal, towards the grains.
    pub normal: Vec3,
}

impl Surface for HalfSpace {
    fn closest(&self, point: Vec3) -> SurfacePoint {
        SurfacePoint {
            normal: self.normal,
            gap: (point - self.origin).dot(&self.normal),
            curvature: 0.0,
            felt: true,
        }
    }

    fn support(&self, direction: Vec3) -> f64 {
        if direction == self.normal { self.origin.dot(&self.normal) } else { f64::INFINITY }
    }

    fn bounding_radius(&self) -> f64 {
        f64::INFINITY
    }
}

/// A box with a floor at z = 0 and upright sides, open at the top: 0 ≤ x ≤ `width`, and in space
/// 0 ≤ y ≤ `depth`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Container {
    /// (m).
    pub width: f64,
    /// (m); ignored in a planar bed.
    pub depth: f64,
}

impl Container {
    /// Area of the floor (m²), or its width (m) in a plane.
    #[must_use]
    pub fn base(&self, space: Space) -> f64 {
        match space {
            Space::Planar => self.width,
            Space::Spatial => self.width * self.depth,
        }
    }

    /// The smaller distance of two opposite sides (m).
    #[must_use]
    pub fn narrowest(&self, space: Space) -> f64 {
        match space {
            Space::Planar => self.width,
            Space::Spatial => self.width.min(self.depth),
        }
    }

    /// The floor, then the sides.
    #[must_use]
    pub fn walls(&self, space: Space) -> Vec<HalfSpace> {
        let wall = |origin: Vec3, normal: Vec3| HalfSpace { origin, normal };
        let mut walls = vec![
            wall(Vec3::zeros(), Vec3::z()),
            wall(Vec3::zeros(), Vec3::x()),
            wall(Vec3::x() * self.width, -Vec3::x()),
        ];
        if space == Space::Spatial {
            walls.push(wall(Vec3::zeros(), Vec3::y()));
            walls.push(wall(Vec3::y() * self.depth, -Vec3::y()));
        }
        walls
    }
}
