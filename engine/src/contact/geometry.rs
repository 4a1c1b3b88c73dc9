//! From positions and velocities to the [`Contact`] of a grain with a surface; two grains meet in
//! `dimension`.
//!
//! Both sides share one contact point, so that arms add up to the distance of the centres and
//! angular momentum is conserved; it lies in the middle of the overlap. What was done during the
//! step uses half-step velocities, normal and arms; rates use velocities extrapolated to its end.

use crate::contact::{Contact, Response};
use crate::dimension::{Load, Motion};
use crate::math::Vec3;
use crate::surface::{Placement, SurfacePoint, Wrench};

/// Velocities and spins of both sides of a contact at one instant, and where they meet.
struct Meeting {
    normal: Vec3,
    /// From the centre of i to the contact point.
    arm_i: Vec3,
    /// From the centre (or reference point) of j to the contact point.
    arm_j: Vec3,
    v_i: Vec3,
    w_i: Vec3,
    v_j: Vec3,
    w_j: Vec3,
}

impl Meeting {
    /// Velocity of the surface of i relative to that of j: along the normal, and in the plane.
    #[inline(always)]
    fn relative_velocity(&self) -> (f64, Vec3) {
        let velocity =
            self.v_i - self.v_j + self.w_i.cross(&self.arm_i) - self.w_j.cross(&self.arm_j);
        let along = velocity.dot(&self.normal);
        (along, velocity - self.normal * along)
    }
}

/// What a law wants to know of the two bodies.
struct Bodies {
    overlap: f64,
    inverse_radius_eff: f64,
    inverse_radius_eff_before: f64,
    inverse_mass_eff: f64,
    rolling_mobility: f64,
}

#[inline]
fn assemble(now: &Meeting, half: &Meeting, bodies: Bodies, dt: f64) -> Contact {
    let (normal_rate, slip_velocity) = now.relative_velocity();
    let (normal_step, slip_rate) = half.relative_velocity();
    // Turning the slip of one step changes its length by the square of the angle of half a step:
    // second order in the step, so the projection does.
    let slip_step = (slip_rate - now.normal * slip_rate.dot(&now.normal)) * dt;
    Contact {
        normal: now.normal,
        overlap: bodies.overlap,
        overlap_rate: -normal_rate,
        overlap_step: -normal_step * dt,
        slip_velocity,
        slip_step,
        relative_spin: now.w_i - now.w_j,
        relative_turn: (half.w_i - half.w_j) * dt,
        inverse_radius_eff: bodies.inverse_radius_eff,
        inverse_radius_eff_before: bodies.inverse_radius_eff_before,
        inverse_mass_eff: bodies.inverse_mass_eff,
        rolling_mobility: bodies.rolling_mobility,
    }
}

/// The contact of a grain with a rigid part; `grain` is at the image of its centre that is nearest to the
/// part, `now` and `half` are the nearest points of the surface to that at the end and in the middle of
/// the step, body frame; `before` is 1/R* (1/m) at the end of the last one, if the two overlapped then.
#[inline]
pub(crate) fn with_surface(
    grain: &Motion,
    placement: &Placement,
    (now, half): (&SurfacePoint, &SurfacePoint),
    before: Option<f64>,
    dt: f64,
) -> Contact {
    let (position, radius) = (grain.position, grain.radius);
    let position_half = position - grain.velocity * (0.5 * dt);

    let normal = placement.orientation * now.normal;
    let (arm_i, arm_j) =
        arms_to_surface(normal, radius - now.gap, radius, position - placement.position);
    let at_end = Meeting {
        normal,
        arm_i,
        arm_j,
        v_i: grain.velocity_now,
        w_i: grain.spin_now,
        v_j: placement.velocity_now,
        w_j: placement.spin_now,
    };
    let normal = placement.orientation_half * half.normal;
    let apart = position_half - placement.position_half;
    let (arm_i, arm_j) = arms_to_surface(normal, radius - half.gap, radius, apart);
    let at_half = Meeting {
        normal,
        arm_i,
        arm_j,
        v_i: grain.velocity,
        w_i: grain.spin,
        v_j: placement.velocity,
        w_j: placement.spin,
    };

    let is_flat = now.curvature == 0.0;
    let body_mobility = if is_flat || placement.inverse_mass == 0.0 {
        0.0
    } else {
        let mass = 1.0 / placement.inverse_mass;
        1.0 / (placement.inertia + mass / (now.curvature * now.curvature))
    };
    let inverse_radius_eff = grain.inverse_radius + now.curvature;
    let bodies = Bodies {
        overlap: radius - now.gap,
        inverse_radius_eff,
        inverse_radius_eff_before: before.unwrap_or(inverse_radius_eff),
        inverse_mass_eff: grain.inverse_mass + placement.inverse_mass,
        rolling_mobility: grain.rolling_mobility + body_mobility,
    };
    assemble(&at_end, &at_half, bodies, dt)
}

