//! Discs or spheres: how grains lie in memory, and how two of them make a contact.
//!
//! A plane needs two coordinates and one spin, so it has kernels of its own, and less to read and to
//! compute. Everything here is chosen once per step and inlined below.

mod planar;
mod spatial;

use serde::{Deserialize, Serialize};

use crate::boundary::Period;
use crate::contact::{Contact, Response};
use crate::lanes::{Lanes, MOST_LANES, Vector, per_lane};
use crate::math::Vec3;
use crate::prefetch::fetch;

pub(crate) use planar::Planar;
pub(crate) use spatial::Spatial;

/// Four numbers that are read together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(32))]
pub(crate) struct Quad(pub(crate) [f64; 4]);

impl Quad {
    pub(crate) const ZERO: Self = Self([0.0; 4]);
}

/// A few of them that belong to one grain.
pub(crate) trait Quads: Copy + Send + Sync {
    /// How many.
    const LEN: usize;

    /// All of them, grain by grain.
    fn each(all: &[Quad]) -> &[Self];

    /// The same, to be changed.
    fn each_mut(all: &mut [Quad]) -> &mut [Self];

    /// Has them brought near.
    fn fetch(&self);
}

impl<const LEN: usize> Quads for [Quad; LEN] {
    const LEN: usize = LEN;

    #[inline(always)]
    fn each(all: &[Quad]) -> &[Self] {
        all.as_chunks().0
    }

    #[inline(always)]
    fn each_mut(all: &mut [Quad]) -> &mut [Self] {
        all.as_chunks_mut().0
    }

    #[inline(always)]
    fn fetch(&self) {
        // A line of memory holds two.
        self.iter().step_by(2).chain(self.last()).for_each(fetch);
    }
}

/// The components of the load of one grain.
pub(crate) trait Components: Copy + Send + Sync {
    /// How many.
    const LEN: usize;

    /// Those of all grains, grain by grain.
    fn each(all: &[f64]) -> &[Self];

    /// The same, to be changed.
    fn each_mut(all: &mut [f64]) -> &mut [Self];

    /// Adds `other`, number by number.
    fn add(&mut self, other: &Self);

    /// Each of them times `factor`.
    fn times(&self, factor: f64) -> Self;
}

impl<const LEN: usize> Components for [f64; LEN] {
    const LEN: usize = LEN;

    #[inline(always)]
    fn each(all: &[f64]) -> &[Self] {
        all.as_chunks().0
    }

    #[inline(always)]
    fn each_mut(all: &mut [f64]) -> &mut [Self] {
        all.as_chunks_mut().0
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for (own, part) in self.iter_mut().zip(other) {
            *own += part;
        }
    }

    #[inline(always)]
    fn times(&self, factor: f64) -> Self {
        let mut product = *self;
        product.iter_mut().for_each(|number| *number *= factor);
        product
    }
}

/// The state of one grain in the step that has begun: its place at the end of the drift, the velocities
/// with which it gets there, and as `velocity_now`, `spin_now` the velocities extrapolated to that end. A grain
/// that has not been stepped yet has one velocity and one spin.
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

/// How a grain moves, in `M` quads, in each lane.
pub(crate) type Motions<'a, Moves> = [&'a Moves; MOST_LANES];

/// A kind of space, in which slips and spins have `N` components.
pub(crate) trait Dimension<const N: usize>: Send + Sync + 'static {
    /// How a grain moves.
    type Moves: Quads;
    /// The load of a grain.
    type Load: Components;

    /// First grains of contacts follow each other in memory: one in so many is fetched ahead of its turn.
    const FIRST_EVERY: usize;

    /// The same of records.
    const RECORD_EVERY: usize;

    /// Writes the state of a grain.
    fn pack(state: &Motion, place: &mut Quad, motion: &mut Self::Moves);

    /// Reads the state of a grain.
    fn unpack(place: &Quad, motion: &Self::Moves) -> Motion;

    /// The centre of a grain (m).
    fn position(place: &Quad) -> Vec3;

    /// The radius of a grain (m).
    fn radius(place: &Quad) -> f64;

    /// Whether the grains at the places `i` and `j` are nearer to each other than `margin` (m).
    fn are_near<R: Lanes>(i: &Places<'_>, j: &Places<'_>, period: &Period, margin: f64) -> R::Mask;

    /// The contacts of the grains `i` with `j`; `dt` (s) is the step.
    fn between<R: Lanes>(
        i: (&Places<'_>, &Motions<'_, Self::Moves>),
        j: (&Places<'_>, &Motions<'_, Self::Moves>),
        period: &Period,
        dt: f64,
    ) -> (Contact<R, N>, Frame<R>);

    /// Adds what the laws answer to the loads of both grains of each lane, those at `targets`.
    ///
    /// # Safety
    /// Every target is below the number of `loads`.
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    unsafe fn scatter<R: Lanes>(
        frame: &Frame<R>,
        response: &Response<R, N>,
        targets: &[[u32; 2]; MOST_LANES],
        loads: &mut [Self::Load],
    );

    /// The contact of a grain with a surface as laws see it here.
    fn narrow(contact: &Contact) -> Contact<f64, N>;

    /// The answer of laws to a contact with a surface, back in the world frame.
    fn widen(response: &Response<f64, N>, normal: Vec3) -> Response;

    /// The components of a load.
    fn load(load: &Load) -> Self::Load;

    /// Ends a step and begins the next: half a kick under `load`, the same again, and the drift, after
    /// which the velocities are extrapolated to its end. `inverse_inertia` is 1/I (1/(kg m²)).
    fn kick_drift(
        place: &mut Quad,
        motion: &mut Self::Moves,
        load: &Self::Load,
        stride: &Stride,
        inverse_inertia: f64,
    ) -> Squares;

    /// Brings a grain back inside that has left through a periodic side.
    fn wrap(place: &mut Quad, period: &Period);
}

/// Times (s) for which forces and velocities act between one evaluation of contacts and the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// The half of a step that ends; zero if none does.
    pub(crate) before: f64,
    /// The half of the step that begins.
    pub(crate) after: f64,
    /// The step that begins.
    pub(crate) drift: f64,
}

/// Squares of the speed (m²/s²) and of the spin (rad²/s²) of a grain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Squares {
    /// Between the steps.
    pub(crate) speed: f64,
    /// Between the steps.
    pub(crate) spin: f64,
    /// In the drift.
    pub(crate) drift_speed: f64,
}

/// `quad` with the last number of `other`.
#[inline(always)]
fn with_last_of(quad: [f64; 4], other: &Quad) -> Quad {
    let [x, y, z, _] = quad;
    Quad([x, y, z, other.0[3]])
}

/// The four numbers of a place, in lanes.
#[inline(always)]
fn gather_place<R: Lanes>(places: &Places<'_>) -> [R; 4] {
    R::columns(per_lane(|lane| &places[lane].0))
}

/// The four numbers of one quad of how grains move, in lanes.
#[inline(always)]
fn gather<R: Lanes, const M: usize>(motions: &Motions<'_, [Quad; M]>, quad: usize) -> [R; 4] {
    R::columns(per_lane(|lane| &motions[lane][quad].0))
}

/// 1/|d + s| from 1/|d|, where `change` = |d + s|²/|d|² − 1 is that of less than a step: the error is a
/// quarter of its fourth power.
#[inline(always)]
fn inverse_nearby<R: Lanes>(inverse: R, change: R) -> R {
    let [half, three, five] = [0.5, 0.375, 0.3125].map(R::splat);
    inverse * (R::one() - change * (half - change * (three - change * five)))
}
