//! A straight round rod in the x–z plane: what of it is below the surface, and how its points move.

use std::f64::consts::{FRAC_PI_2, PI};

use engine::grains::Space;
use engine::math::{Vec3, Vec4};
use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};
use engine::units::Dimension;
use resistive::{Immersion, Part, PartLoad};

use crate::body::Body;
use crate::equations::{Equations, Point};
use crate::outline::Draft;

/// The angle (rad) of a link's axis to the vertical at the start.
pub(crate) const fn link_angle(
    key: &'static str,
    default: ParamDefault,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec {
        key,
        dimension: Dimension::ANGLE,
        default,
        allowed: Range::closed(-FRAC_PI_2, FRAC_PI_2),
        plausible: Range::closed(-1.4, 1.4),
        meaning,
    }
}

/// A uniform rod, and the coordinates that move it: x and z of a point of its axis and its own angle.
///
/// The ends of a real link are round; here they are flat, as in the formulas of the resistive force,
/// and the moment of inertia is that of a thin rod, as in the equations of the two-link chain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rod {
    /// (m).
    pub(crate) length: f64,
    /// (m).
    pub(crate) diameter: f64,
    /// (kg).
    pub(crate) mass: f64,
    /// From the tip to the point whose x and z are coordinates (m).
    pub(crate) to_reference: f64,
    /// Which coordinate is its angle.
    pub(crate) coordinate: usize,
}

/// Where a rod is and how it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    /// The point whose x and z are coordinates (m).
    pub(crate) reference: Vec3,
    /// Its velocity (m/s).
    pub(crate) velocity: Vec3,
    /// From the vertical to the axis (rad), positive when the top leans towards +x.
    pub(crate) angle: f64,
    /// Its rate (rad/s).
    pub(crate) spin: f64,
}

/// The portion of a rod below the surface.
#[derive(Clone, Copy, Debug)]
struct Portion {
    /// (m).
    length: f64,
    /// From the tip of the rod to its middle (m).
    middle: f64,
    /// Rate at which the surface takes in the axis, which makes the portion longer (m/s).
    intake: f64,
    /// Rate at which the middle moves away from the tip (m/s).
    drift: f64,
    /// Change of the length with depth (1).
    growth: f64,
}

impl Rod {
    /// Area (m², planar m) that an upright rod of these parameters has below the surface at `depth` (m):
    /// its end and its side.
    pub(crate) fn contact_area(params: &ParamTable, space: Space, depth: f64) -> f64 {
        let (length, diameter) = (params.get("length"), params.get("diameter"));
        let side = depth.clamp(0.0, length);
        match space {
            Space::Planar => diameter + 2.0 * side,
            Space::Spatial => PI * diameter * (0.25 * diameter + side),
        }
    }

    /// Volume of a rod (m³) of `length` and `diameter` (m); planar, the area (m²).
    pub(crate) fn volume(length: f64, diameter: f64, space: Space) -> f64 {
        match space {
            Space::Planar => diameter * length,
            Space::Spatial => 0.25 * PI * diameter * diameter * length,
        }
    }

    /// What grains touch: a rod of the same length over all with round ends, and the moments of
    /// inertia of this one, so that it moves as in a resistive medium.
    pub(crate) fn body(&self, space: Space) -> Body {
        let radius = 0.5 * self.diameter;
        let half = (0.5 * self.length - radius).max(0.0);
        let outline = Draft::at(-half - radius).dome(radius).line_to(radius, half).dome(radius);
        let across = self.length * self.length / 12.0;
        let along = match space {
            Space::Planar => radius * radius / 3.0,
            Space::Spatial => 0.5 * radius * radius,
        };
        Body::revolved(outline.revolve(space), Vec3::new(across, across, along))
    }

    /// Moment of inertia about its centre (kg m²).
    pub(crate) fn inertia(&self) -> f64 {
        self.mass * self.length * self.length / 12.0
    }

    /// Its centre (m).
    pub(crate) fn centre(&self, pose: &Pose) -> Vec3 {
        self.position(pose, 0.5 * self.length)
    }

    /// Energy (J) of the translation of its centre and of its rotation.
    pub(crate) fn kinetic_energy(&self, pose: &Pose) -> [f64; 2] {
        let velocity = self.velocity(pose, 0.5 * self.length);
        let (along, turning) = (velocity.norm_squared(), pose.spin * pose.spin);
        [0.5 * self.mass * along, 0.5 * self.inertia() * turning]
    }

