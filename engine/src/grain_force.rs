//! Forces on single grains: of the air between them, of plates beside them. Not of contacts.
//!
//! Such a force opposes the motion of a grain, so it has one account, of energy that is lost. It is asked
//! for once per step, when the forces of contacts have been added up.

use arrayvec::ArrayVec;

use crate::dimension::Motion;
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

impl MovingGrain {
    /// A grain half-way through the step that ends: with the velocity of that time what a force takes is that
    /// velocity's force over the way of the step, which is second order.
    pub(crate) fn half_way(grain: &Motion, mass: f64, weight: f64) -> Self {
        let Motion { velocity, spin, radius, .. } = *grain;
        Self { velocity, spin, radius, mass, weight }
    }

    /// The same grain at the end of the step, the velocity of which all dissipative forces take.
    pub(crate) fn now(&self, grain: &Motion) -> Self {
        Self { velocity: grain.velocity_now, spin: grain.spin_now, ..*self }
    }
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
