//! Spheres in space.

use wide::f64x4;

use super::{
    Components, Dimension, Frame, Load, Motion, Motions, Places, Quad, Squares, Stride, gather,
    gather_place, inverse_nearby, with_last_of,
};
use crate::boundary::Period;
use crate::contact::{Contact, Response};
use crate::lanes::{Lanes, MOST_LANES, Vector};
use crate::math::Vec3;

/// A place is (x, r), a motion (v, 1/m), (ω, mobility), (v at the end of the step, 1/r), (ω at the end of
/// the step, 0), a load F, M.
pub(crate) struct Spatial;

fn quad(vector: Vec3, last: f64) -> Quad {
    Quad([vector.x, vector.y, vector.z, last])
}

#[inline(always)]
fn split(quad: &Quad) -> (Vec3, f64) {
    let [x, y, z, last] = quad.0;
    (Vec3::new(x, y, z), last)
}

/// The vector and the number of one quad of how grains move, in lanes.
#[inline(always)]
fn gather_split<R: Lanes>(motions: &Motions<'_, [Quad; 4]>, quad: usize) -> (Vector<R, 3>, R) {
    let [x, y, z, last] = gather(motions, quad);
    (Vector::from([x, y, z]), last)
}

impl Dimension<3> for Spatial {
    type Moves = [Quad; 4];
    type Load = [f64; 6];

    const FIRST_EVERY: usize = 1;
    const RECORD_EVERY: usize = 1;

    fn pack(state: &Motion, place: &mut Quad, motion: &mut [Quad; 4]) {
        *place = quad(state.position, state.radius);
        motion[0] = quad(state.velocity, state.inverse_mass);
        motion[1] = quad(state.spin, state.rolling_mobility);
        motion[2] = quad(state.velocity_now, state.inverse_radius);
        motion[3] = quad(state.spin_now, 0.0);
    }

    #[inline(always)]
    fn unpack(place: &Quad, motion: &[Quad; 4]) -> Motion {
        let (position, radius) = split(place);
        let (velocity, inverse_mass) = split(&motion[0]);
        let (spin, rolling_mobility) = split(&motion[1]);
        let (velocity_now, inverse_radius) = split(&motion[2]);
        let (spin_now, _) = split(&motion[3]);
        Motion {
            position,
            velocity,
            spin,
            velocity_now,
            spin_now,
            radius,
            inverse_radius,
            inverse_mass,
            rolling_mobility,
        }
    }

    #[inline(always)]
    fn position(place: &Quad) -> Vec3 {
        split(place).0
    }

    #[inline(always)]
    fn radius(place: &Quad) -> f64 {
        place.0[3]
    }

    #[inline(always)]
    fn are_near<R: Lanes>(i: &Places<'_>, j: &Places<'_>, period: &Period, margin: f64) -> R::Mask {
        let [[x_i, y_i, z_i, r_i], [x_j, y_j, z_j, r_j]] = [i, j].map(gather_place::<R>);
        let x = period.nearest(0, x_i - x_j);
        let y = period.nearest(1, y_i - y_j);
        let z = z_i - z_j;
        let reach = r_i + r_j + R::splat(margin);
        (x * x + y * y + z * z).simd_lt(reach * reach)
    }

