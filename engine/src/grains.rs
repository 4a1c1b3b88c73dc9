//! The grains: flat arrays, one entry per grain.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::boundary::Period;
use crate::dimension::{Dimension, Motion, Planar, Quad, Quads, Spatial};
use crate::math::Vec3;
use crate::parallel::BLOCK;
pub use crate::space::Space;

/// One grain as a recipe or a file gives it: at rest, unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grain {
    /// Centre (m).
    pub position: Vec3,
    /// (m/s).
    pub velocity: Vec3,
    /// (rad/s).
    pub spin: Vec3,
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
    /// Its name in the log, kept when grains are reordered.
    pub id: u32,
}

impl Grain {
    /// Whether all of it is finite, also one over its inertia, and it has a size and a mass.
    pub(crate) fn is_sound(&self) -> bool {
        let Self { position, velocity, spin, radius, mass, .. } = self;
        let vectors = [position, velocity, spin];
        vectors.iter().all(|vector| vector.iter().all(|x| x.is_finite()))
            && [*radius, *mass, mass * radius * radius].iter().all(|x| x.is_normal() && *x > 0.0)
    }
}

/// All grains of a bed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grains {
    /// Discs or spheres.
    pub space: Space,
    /// Names that outlive reordering.
    pub id: Vec<u32>,
    /// (kg).
    pub mass: Vec<f64>,
    /// Moment of inertia over m r² (–).
    inertia_coefficient: f64,
    /// Where each grain is and how large, see [`Dimension`].
    places: Vec<Quad>,
    /// How each grain moves, see [`Dimension`].
    motions: Vec<Quad>,
    /// How far into the next step `places` and `motions` already are (s).
    ahead: f64,
    /// How the space that they live in repeats; it belongs to the container and is not stored.
    #[serde(skip)]
    pub(crate) period: Period,
}

/// What a block of grains does in a phase of a step.
pub(crate) struct BlockOfGrains<'a> {
    /// The number of the block.
    pub(crate) block: usize,
    /// Of its grains.
    pub(crate) places: &'a mut [Quad],
    /// Of its grains.
    pub(crate) motions: &'a mut [Quad],
    /// Of its grains (kg).
    pub(crate) mass: &'a [f64],
}

impl Grains {
    /// Grains in the given order.
    pub fn new(space: Space, list: &[Grain]) -> Self {
        let mut grains = Self {
            space,
            id: list.iter().map(|grain| grain.id).collect(),
            mass: list.iter().map(|grain| grain.mass).collect(),
            inertia_coefficient: 0.0,
            places: vec![Quad::ZERO; list.len()],
            motions: vec![Quad::ZERO; list.len() * quads(space)],
            ahead: 0.0,
            period: Period::NONE,
        };
        for (i, grain) in list.iter().enumerate() {
            grains.set_motion(
                i,
                &Motion {
                    position: grain.position,
                    velocity: grain.velocity,
                    spin: grain.spin,
                    velocity_now: grain.velocity,
                    spin_now: grain.spin,
                    radius: grain.radius,
                    inverse_radius: 1.0 / grain.radius,
                    inverse_mass: 1.0 / grain.mass,
                    rolling_mobility: 0.0,
                },
            );
        }
        grains.set_inertia(space.inertia_coefficient());
        grains
    }

    /// The radius of grain `i` (m).
    pub fn radius(&self, i: usize) -> f64 {
        match self.space {
            Space::Planar => Planar::radius(self.place(i)),
            Space::Spatial => Spatial::radius(self.place(i)),
        }
    }

