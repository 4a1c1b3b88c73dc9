//! From positions and velocities to a [`Contact`].
//!
//! Both sides share one contact point, so that arms add up to the distance of the centres and
//! angular momentum is conserved; it lies in the middle of the overlap. What was done during the
//! step uses half-step velocities, normal and arms; rates use velocities extrapolated to its end.

use crate::contact::{Contact, Partner, Response};
use crate::grains::{Grains, Load};
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
    inverse_mass_eff: f64,
    rolling_mobility: f64,
    partner: Partner,
}

// Inlined by force: the contact is then built where it is stored, which halves the time per contact.
#[inline(always)]
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
        inverse_mass_eff: bodies.inverse_mass_eff,
        rolling_mobility: bodies.rolling_mobility,
        partner: bodies.partner,
    }
}

/// The contact of grains `i` and `j`.
#[inline(always)]
pub(crate) fn between_grains(grains: &Grains, i: usize, j: usize, dt: f64) -> Contact {
    let both = |of: &[Vec3]| [of[i], of[j]];
    let apart = grains.apart(i, j);
    let (r_i, r_j) = (grains.radius[i], grains.radius[j]);
    let meet = |apart: Vec3, [v_i, v_j]: [Vec3; 2], [w_i, w_j]: [Vec3; 2]| {
        let distance = apart.norm();
        let normal = apart * (1.0 / distance);
        let overlap = r_i + r_j - distance;
        let (arm_i, arm_j) = arms_between_grains(normal, overlap, r_i, r_j);
        (Meeting { normal, arm_i, arm_j, v_i, w_i, v_j, w_j }, overlap)
    };
    let made = both(&grains.velocity);
    let (now, overlap) = meet(apart, both(&grains.velocity_now), both(&grains.spin_now));
    let (half, _) = meet(apart - (made[0] - made[1]) * (0.5 * dt), made, both(&grains.spin));
    let bodies = Bodies {
        overlap,
        inverse_radius_eff: grains.inverse_radius[i] + grains.inverse_radius[j],
        inverse_mass_eff: grains.inverse_mass[i] + grains.inverse_mass[j],
        rolling_mobility: grains.rolling_mobility[i] + grains.rolling_mobility[j],
        partner: Partner::Grain,
    };
    assemble(&now, &half, bodies, dt)
}

/// From both centres to the middle of the overlap.
#[inline(always)]
fn arms_between_grains(normal: Vec3, overlap: f64, r_i: f64, r_j: f64) -> (Vec3, Vec3) {
    (normal * (0.5 * overlap - r_i), normal * (r_j - 0.5 * overlap))
}

/// The contact of a grain with a rigid part. `(i, position)` is the grain and the image of its centre
/// that is nearest to the part; `now` and `half` are the nearest points of the surface to that at the
/// end and in the middle of the step, body frame.
#[inline]
pub(crate) fn with_surface(
    grains: &Grains,
    (i, position): (usize, Vec3),
    (placement, partner): (&Placement, Partner),
    now: &SurfacePoint,
    half: &SurfacePoint,
    dt: f64,
) -> Contact {
    let radius = grains.radius[i];
    let position_half = position - grains.velocity[i] * (0.5 * dt);

    let normal = placement.orientation * now.normal;
    let (arm_i, arm_j) =
        arms_to_surface(normal, radius - now.gap, radius, position - placement.position);
    let at_end = Meeting {
        normal,
        arm_i,
        arm_j,
        v_i: grains.velocity_now[i],
        w_i: grains.spin_now[i],
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
        v_i: grains.velocity[i],
        w_i: grains.spin[i],
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
    let bodies = Bodies {
        overlap: radius - now.gap,
        inverse_radius_eff: grains.inverse_radius[i] + now.curvature,
        inverse_mass_eff: grains.inverse_mass[i] + placement.inverse_mass,
        rolling_mobility: grains.rolling_mobility[i] + body_mobility,
        partner,
    };
    assemble(&at_end, &at_half, bodies, dt)
}

/// From the centre of a grain, and from the reference point of a part that lies `apart` behind it,
/// to the middle of the overlap.
#[inline]
fn arms_to_surface(normal: Vec3, overlap: f64, radius: f64, apart: Vec3) -> (Vec3, Vec3) {
    let arm_i = normal * (0.5 * overlap - radius);
    (arm_i, apart + arm_i)
}

/// Force and torque on both grains of a contact, exactly opposite forces.
#[inline]
pub(crate) fn loads_on_grains(
    contact: &Contact,
    response: &Response,
    r_i: f64,
    r_j: f64,
) -> (Load, Load) {
    let (arm_i, arm_j) = arms_between_grains(contact.normal, contact.overlap, r_i, r_j);
    let (force, twist) = (force(contact, response), response.tangential_force);
    (
        Load { force, torque: arm_i.cross(&twist) + response.couple },
        Load { force: -force, torque: -arm_j.cross(&twist) - response.couple },
    )
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
