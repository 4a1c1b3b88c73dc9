//! The ball of parry as a surface: the only file where parry's vectors meet ours.

use engine::feature::Feature;
use engine::math::Vec3;
use engine::surface::{Surface, SurfacePoint};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{Ball, Shape, SupportMap};

fn to_parry(v: Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn from_parry(v: Vector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// A parry ball about the origin.
pub(crate) struct BallSurface {
    ball: Ball,
    features: [Feature; 1],
}

impl BallSurface {
    /// Of `radius` (m).
    pub(crate) fn new(radius: f64) -> Self {
        Self { ball: Ball::new(radius), features: [Feature::ball(radius)] }
    }
}

impl Surface for BallSurface {
    fn closest(&self, point: Vec3) -> SurfacePoint {
        let local = to_parry(point);
        SurfacePoint {
            // Radial, not from the projected point: on the surface their difference has no direction.
            normal: from_parry(local.try_normalize().unwrap_or(Vector::Z)),
            gap: self.ball.distance_to_local_point(local, false),
            curvature: 1.0 / self.ball.radius,
            felt: true,
        }
    }

    fn support(&self, direction: Vec3) -> f64 {
        let direction = to_parry(direction);
        self.ball.local_support_point(direction).dot(direction)
    }

    fn bounding_radius(&self) -> f64 {
        self.ball.compute_local_bounding_sphere().radius()
    }

    fn features(&self) -> &[Feature] {
        &self.features
    }
}
