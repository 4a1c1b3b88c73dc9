//! The pass over the grains in which one step ends and the next begins.

use crate::boundary::{Absorber, Period};
use crate::contacts::Loads;
use crate::dimension::{Components, Dimension, Load, Motion, Quads, Stride};
use crate::grain_force::{self, ForceOnGrain, GrainForces, MovingGrain, TakenByForces};
use crate::grains::BlockOfGrains;
use crate::math::Vec3;

/// A grain moves when its energy would lift it by this share of its diameter.
const MOVING_LIFT: f64 = 0.01;

/// What the grains of a block add up to: energies (J), and how they move.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SumsOfGrains {
    pub(crate) translation: f64,
    pub(crate) rotation: f64,
    pub(crate) potential: f64,
    /// What absorbing layers took in the last step.
    pub(crate) absorbed: f64,
    /// What forces on single grains took in the last step.
    pub(crate) taken: TakenByForces,
    /// How many of them move, see [`crate::grain_bed::GrainBed::moving_share`].
    pub(crate) moving: u32,
    /// Square of the greatest speed in the drift that follows (m²/s²).
    pub(crate) fastest_2: f64,
}

/// What acts on the grains besides contacts, and for how long.
pub(crate) struct GrainPass<'a> {
    /// (m/s²).
    pub(crate) gravity: Vec3,
    pub(crate) period: Period,
    pub(crate) absorber: Option<&'a Absorber>,
    pub(crate) forces: &'a GrainForces,
    /// Moment of inertia of a grain over m r² (–).
    pub(crate) inertia_coefficient: f64,
    pub(crate) stride: Stride,
}

/// What acts on a grain besides contacts and gravity.
struct Besides {
    load: Load,
    /// Mass of a fluid that moves with it (kg).
    added_mass: f64,
}

impl GrainPass<'_> {
    /// Completes the force on each grain with what acts besides contacts, gives it half a kick for the step
    /// that ends, takes its energy, and sends it half a kick and a drift into the next.
    pub(crate) fn over<D: Dimension<N>, const N: usize>(
        &self,
        block: BlockOfGrains<'_>,
        loads: Loads<'_>,
    ) -> SumsOfGrains {
        match self.absorber.is_none() && self.forces.is_empty() {
            true => self.with::<D, N>(block, loads, |_, _, _| None),
            false => self.with::<D, N>(block, loads, |grain, mass, sums| {
                Some(self.besides(grain, mass, sums))
            }),
        }
    }

    #[inline(always)]
    fn with<D: Dimension<N>, const N: usize>(
        &self,
        block: BlockOfGrains<'_>,
        mut loads: Loads<'_>,
        besides: impl Fn(&Motion, f64, &mut SumsOfGrains) -> Option<Besides>,
    ) -> SumsOfGrains {
        let mut sums = SumsOfGrains::default();
        let pull = D::load(&Load { force: self.gravity, torque: Vec3::zeros() });
        let lift = 4.0 * MOVING_LIFT * self.gravity.norm();
        let moved = block.places.iter_mut().zip(D::Moves::each_mut(block.motions));
        let coefficient = self.inertia_coefficient;
        // 1/I over 1/(I + m r²): dividing for each grain would cost a fourth of this pass.
        let over_mobility = (1.0 + coefficient) / coefficient;
        for (k, ((place, motion), &mass)) in moved.zip(block.mass).enumerate() {
            let grain = D::unpack(place, motion);
            let mut load = loads.of::<D, N>(k);
            load.add(&pull.times(mass));
            let mut inverse_inertia = over_mobility * grain.rolling_mobility;
            let mut moving_mass = mass;
            if let Some(besides) = besides(&grain, mass, &mut sums) {
                load.add(&D::load(&besides.load));
                moving_mass += besides.added_mass;
                // A kick is a force over the mass of the grain alone; a fluid does not turn with it.
                load = load.times(mass / moving_mass);
                inverse_inertia *= moving_mass / mass;
            }
            let squares = D::kick_drift(place, motion, &load, &self.stride, inverse_inertia);
            D::wrap(place, &self.period);
            // Twice the energy over the mass.
            let rotation = coefficient * (grain.radius * grain.radius) * squares.spin;
            sums.moving += u32::from(squares.speed + rotation > lift * grain.radius);
            sums.translation += moving_mass * squares.speed;
            sums.rotation += mass * rotation;
            sums.potential -= mass * self.gravity.dot(&grain.position);
            sums.fastest_2 = sums.fastest_2.max(squares.drift_speed);
        }
        sums.translation *= 0.5;
        sums.rotation *= 0.5;
        sums
    }

    /// What absorbing layers and forces on single grains do to one of `mass` (kg); what they took in the
    /// step that ends, and what a fluid bears, goes to `sums`.
    fn besides(&self, grain: &Motion, mass: f64, sums: &mut SumsOfGrains) -> Besides {
        let Motion { position, velocity, velocity_now, .. } = *grain;
        let step = 2.0 * self.stride.before;
        let mut load = Load { force: Vec3::zeros(), torque: Vec3::zeros() };
        if let Some(absorber) = self.absorber {
            load.force -= velocity_now * (mass * absorber.rate(position));
            // Second order: what acts half-way, over the way of the step.
            let half_way = absorber.rate(position - velocity * self.stride.before);
            sums.absorbed += mass * half_way * velocity.norm_squared() * step;
        }
        let weight = self.gravity.norm() * mass;
        for (force, taken) in self.forces.iter().zip(&mut sums.taken) {
            let moving = MovingGrain::half_way(grain, mass, weight);
            *taken -= force.on(&moving).power(&moving) * step;
            let ForceOnGrain { force, torque } = force.on(&moving.now(grain));
            load.force += force;
            load.torque += torque;
        }
        let fluid = grain_force::surrounding(self.forces, grain.radius);
        load.force -= self.gravity * fluid.displaced_mass;
        sums.potential += fluid.displaced_mass * self.gravity.dot(&position);
        Besides { load, added_mass: fluid.added_mass }
    }
}