/// Where a point of a moving part meets a wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Of the part, foremost into the wall (m).
    pub(crate) point: Vec3,
    /// Of the wall, towards the part (–).
    pub(crate) normal: Vec3,
    /// From the wall to the point (m), negative inside of it.
    pub(crate) gap: f64,
    /// Of the wall (1/m).
    pub(crate) curvature: f64,
}

impl Touch {
    /// From the reference point of the part, at `position`, to the middle of the overlap.
    fn arm(&self, position: Vec3) -> Vec3 {
        self.point - position - self.normal * (0.5 * self.gap)
    }
}

/// The contact of a rigid part with a wall that stands still; `now` and `half` are where they meet at the end and in the
/// middle of the step, `curvature` (1/m) is that of the part; `before` as in [`with_surface`].
pub(crate) fn with_wall(
    placement: &Placement,
    (now, half): (&Touch, &Touch),
    curvature: f64,
    before: Option<f64>,
    dt: f64,
) -> Contact {
    let still = Vec3::zeros();
    let meeting = |touch: &Touch, position: Vec3, [v_i, w_i]: [Vec3; 2]| Meeting {
        normal: touch.normal,
        arm_i: touch.arm(position),
        arm_j: still,
        v_i,
        w_i,
        v_j: still,
        w_j: still,
    };
    let at_end = meeting(now, placement.position, [placement.velocity_now, placement.spin_now]);
    let at_half = meeting(half, placement.position_half, [placement.velocity, placement.spin]);
    let inverse_radius_eff = curvature + now.curvature;
    let mass = 1.0 / placement.inverse_mass;
    let bodies = Bodies {
        overlap: -now.gap,
        inverse_radius_eff,
        inverse_radius_eff_before: before.unwrap_or(inverse_radius_eff),
        inverse_mass_eff: placement.inverse_mass,
        rolling_mobility: 1.0 / (placement.inertia + mass / (curvature * curvature)),
    };
    assemble(&at_end, &at_half, bodies, dt)
}

/// What a wall does to the part that touches it.
pub(crate) fn load_on_part(
    placement: &Placement,
    touch: &Touch,
    contact: &Contact,
    response: &Response,
) -> Wrench {
    let force = force(contact, response);
    let torque = touch.arm(placement.position).cross(&force) + response.couple;
    Wrench { force, torque, contacts: 1 }
}

/// From the centre of a grain, and from the reference point of a part that lies `apart` behind it,
/// to the middle of the overlap.
#[inline]
fn arms_to_surface(normal: Vec3, overlap: f64, radius: f64, apart: Vec3) -> (Vec3, Vec3) {
    let arm_i = normal * (0.5 * overlap - radius);
    (arm_i, apart + arm_i)
}

/// Force and torque on the grain of a contact with a part that lies `apart` behind it, and on the
/// part about its reference point.
#[inline]
pub(crate) fn loads_on_grain_and_part(
    contact: &Contact,
    response: &Response,
    radius: f64,
    apart: Vec3,
) -> (Load, Wrench) {
    let (arm_i, arm_j) = arms_to_surface(contact.normal, contact.overlap, radius, apart);
    let force = force(contact, response);
    (
        Load { force, torque: arm_i.cross(&response.tangential_force) + response.couple },
        Wrench { force: -force, torque: -arm_j.cross(&force) - response.couple, contacts: 1 },
    )
}

#[inline]
fn force(contact: &Contact, response: &Response) -> Vec3 {
    contact.normal * response.normal_force + response.tangential_force
}