    /// The rod in the medium; loads act on the middle of the immersed portion.
    pub(crate) fn part(&self, pose: &Pose) -> Part {
        let portion = self.portion(pose);
        let axis = pose.axis();
        let (tip, top) = (self.position(pose, 0.0), self.position(pose, self.length));
        let velocity = self.velocity(pose, portion.middle);
        let speed = velocity.norm();
        let end = Self::volume(1.0, self.diameter, Space::Spatial);
        let side = self.diameter * portion.length;
        // What the motion sees of the portion: its side, |sin| of the angle between axis and velocity,
        // and its end. Without motion there is nothing that could see it.
        let (across, along) = if speed > 0.0 {
            (axis.cross(&velocity).norm() / speed, axis.dot(&velocity).abs() / speed)
        } else {
            (0.0, 0.0)
        };
        let depth = -tip.z.min(top.z);
        Part {
            immersion: Immersion {
                depth,
                diameter: self.diameter,
                frontal_area: end,
                immersed_area: end,
                reference_area: side * across,
                end_area: end * along,
                volume: end * portion.length,
                section: end * portion.growth,
                volume_rate: end * portion.intake,
                body_volume: end * self.length,
                mass: self.mass,
                // Powers of it are taken, and a step that ends at the surface looks beyond it.
                effective_depth: depth.max(0.0),
                // What can be seen of the portion from below: it does not depend on the motion, as a
                // friction that can hold a body at rest must not.
                loaded_area: side * axis.x.abs() + end * axis.z.abs(),
                drag_factor: 1.0,
                friction_factor: 1.0,
                sideways_drag: 1.0,
                sideways_friction: 1.0,
            },
            velocity,
            spin: pose.spin,
            tip,
            tip_velocity: self.velocity(pose, 0.0),
            point: self.position(pose, portion.middle),
        }
    }

    /// Adds its inertia, its weight and the load on its immersed portion to the equations of motion.
    pub(crate) fn contribute(
        &self,
        equations: &mut Equations,
        pose: &Pose,
        load: &PartLoad,
        gravity: f64,
    ) {
        let centre = self.centre_point(pose);
        self.add_inertia_to(equations, pose);
        equations.add_force(&centre, Vec3::new(0.0, 0.0, -self.mass * gravity));

        let portion = self.portion(pose);
        let middle = self.point(pose, portion.middle, portion.drift);
        // Added mass follows the middle of the portion, which moves along the axis as the rod sinks.
        equations.add_mass(&middle, load.added_mass);
        equations.add_force(&middle, load.force);
        equations.add_couple(self.coordinate, load.couple);
    }

    /// Adds its inertia to the equations of motion.
    pub(crate) fn add_inertia_to(&self, equations: &mut Equations, pose: &Pose) {
        equations.add_mass(&self.centre_point(pose), self.mass);
        equations.add_inertia(self.coordinate, self.inertia());
    }

    /// How the coordinates move its centre.
    pub(crate) fn centre_point(&self, pose: &Pose) -> Point {
        self.point(pose, 0.5 * self.length, 0.0)
    }

    /// Velocity of its centre (m/s).
    pub(crate) fn centre_velocity(&self, pose: &Pose) -> Vec3 {
        self.velocity(pose, 0.5 * self.length)
    }

    /// Change of its kinetic energy with its angle while the rates stay (J/rad).
    pub(crate) fn turning(&self, pose: &Pose) -> f64 {
        let arm = 0.5 * self.length - self.to_reference;
        -self.mass * pose.spin * arm * self.centre_velocity(pose).dot(&pose.axis())
    }

    /// The point of the axis at a distance `from_tip` (m).
    pub(crate) fn position(&self, pose: &Pose, from_tip: f64) -> Vec3 {
        pose.reference + pose.axis() * (from_tip - self.to_reference)
    }

    /// The velocity of that point of the body (m/s).
    pub(crate) fn velocity(&self, pose: &Pose, from_tip: f64) -> Vec3 {
        pose.velocity + pose.normal() * (pose.spin * (from_tip - self.to_reference))
    }

    /// How the coordinates move the point `from_tip` (m), whose distance changes at the rate `drift`
    /// (m/s).
    fn point(&self, pose: &Pose, from_tip: f64, drift: f64) -> Point {
        let arm = from_tip - self.to_reference;
        let (axis, normal) = (pose.axis(), pose.normal());
        let (mut along_x, mut along_z) = (Vec4::x(), Vec4::y());
        along_x[self.coordinate] = arm * normal.x;
        along_z[self.coordinate] = arm * normal.z;
        let bias = normal * (pose.spin * drift) - axis * (arm * pose.spin * pose.spin);
        Point { along_x, along_z, bias }
    }

