//! Forces on single grains: of the air between them, of plates beside them. Not of contacts.
//!
//! Such a force opposes the motion of a grain, so it has one account, of energy that is lost. It is asked
//! for once per block and step, when the forces of contacts have been gathered.

use arrayvec::ArrayVec;

use crate::dimension::{Dimension, Load, Motion};
use crate::grains::BlockOfGrains;
use crate::ledger::{ChannelKind, Term, TermKind};
use crate::math::Vec3;

/// A bed has this many forces on its grains at most.
pub const MOST_FORCES: usize = 4;

/// A force on every grain by itself.
///
/// Implementations are pure: nothing is remembered from grain to grain or step to step.
pub trait GrainForce: Send + Sync {
    /// kebab-case; the ledger has a dissipated channel of this name.
    fn name(&self) -> &'static str;

    /// What acts on a grain that moves as `grain` says.
    fn on(&self, grain: &MovingGrain) -> ForceOnGrain;

    /// The shortest time (s) in which it can brake a grain, under gravity of the given magnitude (m/s²);
    /// infinite where it does not act. A step has to be well below it.
    fn relaxation_time(&self, gravity: f64) -> f64;
}

/// One grain, as far as a force on it may depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingGrain {
    /// (m/s).
    pub velocity: Vec3,
    /// (rad/s).
    pub spin: Vec3,
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
    /// Its weight (N).
    pub weight: f64,
}

/// A force on a grain, and its torque about the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceOnGrain {
    /// (N).
    pub force: Vec3,
    /// (N m).
    pub torque: Vec3,
}

impl ForceOnGrain {
    /// Work done on a grain per time (W), negative where it is braked.
    #[must_use]
    pub fn power(&self, grain: &MovingGrain) -> f64 {
        self.force.dot(&grain.velocity) + self.torque.dot(&grain.spin)
    }
}

/// The forces on the grains of a bed.
pub(crate) type GrainForces = ArrayVec<Box<dyn GrainForce>, MOST_FORCES>;

/// What each force took from the grains of a block in the last step (J).
pub(crate) type TakenByForces = [f64; MOST_FORCES];

/// The accounts of `forces`, in their order.
pub(crate) fn terms(forces: &GrainForces) -> impl Iterator<Item = Term> + '_ {
    forces.iter().map(|force| Term {
        name: force.name().into(),
        kind: TermKind::Channel(ChannelKind::Dissipated),
    })
}

/// Adds what `forces` do to the grains of `block` to their loads; says what each takes in the step of `dt`
/// (s), under gravity of the given magnitude (m/s²).
///
/// As everything that dissipates, the force is that of the velocity at the end of the step; what it takes
/// is that of the velocity half-way, over the way of the step, which is second order.
pub(crate) fn act<D: Dimension<N>, const N: usize>(
    forces: &GrainForces,
    block: &mut BlockOfGrains<'_>,
    (gravity, dt): (f64, f64),
) -> TakenByForces {
    let mut taken = TakenByForces::default();
    for (force, taken) in forces.iter().zip(&mut taken) {
        let moved = block.places.iter().zip(block.motions.chunks_exact(D::MOTION));
        let loads = block.loads.chunks_exact_mut(D::LOAD);
        for ((&mass, (place, motion)), load) in block.mass.iter().zip(moved).zip(loads) {
            let Motion { velocity, spin, velocity_now, spin_now, radius, .. } =
                D::unpack(place, motion);
            let weight = mass * gravity;
            let half_way = MovingGrain { velocity, spin, radius, mass, weight };
            *taken -= force.on(&half_way).power(&half_way) * dt;
            let now = MovingGrain { velocity: velocity_now, spin: spin_now, ..half_way };
            let ForceOnGrain { force, torque } = force.on(&now);
            D::add_load(&Load { force, torque }, load);
        }
    }
    taken
}
