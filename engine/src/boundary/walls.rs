//! Walls as a grain sees them.

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

/// What lies outside of an upright cylinder about x = y = half its diameter. It is hollow where grains
/// are, so its curvature is negative; along the axis it is straight, and what counts for the contact is
/// taken as the one curvature 1/R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InwardCylinder {
    /// Inner diameter (m).
    pub diameter: f64,
}

impl InwardCylinder {
    fn radius(&self) -> f64 {
        0.5 * self.diameter
    }
}

impl Surface for InwardCylinder {
    fn closest(&self, point: Vec3) -> SurfacePoint {
        let radius = self.radius();
        let from_axis = Vec3::new(point.x - radius, point.y - radius, 0.0);
        let distance = from_axis.norm();
        // On the axis every side is as near.
        let outward = if distance > 0.0 { from_axis / distance } else { Vec3::x() };
        SurfacePoint {
            normal: -outward,
            gap: radius - distance,
            curvature: -1.0 / radius,
            felt: true,
        }
    }

    fn support(&self, _: Vec3) -> f64 {
        f64::INFINITY
    }

    fn bounding_radius(&self) -> f64 {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hollow_cylinder_pushes_towards_its_axis_and_bends_away() {
        let wall = InwardCylinder { diameter: 0.2 };
        let point = wall.closest(Vec3::new(0.1, 0.03, 5.0));
        assert_eq!(point.normal, Vec3::y());
        assert!((point.gap - 0.03).abs() < 1e-16);
        assert_eq!(point.curvature.to_bits(), (-10.0_f64).to_bits());
        assert!((wall.closest(Vec3::new(0.1, 0.1, 0.0)).gap - 0.1).abs() < 1e-16);
        assert!(wall.closest(Vec3::new(0.21, 0.1, 0.0)).gap < 0.0);
    }
}