    fn portion(&self, pose: &Pose) -> Portion {
        let depth = |from_tip| -self.position(pose, from_tip).z;
        let (tip, top, slope) = (depth(0.0), depth(self.length), pose.axis().z);
        let intake = |from_tip| -self.velocity(pose, from_tip).z / slope.abs();
        if tip >= 0.0 && top >= 0.0 {
            let middle = 0.5 * self.length;
            Portion { length: self.length, middle, intake: 0.0, drift: 0.0, growth: 0.0 }
        } else if tip >= 0.0 {
            let length = (tip / slope).min(self.length);
            let intake = intake(length);
            let growth = 1.0 / slope;
            Portion { length, middle: 0.5 * length, intake, drift: 0.5 * intake, growth }
        } else if top >= 0.0 {
            let length = (-top / slope).min(self.length);
            let intake = intake(self.length - length);
            let middle = self.length - 0.5 * length;
            Portion { length, middle, intake, drift: -0.5 * intake, growth: -1.0 / slope }
        } else {
            Portion { length: 0.0, middle: 0.0, intake: 0.0, drift: 0.0, growth: 0.0 }
        }
    }
}

impl Pose {
    /// From tip to top.
    pub(crate) fn axis(&self) -> Vec3 {
        let (sin, cos) = libm::sincos(self.angle);
        Vec3::new(sin, 0.0, cos)
    }

    /// Where the axis turns as the angle grows.
    fn normal(&self) -> Vec3 {
        let axis = self.axis();
        Vec3::new(axis.z, 0.0, -axis.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROD: Rod =
        Rod { length: 0.2, diameter: 0.01, mass: 0.1, to_reference: 0.0, coordinate: 2 };

    /// The tip `depth` (m) below the surface and moving with `velocity`.
    fn pose(depth: f64, angle: f64, velocity: Vec3, spin: f64) -> Pose {
        Pose { reference: Vec3::new(0.0, 0.0, -depth), velocity, angle, spin }
    }

    #[test]
    fn the_centroid_moves_as_the_printed_kinematics_say() {
        let (depth, q, spin) = (0.05, 0.6, 7.0);
        let velocity = Vec3::new(0.3, 0.0, -1.1);
        let part = ROD.part(&pose(depth, q, velocity, spin));
        let tan = libm::tan(q);
        // Equal formulas in another order: round-off.
        assert!((part.point - Vec3::new(0.5 * depth * tan, 0.0, -0.5 * depth)).norm() < 1e-15);
        let expected = velocity + Vec3::new(0.5 * spin * depth, 0.0, -0.5 * spin * depth * tan);
        assert!((part.velocity - expected).norm() < 1e-14);
    }

    #[test]
    fn the_reference_area_is_the_printed_one_with_the_moving_angle() {
        let (depth, q) = (0.05, 0.6);
        for velocity in [Vec3::new(0.4, 0.0, -1.1), Vec3::new(-0.2, 0.0, -1.3)] {
            let at = ROD.part(&pose(depth, q, velocity, 0.0)).immersion;
            let moving = libm::atan(velocity.x / velocity.z);
            let length = depth / libm::cos(q);
            let printed = ROD.diameter * length * libm::sin(q - moving).abs();
            assert!((at.reference_area / printed - 1.0).abs() < 1e-13);
            let volume = 0.25 * PI * ROD.diameter * ROD.diameter * length;
            assert!((at.volume / volume - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_rod_that_moves_along_its_axis_shows_only_its_end() {
        let q = -0.4;
        let velocity = -pose(0.1, q, Vec3::zeros(), 0.0).axis() * 2.0;
        let at = ROD.part(&pose(0.1, q, velocity, 0.0)).immersion;
        // |e × v|/|v| of parallel vectors: round-off of order 1e-16.
        assert!(at.reference_area < 1e-14 * ROD.diameter * ROD.length);
        assert!((at.end_area / at.frontal_area - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_middle_drifts_as_its_own_difference_quotient_says() {
        for (depth, q) in [(0.05, 0.7), (0.05, -0.3), (0.35, 0.2), (-0.1, 2.5)] {
            let (velocity, spin) = (Vec3::new(0.3, 0.0, -1.1), 7.0);
            let step = 1e-6;
            let middle = |time: f64| {
                let moved = pose(depth, q + time * spin, velocity, spin);
                let reference = moved.reference + velocity * time;
                ROD.portion(&Pose { reference, ..moved })
            };
            let rate = (middle(step).middle - middle(-step).middle) / (2.0 * step);
            // Second-order error (1e-6 s × 7 rad/s)² and cancellation 1e-17/1e-6.
            assert!((rate - middle(0.0).drift).abs() < 1e-8, "{depth} {q}");
        }
    }

    #[test]
    fn a_flat_or_covered_rod_is_never_longer_than_it_is() {
        for (depth, q) in [(0.0, FRAC_PI_2), (1e-9, FRAC_PI_2), (0.3, 0.2), (0.1, 1.5), (0.0, 1.5)]
        {
            let part = ROD.part(&pose(depth, q, Vec3::new(0.0, 0.0, -1.0), 3.0));
            let most = Rod::volume(ROD.length, ROD.diameter, Space::Spatial) * (1.0 + 1e-12);
            assert!(part.immersion.volume <= most, "{depth} {q}");
            assert!(part.velocity.iter().all(|value| value.is_finite()), "{depth} {q}");
        }
    }
}
