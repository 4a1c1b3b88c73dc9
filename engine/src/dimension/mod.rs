//! Discs or spheres: how grains lie in memory, and how two of them make a contact.
//!
//! A plane needs two coordinates and one spin, so it has kernels of its own, and less to read and to
//! compute. Everything here is chosen once per step and inlined below.

mod planar;
mod spatial;

use serde::{Deserialize, Serialize};

use crate::boundary::Period;
use crate::contact::{Contact, Response};
use crate::lanes::{Lanes, MOST_LANES, Vector};
use crate::math::Vec3;

pub(crate) use planar::Planar;
pub(crate) use spatial::Spatial;

/// Four numbers that are read together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(32))]
pub(crate) struct Quad(pub(crate) [f64; 4]);

impl Quad {
    pub(crate) const ZERO: Self = Self([0.0; 4]);

    /// Adds `other`, number by number.
    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        for (own, part) in self.0.iter_mut().zip(other.0) {
            *own += part;
        }
    }
}

/// The state of one grain. Between steps `velocity` and `spin` belong to the same instant as `position`;
/// inside a step they are those of the half step, and `velocity_now`, `spin_now` are extrapolated to its
/// end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// Centre (m).
    pub(crate) position: Vec3,
    /// (m/s).
    pub(crate) velocity: Vec3,
    /// (rad/s).
    pub(crate) spin: Vec3,
    /// (m/s).
    pub(crate) velocity_now: Vec3,
    /// (rad/s).
    pub(crate) spin_now: Vec3,
    /// (m).
    pub(crate) radius: f64,
    /// 1/r (1/m).
    pub(crate) inverse_radius: f64,
    /// 1/m (1/kg).
    pub(crate) inverse_mass: f64,
    /// 1/(I + m r²) (1/(kg m²)), a grain's part of the inertia of rolling.
    pub(crate) rolling_mobility: f64,
}

/// Force (N) and torque (N m) on a grain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load {
    pub(crate) force: Vec3,
    pub(crate) torque: Vec3,
}

/// What turns the answer of laws into loads on two grains.
#[derive(Clone, Copy)]
pub(crate) struct Frame<R: Lanes> {
    /// From j to i (–), world frame.
    normal: Vector<R, 3>,
    /// Where along the normal the middle of the overlap lies, from i and from j (m).
    arms: [R; 2],
    /// 1/r of the smaller grain (1/m).
    pub(crate) curvature: R,
}

/// Where a grain is and how large, apart from how it moves: the search for what touches reads only this.
/// One in each lane.
pub(crate) type Places<'a> = [&'a Quad; MOST_LANES];

/// How a grain moves, in each lane.
pub(crate) type Motions<'a> = [&'a [Quad]; MOST_LANES];

/// A kind of space, in which slips and spins have `N` components.
pub(crate) trait Dimension<const N: usize>: Send + Sync + 'static {
    /// Quads that say how a grain moves.
    const MOTION: usize;
    /// Quads of a grain's load.
    const LOAD: usize;

    /// Writes the state of a grain.
    fn pack(state: &Motion, place: &mut Quad, motion: &mut [Quad]);

    /// Reads the state of a grain.
    fn unpack(place: &Quad, motion: &[Quad]) -> Motion;

    /// Whether grains at two places overlap.
    fn touch(i: &Quad, j: &Quad, period: &Period) -> bool;

    /// The contacts of the grains `i` with `j`; `dt` (s) is the step.
    fn between<R: Lanes>(
        i: (&Places<'_>, &Motions<'_>),
        j: (&Places<'_>, &Motions<'_>),
        period: &Period,
        dt: f64,
    ) -> (Contact<R, N>, Frame<R>);

    /// Adds what the laws answer to the loads of both grains of each lane, which begin at `targets`.
    fn scatter<R: Lanes>(
        frame: &Frame<R>,
        response: &Response<R, N>,
        targets: &[[u32; 2]; MOST_LANES],
        loads: &mut [Quad],
    );

    /// The contact of a grain with a surface as laws see it here.
    fn narrow(contact: &Contact) -> Contact<f64, N>;

    /// The answer of laws to a contact with a surface, back in the world frame.
    fn widen(response: &Response<f64, N>, normal: Vec3) -> Response;

    /// Adds a load to that of a grain.
    fn add_load(load: &Load, to: &mut [Quad]);

    /// The force (N) of a load.
    fn force(load: &[Quad]) -> Vec3;

    /// Half a kick by `load`, then the drift, then the velocities extrapolated to its end. `half` is half
    /// the step (s), `inverse_inertia` 1/I (1/(kg m²)). Returns the square of the speed (m²/s²).
    fn kick_drift(
        place: &mut Quad,
        motion: &mut [Quad],
        load: &[Quad],
        half: f64,
        inverse_inertia: f64,
    ) -> f64;

    /// Half a kick. Returns the squares of speed (m²/s²) and spin (rad²/s²).
    fn kick(motion: &mut [Quad], load: &[Quad], half: f64, inverse_inertia: f64) -> [f64; 2];
}

/// The four numbers of a place, in lanes.
#[inline(always)]
fn gather_place<R: Lanes>(places: &Places<'_>) -> [R; 4] {
    R::columns(places.map(|place| &place.0))
}

/// The four numbers of one quad of how grains move, in lanes.
#[inline(always)]
fn gather<R: Lanes>(motions: &Motions<'_>, quad: usize) -> [R; 4] {
    R::columns(motions.map(|motion| &motion[quad].0))
}

/// 1/|d + s| from 1/|d|, where `change` = |d + s|²/|d|² − 1 is that of less than a step: the error is a
/// quarter of its fourth power.
#[inline(always)]
fn inverse_nearby<R: Lanes>(inverse: R, change: R) -> R {
    let [half, three, five] = [0.5, 0.375, 0.3125].map(R::splat);
    inverse * (R::one() - change * (half - change * (three - change * five)))
}
