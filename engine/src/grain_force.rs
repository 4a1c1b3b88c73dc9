//! Forces on single grains: of the air or the liquid between them, of plates beside them. Not of contacts.
//!
//! Such a force opposes the motion of a grain, so it has one account, of energy that is lost; a fluid also bears a part of
//! its weight and moves with it. It is asked for once per step, when the forces of contacts have been added up.

use arrayvec::ArrayVec;

use crate::body::Mechanism;
use crate::dimension::Motion;
use crate::ledger::{ChannelKind, Term, TermKind};
use crate::math::Vec3;
use crate::surface::{Placement, Wrench};

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

    /// The shortest time (s) in which it can brake `grain` where that moves as fast as it says or slower; infinite
    /// where it does not act. A step has to be well below it.
    fn relaxation_time(&self, grain: &MovingGrain) -> f64;

    /// The fluid around a sphere of `radius` (m), of a force that is one of a fluid.
    fn surrounding(&self, _radius: f64) -> Surrounding {
        Surrounding::default()
    }

    /// The force (N) on a part of the intruder that moves as `part` says, of a force that does not act on grains alone.
    fn on_intruder(&self, _part: &MovingGrain) -> Option<Vec3> {
        None
    }
}

/// The fluid that a sphere has to do with, at rest or not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surrounding {
    /// What it displaces (kg): its weight bears the sphere.
    pub displaced_mass: f64,
    /// What moves with it (kg).
    pub added_mass: f64,
}

/// One grain, or a part of the intruder as the sphere of its volume, as far as a force on it may depend on it.
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
    pub fn power(&self, grain: &MovingGrain) -> f64 {
        self.force.dot(&grain.velocity) + self.torque.dot(&grain.spin)
    }
}

/// The forces on the grains of a bed.
pub(crate) type GrainForces = ArrayVec<Box<dyn GrainForce>, MOST_FORCES>;

/// What each force took from the grains of a block in the last step (J).
pub(crate) type TakenByForces = [f64; MOST_FORCES];

/// The fluids of all `forces` around a sphere of `radius` (m).
pub(crate) fn surrounding(forces: &GrainForces, radius: f64) -> Surrounding {
    forces.iter().map(|force| force.surrounding(radius)).fold(Surrounding::default(), |sum, one| {
        Surrounding {
            displaced_mass: sum.displaced_mass + one.displaced_mass,
            added_mass: sum.added_mass + one.added_mass,
        }
    })
}

/// Radius (m) of the sphere of `volume` (m³).
pub(crate) fn sphere_radius(volume: f64) -> f64 {
    libm::cbrt(volume * 0.75 / std::f64::consts::PI)
}

/// Adds what the fluids among `forces` do to each part of the intruder to the load of the bed on it, `wrenches`; what
/// each force took in the step of `dt` (s) that ends (J).
pub(crate) fn immerse(
    intruder: &dyn Mechanism,
    wrenches: &mut [Wrench],
    forces: &GrainForces,
    gravity: Vec3,
    dt: f64,
) -> TakenByForces {
    let mut taken = TakenByForces::default();
    let parts = intruder.parts().iter().zip(intruder.bodies()).zip(wrenches);
    for ((part, body), wrench) in parts.filter(|((_, body), _)| body.volume > 0.0) {
        let Placement { velocity, spin, velocity_now, spin_now, .. } = part.placement;
        let (radius, mass) = (sphere_radius(body.volume), body.mass);
        let moving = MovingGrain { velocity, spin, radius, mass, weight: mass * gravity.norm() };
        let now = MovingGrain { velocity: velocity_now, spin: spin_now, ..moving };
        for (force, taken) in forces.iter().zip(&mut taken) {
            *taken -= force.on_intruder(&moving).map_or(0.0, |drag| drag.dot(&velocity)) * dt;
            wrench.force += force.on_intruder(&now).unwrap_or_default();
        }
        wrench.force -= gravity * surrounding(forces, radius).displaced_mass;
    }
    taken
}

/// The accounts of `forces`, in their order.
pub(crate) fn terms(forces: &GrainForces) -> impl Iterator<Item = Term> + '_ {
    forces.iter().map(|force| Term {
        name: force.name().into(),
        kind: TermKind::Channel(ChannelKind::Dissipated),
    })
}
