//! Discs in the x–z plane, spinning about y.
//!
//! Slips go along t = y × n, so that the tangential spring is one number that needs no turning.

use wide::f64x4;

use super::{
    Components, Dimension, Frame, Load, Motion, Motions, Places, Quad, Squares, Stride, gather,
    gather_place, inverse_nearby, with_last_of,
};
use crate::boundary::Period;
use crate::contact::{Contact, Response};
use crate::lanes::{Lanes, MOST_LANES, Vector};
use crate::math::Vec3;

/// A place is (x, z, r, 1/r), a motion (v_x, v_z, ω, 1/m), (v_x, v_z, ω at the end of the step, mobility),
/// a load (F_x, F_z, M, 0).
pub(crate) struct Planar;

/// (F_x, F_z, M) of a load: the components that a plane has.
fn components(force: Vec3, torque: Vec3) -> [f64; 3] {
    [force.x, force.z, torque.y]
}

fn in_plane(x: f64, z: f64) -> Vec3 {
    Vec3::new(x, 0.0, z)
}

impl Dimension<1> for Planar {
    type Moves = [Quad; 2];
    type Load = [f64; 4];

    const FIRST_EVERY: usize = 8;
    const RECORD_EVERY: usize = 4;

    fn pack(state: &Motion, place: &mut Quad, motion: &mut [Quad; 2]) {
        let quad = |velocity, spin, last| {
            let [x, z, turn] = components(velocity, spin);
            Quad([x, z, turn, last])
        };
        let Motion { position, radius, .. } = *state;
        *place = Quad([position.x, position.z, radius, state.inverse_radius]);
        motion[0] = quad(state.velocity, state.spin, state.inverse_mass);
        motion[1] = quad(state.velocity_now, state.spin_now, state.rolling_mobility);
    }

    #[inline(always)]
    fn unpack(place: &Quad, motion: &[Quad; 2]) -> Motion {
        let [x, z, radius, inverse_radius] = place.0;
        let [v_x, v_z, spin, inverse_mass] = motion[0].0;
        let [now_x, now_z, spin_now, rolling_mobility] = motion[1].0;
        Motion {
            position: in_plane(x, z),
            velocity: in_plane(v_x, v_z),
            spin: Vec3::new(0.0, spin, 0.0),
            velocity_now: in_plane(now_x, now_z),
            spin_now: Vec3::new(0.0, spin_now, 0.0),
            radius,
            inverse_radius,
            inverse_mass,
            rolling_mobility,
        }
    }

    #[inline(always)]
    fn position(place: &Quad) -> Vec3 {
        in_plane(place.0[0], place.0[1])
    }

    #[inline(always)]
    fn radius(place: &Quad) -> f64 {
        place.0[2]
    }

    #[inline(always)]
    fn are_near<R: Lanes>(i: &Places<'_>, j: &Places<'_>, period: &Period, margin: f64) -> R::Mask {
        let [[x_i, z_i, r_i, _], [x_j, z_j, r_j, _]] = [i, j].map(gather_place::<R>);
        let x = period.nearest(0, x_i - x_j);
        let z = z_i - z_j;
        let reach = r_i + r_j + R::splat(margin);
        (x * x + z * z).simd_lt(reach * reach)
    }

