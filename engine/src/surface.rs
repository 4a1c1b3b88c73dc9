//! What a wall or an intruder looks like to a grain.

use crate::feature::Feature;
use crate::math::{Quat, Vec3};

/// The point of a surface nearest to a query point, in the frame of the query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Outward unit normal at the nearest point.
    pub normal: Vec3,
    /// Distance of the query point from the surface (m); negative inside.
    pub gap: f64,
    /// Curvature of the surface there (1/m), as a contact law adds it to that of the grain: 1/R of a
    /// sphere, 0 of a flat face, and 0 of an edge or a tip, where the radius of the grain rules. Where
    /// two curvatures differ, what gives with the grain's the geometric mean of Hertz's theory.
    pub curvature: f64,
    /// Whether the body feels a contact there; grains feel it always.
    pub felt: bool,
}

/// A rigid, convex surface in its own (body) frame.
pub trait Surface: Send + Sync {
    /// The nearest point to `point` (m, body frame).
    fn closest(&self, point: Vec3) -> SurfacePoint;

    /// [`Surface::closest`] of many points: one virtual call for all of them.
    fn closest_many(&self, points: &[Vec3], nearest: &mut Vec<SurfacePoint>) {
        nearest.clear();
        nearest.extend(points.iter().map(|&point| self.closest(point)));
    }

    /// How far the surface reaches along the unit vector `direction` from the origin (m); of a body under a
    /// shaft, the body alone.
    fn support(&self, direction: Vec3) -> f64;

    /// Radius of the smallest sphere about the origin that holds the surface (m).
    fn bounding_radius(&self) -> f64;

    /// By what it meets a wall, if it moves; nothing of a wall itself. What is not felt
    /// ([`SurfacePoint::felt`]) meets none.
    fn features(&self) -> &[Feature] {
        &[]
    }

    /// Whether contacts at some points are not felt ([`SurfacePoint::felt`]).
    fn is_recessive(&self) -> bool {
        false
    }
}

/// Where a rigid part is, and how it moves, during one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Reference point at the end of the step (m).
    pub position: Vec3,
    /// Reference point half a step earlier (m).
    pub position_half: Vec3,
    /// Body frame to world at the end of the step.
    pub orientation: Quat,
    /// Body frame to world half a step earlier.
    pub orientation_half: Quat,
    /// Velocity of the reference point at the half step (m/s).
    pub velocity: Vec3,
    /// Spin at the half step (rad/s).
    pub spin: Vec3,
    /// Velocity extrapolated to the end of the step (m/s).
    pub velocity_now: Vec3,
    /// Spin extrapolated to the end of the step (rad/s).
    pub spin_now: Vec3,
    /// 1/m of the body (1/kg); 0 for one that cannot move.
    pub inverse_mass: f64,
    /// Moment of inertia of the body that counts in rolling (kg m²); infinite for one that cannot
    /// turn.
    pub inertia: f64,
}

impl Placement {
    /// A part that never moves, its frame the world frame.
    pub fn fixed() -> Self {
        Self {
            position: Vec3::zeros(),
            position_half: Vec3::zeros(),
            orientation: Quat::identity(),
            orientation_half: Quat::identity(),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            velocity_now: Vec3::zeros(),
            spin_now: Vec3::zeros(),
            inverse_mass: 0.0,
            inertia: f64::INFINITY,
        }
    }

    /// A world point in the body frame at the end of the step.
    #[inline]
    #[must_use]
    pub(crate) fn to_body(self, point: Vec3) -> Vec3 {
        self.orientation.inverse_transform_vector(&(point - self.position))
    }

    /// A world point in the body frame half a step earlier.
    #[inline]
    #[must_use]
    pub(crate) fn to_body_half(self, point: Vec3) -> Vec3 {
        self.orientation_half.inverse_transform_vector(&(point - self.position_half))
    }

    /// Velocity (m/s), at the end of the step, of the point of the body that lies `arm` (m) from its
    /// reference point.
    #[inline]
    pub(crate) fn velocity_at(&self, arm: Vec3) -> Vec3 {
        self.velocity_now + self.spin_now.cross(&arm)
    }

    /// Bound on the speed of any point of a part of radius `bounding_radius` (m/s).
    pub(crate) fn max_speed(&self, bounding_radius: f64) -> f64 {
        self.velocity.norm() + self.spin.norm() * bounding_radius
    }
}

/// Force on a rigid part, and torque about its reference point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// (N).
    pub force: Vec3,
    /// (N m).
    pub torque: Vec3,
    /// How many contacts it is the sum of.
    pub contacts: u32,
}

impl Wrench {
    /// Adds `other`.
    pub fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.torque += other.torque;
        self.contacts += other.contacts;
    }
}