    #[inline(always)]
    fn between<R: Lanes>(
        (place_i, i): (&Places<'_>, &Motions<'_, [Quad; 4]>),
        (place_j, j): (&Places<'_>, &Motions<'_, [Quad; 4]>),
        period: &Period,
        dt: f64,
    ) -> (Contact<R, 3>, Frame<R>) {
        let half = R::splat(0.5);
        let step = R::splat(dt);
        let [[x_i, y_i, z_i, r_i], [x_j, y_j, z_j, r_j]] =
            [place_i, place_j].map(gather_place::<R>);
        let x = period.nearest(0, x_i - x_j);
        let y = period.nearest(1, y_i - y_j);
        let apart = Vector::from([x, y, z_i - z_j]);
        let reach = r_i + r_j;
        let distance = apart.dot(&apart).simd_sqrt();
        let inverse = R::one() / distance;
        let normal = apart * inverse;
        let overlap = reach - distance;
        let arms = [half * overlap - r_i, r_j - half * overlap];

        let ((v_i, curvature_i), (v_j, curvature_j)) = (gather_split(i, 2), gather_split(j, 2));
        let ((w_i, _), (w_j, _)) = (gather_split(i, 3), gather_split(j, 3));
        let velocity = v_i - v_j + (w_i * arms[0] - w_j * arms[1]).cross(&normal);
        let along = velocity.dot(&normal);

        // The same in the middle of the step, over the way made in it.
        let ((v_i, inverse_mass_i), (v_j, inverse_mass_j)) =
            (gather_split(i, 0), gather_split(j, 0));
        let ((spin_i, mobility_i), (spin_j, mobility_j)) = (gather_split(i, 1), gather_split(j, 1));
        let (turn_i, turn_j) = (spin_i * step, spin_j * step);
        let way = (v_i - v_j) * step;
        let apart_half = apart - way * half;
        let change = apart_half.dot(&apart_half) * (inverse * inverse) - R::one();
        let inverse_half = inverse_nearby(inverse, change);
        let normal_half = apart_half * inverse_half;
        let overlap_half = reach - apart_half.dot(&normal_half);
        let arms_half = [half * overlap_half - r_i, r_j - half * overlap_half];
        let moved = way + (turn_i * arms_half[0] - turn_j * arms_half[1]).cross(&normal_half);
        let overlap_step = -moved.dot(&normal_half);
        let slip = moved + normal_half * overlap_step;
        // Turning the slip of one step changes its length by the square of the angle of half a step:
        // second order in the step, so the projection does.
        let slip_step = slip - normal * slip.dot(&normal);

        let inverse_radius_eff = curvature_i + curvature_j;
        let contact = Contact {
            normal,
            overlap,
            overlap_rate: -along,
            overlap_step,
            slip_velocity: velocity - normal * along,
            slip_step,
            relative_spin: w_i - w_j,
            relative_turn: turn_i - turn_j,
            inverse_radius_eff,
            inverse_radius_eff_before: inverse_radius_eff,
            inverse_mass_eff: inverse_mass_i + inverse_mass_j,
            rolling_mobility: mobility_i + mobility_j,
        };
        let frame = Frame { normal, arms, curvature: curvature_i.simd_max(curvature_j) };
        (contact, frame)
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    unsafe fn scatter<R: Lanes>(
        frame: &Frame<R>,
        response: &Response<R, 3>,
        targets: &[[u32; 2]; MOST_LANES],
        loads: &mut [[f64; 6]],
    ) {
        let force = frame.normal * response.normal_force + response.tangential_force;
        let twist = frame.normal.cross(&response.tangential_force);
        let on_i = twist * frame.arms[0] + response.couple;
        let on_j = -(twist * frame.arms[1]) - response.couple;
        let rows = |force: Vector<R, 3>, torque: Vector<R, 3>| {
            let first = R::rows([force[0], force[1], force[2], torque[0]]);
            (first, R::rows_of_two([torque[1], torque[2]]))
        };
        let (on_i, on_j) = (rows(force, on_i), rows(-force, on_j));
        let load = |(first, last): &([[f64; 4]; MOST_LANES], [[f64; 2]; MOST_LANES]),
                    lane: usize| {
            let ([a, b, c, d], [e, f]) = (first[lane], last[lane]);
            [a, b, c, d, e, f]
        };
        for (lane, target) in targets.iter().enumerate().take(R::COUNT) {
            let [i, j] = target.map(|target| target as usize);
            // SAFETY: the caller's.
            unsafe { loads.get_unchecked_mut(i) }.add(&load(&on_i, lane));
            // SAFETY: the caller's.
            unsafe { loads.get_unchecked_mut(j) }.add(&load(&on_j, lane));
        }
    }

    #[inline(always)]
    fn narrow(contact: &Contact) -> Contact<f64, 3> {
        *contact
    }

    #[inline(always)]
    fn widen(response: &Response<f64, 3>, _: Vec3) -> Response {
        *response
    }

    #[inline(always)]
    fn load(load: &Load) -> [f64; 6] {
        let Load { force, torque } = load;
        [force.x, force.y, force.z, torque.x, torque.y, torque.z]
    }

    #[inline(always)]
    fn kick_drift(
        place: &mut Quad,
        motion: &mut [Quad; 4],
        load: &[f64; 6],
        stride: &Stride,
        inverse_inertia: f64,
    ) -> Squares {
        let [f_x, f_y, f_z, m_x, m_y, m_z] = *load;
        let [before, after] = [stride.before, stride.after].map(f64x4::splat);
        let accelerations = [
            f64x4::new([f_x, f_y, f_z, 0.0]) * f64x4::splat(motion[0].0[3]),
            f64x4::new([m_x, m_y, m_z, 0.0]) * f64x4::splat(inverse_inertia),
        ];
        let mut squares = [[0.0; 4]; 2];
        for (kind, acceleration) in accelerations.into_iter().enumerate() {
            let between = f64x4::new(motion[kind].0) + acceleration * before;
            let kick = acceleration * after;
            let during = between + kick;
            motion[kind] = Quad(during.to_array());
            motion[kind + 2] = with_last_of((during + kick).to_array(), &motion[kind + 2]);
            squares[kind] = (between * between).to_array();
        }
        let drift = f64x4::new([stride.drift, stride.drift, stride.drift, 0.0]);
        let during = f64x4::new(motion[0].0);
        *place = Quad((f64x4::new(place.0) + drift * during).to_array());
        let sum = |[x_2, y_2, z_2, _]: [f64; 4]| x_2 + y_2 + z_2;
        Squares {
            speed: sum(squares[0]),
            spin: sum(squares[1]),
            drift_speed: sum((during * during).to_array()),
        }
    }

    #[inline(always)]
    fn wrap(place: &mut Quad, period: &Period) {
        for axis in 0..2 {
            place.0[axis] = period.coordinate_inside(axis, place.0[axis]);
        }
    }
}