    #[inline(always)]
    fn between<R: Lanes>(
        (place_i, i): (&Places<'_>, &Motions<'_, [Quad; 2]>),
        (place_j, j): (&Places<'_>, &Motions<'_, [Quad; 2]>),
        period: &Period,
        dt: f64,
    ) -> (Contact<R, 1>, Frame<R>) {
        let half = R::splat(0.5);
        let step = R::splat(dt);
        let [x_i, z_i, r_i, curvature_i] = gather_place::<R>(place_i);
        let [x_j, z_j, r_j, curvature_j] = gather_place::<R>(place_j);
        let x = period.nearest(0, x_i - x_j);
        let z = z_i - z_j;
        let reach = r_i + r_j;
        let distance = (x * x + z * z).simd_sqrt();
        let inverse = R::one() / distance;
        let (n_x, n_z) = (x * inverse, z * inverse);
        let overlap = reach - distance;
        let arms = [half * overlap - r_i, r_j - half * overlap];

        let [x_i, z_i, spin_i, mobility_i] = gather::<R, 2>(i, 1);
        let [x_j, z_j, spin_j, mobility_j] = gather::<R, 2>(j, 1);
        let (v_x, v_z) = (x_i - x_j, z_i - z_j);
        let overlap_rate = -(v_x * n_x + v_z * n_z);
        let slip_velocity = v_x * n_z - v_z * n_x + (spin_i * arms[0] - spin_j * arms[1]);

        // The same in the middle of the step, over the way made in it.
        let [x_i, z_i, turn_i, inverse_mass_i] = gather::<R, 2>(i, 0);
        let [x_j, z_j, turn_j, inverse_mass_j] = gather::<R, 2>(j, 0);
        let (d_x, d_z) = ((x_i - x_j) * step, (z_i - z_j) * step);
        let turns = [turn_i * step, turn_j * step];
        let (h_x, h_z) = (x - half * d_x, z - half * d_z);
        let inverse_2 = inverse * inverse;
        let change = (h_x * h_x + h_z * h_z) * inverse_2 - R::one();
        let inverse_half = inverse_nearby(inverse, change);
        let (n_x_half, n_z_half) = (h_x * inverse_half, h_z * inverse_half);
        let overlap_half = reach - (h_x * n_x_half + h_z * n_z_half);
        let arms_half = [half * overlap_half - r_i, r_j - half * overlap_half];
        let overlap_step = -(d_x * n_x_half + d_z * n_z_half);
        let slip_step =
            d_x * n_z_half - d_z * n_x_half + (turns[0] * arms_half[0] - turns[1] * arms_half[1]);

        let inverse_radius_eff = curvature_i + curvature_j;
        let contact = Contact {
            normal: Vector::from([R::zero()]),
            overlap,
            overlap_rate,
            overlap_step,
            slip_velocity: Vector::from([slip_velocity]),
            slip_step: Vector::from([slip_step]),
            relative_spin: Vector::from([spin_i - spin_j]),
            relative_turn: Vector::from([turns[0] - turns[1]]),
            inverse_radius_eff,
            inverse_radius_eff_before: inverse_radius_eff,
            inverse_mass_eff: inverse_mass_i + inverse_mass_j,
            rolling_mobility: mobility_i + mobility_j,
        };
        let frame = Frame {
            normal: Vector::from([n_x, R::zero(), n_z]),
            arms,
            curvature: curvature_i.simd_max(curvature_j),
        };
        (contact, frame)
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    unsafe fn scatter<R: Lanes>(
        frame: &Frame<R>,
        response: &Response<R, 1>,
        targets: &[[u32; 2]; MOST_LANES],
        loads: &mut [[f64; 4]],
    ) {
        let (n_x, n_z) = (frame.normal[0], frame.normal[2]);
        let (pressed, sheared) = (response.normal_force, response.tangential_force[0]);
        let f_x = n_x * pressed + n_z * sheared;
        let f_z = n_z * pressed - n_x * sheared;
        let on_i = frame.arms[0] * sheared + response.couple[0];
        let on_j = -(frame.arms[1] * sheared) - response.couple[0];
        let on_i = R::rows([f_x, f_z, on_i, R::zero()]);
        let on_j = R::rows([-f_x, -f_z, on_j, R::zero()]);
        for lane in 0..R::COUNT {
            let [i, j] = targets[lane].map(|target| target as usize);
            // SAFETY: the caller's.
            unsafe { loads.get_unchecked_mut(i) }.add(&on_i[lane]);
            // SAFETY: the caller's.
            unsafe { loads.get_unchecked_mut(j) }.add(&on_j[lane]);
        }
    }

    #[inline(always)]
    fn narrow(contact: &Contact) -> Contact<f64, 1> {
        let normal = contact.normal;
        let slip = |slip: &Vec3| Vector::from([slip.x * normal.z - slip.z * normal.x]);
        Contact {
            normal: Vector::from([0.0]),
            overlap: contact.overlap,
            overlap_rate: contact.overlap_rate,
            overlap_step: contact.overlap_step,
            slip_velocity: slip(&contact.slip_velocity),
            slip_step: slip(&contact.slip_step),
            relative_spin: Vector::from([contact.relative_spin.y]),
            relative_turn: Vector::from([contact.relative_turn.y]),
            inverse_radius_eff: contact.inverse_radius_eff,
            inverse_radius_eff_before: contact.inverse_radius_eff_before,
            inverse_mass_eff: contact.inverse_mass_eff,
            rolling_mobility: contact.rolling_mobility,
        }
    }

    #[inline(always)]
    fn widen(response: &Response<f64, 1>, normal: Vec3) -> Response {
        Response {
            normal_force: response.normal_force,
            adhesive_force: response.adhesive_force,
            holds: response.holds,
            normal_stiffness: response.normal_stiffness,
            tangential_force: in_plane(normal.z, -normal.x) * response.tangential_force[0],
            couple: Vec3::new(0.0, response.couple[0], 0.0),
        }
    }

    #[inline(always)]
    fn load(load: &Load) -> [f64; 4] {
        let [x, z, turn] = components(load.force, load.torque);
        [x, z, turn, 0.0]
    }

    #[inline(always)]
    fn kick_drift(
        place: &mut Quad,
        motion: &mut [Quad; 2],
        load: &[f64; 4],
        stride: &Stride,
        inverse_inertia: f64,
    ) -> Squares {
        let inverse_mass = motion[0].0[3];
        let mobility = f64x4::new([inverse_mass, inverse_mass, inverse_inertia, 0.0]);
        let acceleration = f64x4::new(*load) * mobility;
        let between = f64x4::new(motion[0].0) + acceleration * f64x4::splat(stride.before);
        let kick = acceleration * f64x4::splat(stride.after);
        let during = between + kick;
        motion[0] = Quad(during.to_array());
        motion[1] = with_last_of((during + kick).to_array(), &motion[1]);
        let way = f64x4::new([stride.drift, stride.drift, 0.0, 0.0]) * during;
        *place = Quad((f64x4::new(place.0) + way).to_array());
        let [x_2, z_2, spin, _] = (between * between).to_array();
        let [v_x, v_z, ..] = motion[0].0;
        Squares { speed: x_2 + z_2, spin, drift_speed: v_x * v_x + v_z * v_z }
    }

    #[inline(always)]
    fn wrap(place: &mut Quad, period: &Period) {
        place.0[0] = period.coordinate_inside(0, place.0[0]);
    }
}
