//! From positions and velocities to a [`Contact`].
//!
//! Both sides share one contact point, so that arms add up to the distance of the centres and
//! angular momentum is conserved; it lies in the middle of the overlap. What was done during the
//! step uses half-step velocities, normal and arms; rates use velocities extrapolated to its end.

use crate::contact::{Contact, Partner, Response, turn_into_plane};
use crate::grains::{Grains, Load};
use crate::math::Vec3;
use crate::surface::{Placement, SurfacePoint, Wrench};

/// A contact together with what is needed to hand its force to both sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Located {
    pub(crate) contact: Contact,
    /// From the centre of i to the contact point [m].
    pub(crate) arm_i: Vec3,
    /// From the centre (or reference point) of j to the contact point [m].
    pub(crate) arm_j: Vec3,
}

/// Motion of both sides at one instant, arms included.
struct Meeting {
    normal: Vec3,
    arm_i: Vec3,
    arm_j: Vec3,
}

impl Meeting {
    /// Velocity of the surface of i relative to that of j.
    #[inline]
    fn relative(&self, v_i: Vec3, w_i: Vec3, v_j: Vec3, w_j: Vec3) -> Vec3 {
        v_i - v_j + w_i.cross(&self.arm_i) - w_j.cross(&self.arm_j)
    }
}

/// Velocities and spins of both sides.
struct Motion {
    v_i: Vec3,
    w_i: Vec3,
    v_j: Vec3,
    w_j: Vec3,
}

struct Bodies {
    overlap: f64,
    radius_eff: f64,
    mass_eff: f64,
    rolling_inertia_eff: f64,
    partner: Partner,
}

#[inline]
fn assemble(
    now: &Meeting,
    half: &Meeting,
    rates: &Motion,
    made: &Motion,
    bodies: &Bodies,
    dt: f64,
) -> Located {
    let rate = now.relative(rates.v_i, rates.w_i, rates.v_j, rates.w_j);
    let normal_rate = rate.dot(&now.normal);
    let step = half.relative(made.v_i, made.w_i, made.v_j, made.w_j) * dt;
    let normal_step = step.dot(&half.normal);
    let slip_step = step - half.normal * normal_step;
    Located {
        contact: Contact {
            normal: now.normal,
            overlap: bodies.overlap,
            overlap_rate: -normal_rate,
            overlap_step: -normal_step,
            slip_velocity: rate - now.normal * normal_rate,
            slip_step: turn_into_plane(slip_step, now.normal),
            relative_spin: rates.w_i - rates.w_j,
            relative_turn: (made.w_i - made.w_j) * dt,
            radius_eff: bodies.radius_eff,
            mass_eff: bodies.mass_eff,
            rolling_inertia_eff: bodies.rolling_inertia_eff,
            partner: bodies.partner,
        },
        arm_i: now.arm_i,
        arm_j: now.arm_j,
    }
}

/// The contact of grains `i` and `j`, whose centres are `apart` = x_i − x_j [m].
#[inline]
pub(crate) fn between_grains(
    grains: &Grains,
    i: usize,
    j: usize,
    apart: Vec3,
    dt: f64,
) -> Located {
    let (r_i, r_j) = (grains.radius[i], grains.radius[j]);
    let made = Motion {
        v_i: grains.velocity[i],
        w_i: grains.spin[i],
        v_j: grains.velocity[j],
        w_j: grains.spin[j],
    };
    let rates = Motion {
        v_i: grains.velocity_now[i],
        w_i: grains.spin_now[i],
        v_j: grains.velocity_now[j],
        w_j: grains.spin_now[j],
    };
    let meet = |apart: Vec3| {
        let distance = apart.norm();
        let normal = apart / distance;
        let overlap = r_i + r_j - distance;
        let meeting = Meeting {
            normal,
            arm_i: normal * (0.5 * overlap - r_i),
            arm_j: normal * (r_j - 0.5 * overlap),
        };
        (meeting, overlap)
    };
    let (now, overlap) = meet(apart);
    let (half, _) = meet(apart - (made.v_i - made.v_j) * (0.5 * dt));
    let bodies = Bodies {
        overlap,
        radius_eff: r_i * r_j / (r_i + r_j),
        mass_eff: 1.0 / (grains.inverse_mass[i] + grains.inverse_mass[j]),
        rolling_inertia_eff: 1.0 / (grains.rolling_mobility[i] + grains.rolling_mobility[j]),
        partner: Partner::Grain,
    };
    assemble(&now, &half, &rates, &made, &bodies, dt)
}

/// The contact of grain `i` with a rigid part; `now` and `half` are the nearest points of its
/// surface to the grain's centre at the end and in the middle of the step, body frame.
#[inline]
pub(crate) fn with_surface(
    grains: &Grains,
    i: usize,
    part: (&Placement, Partner),
    now: &SurfacePoint,
    half: &SurfacePoint,
    dt: f64,
) -> Located {
    let (placement, partner) = part;
    let radius = grains.radius[i];
    let made = Motion {
        v_i: grains.velocity[i],
        w_i: grains.spin[i],
        v_j: placement.velocity,
        w_j: placement.spin,
    };
    let rates = Motion {
        v_i: grains.velocity_now[i],
        w_i: grains.spin_now[i],
        v_j: placement.velocity_now,
        w_j: placement.spin_now,
    };
    let meet = |normal: Vec3, gap: f64, apart: Vec3| {
        let arm_i = normal * (0.5 * (radius - gap) - radius);
        Meeting { normal, arm_i, arm_j: apart + arm_i }
    };
    let position = grains.position[i];
    let position_half = position - made.v_i * (0.5 * dt);
    let now_world = meet(placement.orientation * now.normal, now.gap, position - placement.position);
    let half_world = meet(
        placement.orientation_half * half.normal,
        half.gap,
        position_half - placement.position_half,
    );
    let flat = now.curvature == 0.0;
    let body_mobility = if flat || placement.inverse_mass == 0.0 {
        0.0
    } else {
        let mass = 1.0 / placement.inverse_mass;
        1.0 / (placement.inertia + mass / (now.curvature * now.curvature))
    };
    let bodies = Bodies {
        overlap: radius - now.gap,
        radius_eff: radius / (1.0 + radius * now.curvature),
        mass_eff: 1.0 / (grains.inverse_mass[i] + placement.inverse_mass),
        rolling_inertia_eff: 1.0 / (grains.rolling_mobility[i] + body_mobility),
        partner,
    };
    assemble(&now_world, &half_world, &rates, &made, &bodies, dt)
}

impl Located {
    /// Force and torque on i.
    #[inline]
    pub(crate) fn load_on_i(&self, response: &Response) -> Load {
        let force = self.force(response);
        Load { force, torque: self.arm_i.cross(&response.tangential_force) + response.couple }
    }

    /// Force and torque on grain j, the exact opposite of the force on i.
    #[inline]
    pub(crate) fn load_on_j(&self, response: &Response) -> Load {
        let force = -self.force(response);
        Load { force, torque: -self.arm_j.cross(&response.tangential_force) - response.couple }
    }

    /// Force and torque on a rigid part, about its reference point.
    #[inline]
    pub(crate) fn wrench_on_part(&self, response: &Response) -> Wrench {
        let force = -self.force(response);
        Wrench { force, torque: self.arm_j.cross(&force) - response.couple, contacts: 1 }
    }

    #[inline]
    fn force(&self, response: &Response) -> Vec3 {
        self.contact.normal * response.normal_force + response.tangential_force
    }
}