    /// The radii of all grains (m).
    pub fn radii(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.len()).map(|i| self.radius(i))
    }

    /// The mean diameter of a grain (m).
    pub fn mean_diameter(&self) -> f64 {
        2.0 * self.radii().sum::<f64>() / self.len() as f64
    }

    /// The moment of inertia over m r² of every grain (–).
    pub(crate) fn inertia_coefficient(&self) -> f64 {
        self.inertia_coefficient
    }

    /// The moment of inertia of grain `i` (kg m²).
    pub fn inertia(&self, i: usize) -> f64 {
        let radius = self.radius(i);
        self.inertia_coefficient * self.mass[i] * radius * radius
    }

    /// The centre of grain `i` (m).
    pub fn position(&self, i: usize) -> Vec3 {
        let Motion { position, velocity, .. } = self.motion(i);
        match self.ahead > 0.0 {
            true => self.period.inside(position - velocity * self.ahead),
            false => position,
        }
    }

    /// The centres of all grains (m).
    pub fn positions(&self) -> impl ExactSizeIterator<Item = Vec3> + '_ {
        (0..self.len()).map(|i| self.position(i))
    }

    /// The velocity of grain `i` (m/s).
    pub fn velocity(&self, i: usize) -> Vec3 {
        let Motion { velocity, velocity_now, .. } = self.motion(i);
        velocity - (velocity_now - velocity)
    }

    /// The spin of grain `i` (rad/s).
    pub fn spin(&self, i: usize) -> Vec3 {
        let Motion { spin, spin_now, .. } = self.motion(i);
        spin - (spin_now - spin)
    }

    /// The force on grain `i` at the end of the last step, gravity included (N); zero before the first.
    pub fn force(&self, i: usize) -> Vec3 {
        if self.ahead > 0.0 {
            let Motion { velocity, velocity_now, .. } = self.motion(i);
            (velocity_now - velocity) * (2.0 * self.mass[i] / self.ahead)
        } else {
            Vec3::zeros()
        }
    }

    /// How far into the next step the grains already are (s).
    pub(crate) fn set_ahead(&mut self, ahead: f64) {
        self.ahead = ahead;
    }

    /// The centre of grain `i` at the end of the drift (m).
    #[inline]
    pub(crate) fn drifted(&self, i: usize) -> Vec3 {
        match self.space {
            Space::Planar => Planar::position(self.place(i)),
            Space::Spatial => Spatial::position(self.place(i)),
        }
    }

    /// The state of grain `i`.
    #[inline]
    pub(crate) fn motion(&self, i: usize) -> Motion {
        match self.space {
            Space::Planar => self.motion_in::<Planar, 1>(i),
            Space::Spatial => self.motion_in::<Spatial, 3>(i),
        }
    }

    /// Gives grain `i` another state.
    pub(crate) fn set_motion(&mut self, i: usize, state: &Motion) {
        let (place, motions) = (&mut self.places[i], &mut self.motions[..]);
        match self.space {
            Space::Planar => Planar::pack(state, place, &mut Quads::each_mut(motions)[i]),
            Space::Spatial => Spatial::pack(state, place, &mut Quads::each_mut(motions)[i]),
        }
    }

    /// The state of grain `i` of a space known to be `D`.
    #[inline(always)]
    pub(crate) fn motion_in<D: Dimension<N>, const N: usize>(&self, i: usize) -> Motion {
        D::unpack(self.place(i), &self.moves::<D, N>()[i])
    }

    /// Where grain `i` is and how large.
    #[inline(always)]
    pub(crate) fn place(&self, i: usize) -> &Quad {
        &self.places[i]
    }

    /// [`Self::place`] without a look at whether there is such a grain, for the loops over contacts: a
    /// seventh of their time.
    ///
    /// # Safety
    /// `i` is below [`Self::len`].
    #[inline(always)]
    #[expect(unsafe_code, reason = "measured: see docs/performance.md")]
    pub(crate) unsafe fn place_unchecked(&self, i: usize) -> &Quad {
        debug_assert!(i < self.places.len());
        // SAFETY: the caller's.
        unsafe { self.places.get_unchecked(i) }
    }

    /// How the grains of a space known to be `D` move.
    #[inline(always)]
    pub(crate) fn moves<D: Dimension<N>, const N: usize>(&self) -> &[D::Moves] {
        D::Moves::each(&self.motions)
    }

    /// From grain `j` to the nearest image of grain `i`, at the end of the drift (m).
    #[inline]
    pub(crate) fn apart(&self, i: usize, j: usize) -> Vec3 {
        self.period.shortest(self.drifted(i) - self.drifted(j))
    }

    /// Gives every grain the moment of inertia `coefficient` m r².
    pub(crate) fn set_inertia(&mut self, coefficient: f64) {
        self.inertia_coefficient = coefficient;
        for i in 0..self.len() {
            let (mass, radius) = (self.mass[i], self.radius(i));
            let rolling_mobility = 1.0 / (self.inertia(i) + mass * radius * radius);
            self.set_motion(i, &Motion { rolling_mobility, ..self.motion(i) });
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Whether all arrays hold `n` finite entries, for grains that were read from a file.
    pub(crate) fn is_consistent(&self, n: usize) -> bool {
        let finite = |quads: &[Quad]| quads.iter().all(|quad| quad.0.iter().all(|x| x.is_finite()));
        self.id.len() == n
            && self.mass.len() == n
            && self.mass.iter().all(|mass| mass.is_finite())
            && self.inertia_coefficient.is_finite()
            && self.places.len() == n
            && self.motions.len() == n * quads(self.space)
            && finite(&self.places)
            && finite(&self.motions)
            && self.ahead.is_finite()
    }

    /// The grains one by one.
    pub fn iter(&self) -> impl Iterator<Item = Grain> + '_ {
        (0..self.len()).map(|i| Grain {
            position: self.position(i),
            velocity: self.velocity(i),
            spin: self.spin(i),
            radius: self.radius(i),
            mass: self.mass[i],
            id: self.id[i],
        })
    }

    /// Adds `velocity` (m/s) to that of every grain.
    pub(crate) fn throw(&mut self, velocity: Vec3) {
        for i in 0..self.len() {
            self.push(i, velocity, Vec3::zeros());
        }
        self.wrap();
    }

    /// Leaves every grain the share `left` (–) of its velocity and of its spin.
    pub(crate) fn slow_down(&mut self, left: f64) {
        for i in 0..self.len() {
            self.push(i, self.velocity(i) * (left - 1.0), self.spin(i) * (left - 1.0));
        }
        self.wrap();
    }

    /// Adds `velocity` (m/s) and `spin` (rad/s) to those of grain `i`, between two steps.
    fn push(&mut self, i: usize, velocity: Vec3, spin: Vec3) {
        let motion = self.motion(i);
        let pushed = Motion {
            position: motion.position + velocity * self.ahead,
            velocity: motion.velocity + velocity,
            velocity_now: motion.velocity_now + velocity,
            spin: motion.spin + spin,
            spin_now: motion.spin_now + spin,
            ..motion
        };
        self.set_motion(i, &pushed);
    }

    /// Begins the next step anew, with one of `dt` (s).
    pub(crate) fn change_step(&mut self, dt: f64) {
        for i in 0..self.len() {
            let motion = self.motion(i);
            let ratio = dt / self.ahead;
            let kick = (motion.velocity_now - motion.velocity) * ratio;
            let turn = (motion.spin_now - motion.spin) * ratio;
            let velocity = self.velocity(i) + kick;
            let spin = self.spin(i) + turn;
            let changed = Motion {
                position: self.position(i) + velocity * dt,
                velocity,
                velocity_now: velocity + kick,
                spin,
                spin_now: spin + turn,
                ..motion
            };
            self.set_motion(i, &changed);
        }
        self.ahead = dt;
        self.wrap();
    }

    /// The greatest speed of a grain of each block in the drift that has begun (m/s).
    pub(crate) fn fastest_by_block(&self) -> Vec<f64> {
        let speed = |i: usize| self.motion(i).velocity.norm();
        let first = (0..self.len()).step_by(BLOCK);
        first.map(|i| (i..(i + BLOCK).min(self.len())).map(speed).fold(0.0, f64::max)).collect()
    }

    /// Brings back inside, on the other side, what has left through a periodic one.
    pub(crate) fn wrap(&mut self) {
        if self.period.is_none() {
            return;
        }
        for i in 0..self.len() {
            let motion = self.motion(i);
            let inside = self.period.inside(motion.position);
            if inside != motion.position {
                self.set_motion(i, &Motion { position: inside, ..motion });
            }
        }
    }

    /// Calls `work` on every block of grains, in parallel.
    pub(crate) fn par_blocks<D: Dimension<N>, const N: usize>(
        &mut self,
    ) -> impl IndexedParallelIterator<Item = BlockOfGrains<'_>> {
        (
            self.places.par_chunks_mut(BLOCK),
            self.motions.par_chunks_mut(BLOCK * D::Moves::LEN),
            self.mass.par_chunks(BLOCK),
        )
            .into_par_iter()
            .enumerate()
            .map(|(block, (places, motions, mass))| BlockOfGrains {
                block,
                places,
                motions,
                mass,
            })
    }
}

/// How many quads say how a grain moves.
fn quads(space: Space) -> usize {
    match space {
        Space::Planar => <Planar as Dimension<1>>::Moves::LEN,
        Space::Spatial => <Spatial as Dimension<3>>::Moves::LEN,
    }
}
