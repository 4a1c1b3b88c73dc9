//! Grains left to fall until they are at rest.

use serde::{Deserialize, Serialize};

use crate::body::NoIntruder;
use crate::boundary::Container;
use crate::clock::Clock;
use crate::contact::ContactStage;
use crate::error::StepError;
use crate::grain_bed::{GrainBed, RestingBed};
use crate::grains::{Grain, Space};
use crate::math::Vec3;
use crate::world::{SavedWorld, World};

/// A bed is at rest when the mean kinetic energy of a grain stays below this many m g d …
const REST_ENERGY: f64 = 1e-6;

/// … for this long (s).
const REST_HOLD: f64 = 0.02;

/// A bed on its way to rest.
pub struct Settling {
    world: World,
    quiet_since: Option<f64>,
    quiet_energy: f64,
}

impl Settling {
    /// Lets `grains`, discs or spheres as `space` says, fall under the laws `stages`; `dt` (s) is
    /// the step.
    ///
    /// # Panics
    /// If there are no grains.
    #[must_use]
    pub fn new(
        grains: &[Grain],
        (space, container): (Space, Container),
        gravity: Vec3,
        stages: Vec<Box<dyn ContactStage>>,
        dt: f64,
    ) -> Self {
        let start = RestingBed::without_history(space, grains);
        let bed = GrainBed::new(&start, container, gravity, stages, 0);
        let n = grains.len() as f64;
        let mean_mass = grains.iter().map(|grain| grain.mass).sum::<f64>() / n;
        let mean_diameter = 2.0 * grains.iter().map(|grain| grain.radius).sum::<f64>() / n;
        let quiet_energy = REST_ENERGY * mean_mass * gravity.norm() * mean_diameter;
        let world = World::new(bed, Box::new(NoIntruder), dt);
        Self { world, quiet_since: None, quiet_energy }
    }

    /// Moves on by one step.
    ///
    /// # Errors
    /// If the step cannot be trusted.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.world.advance()?;
        if self.restlessness() >= 1.0 {
            self.quiet_since = None;
        } else if self.quiet_since.is_none() {
            self.quiet_since = Some(self.clock().time());
        }
        Ok(())
    }

    /// Whether the bed has kept quiet for long enough.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.quiet_since.is_some_and(|since| self.clock().time() - since >= REST_HOLD)
    }

    /// Mean kinetic energy of a grain over the one that counts as rest.
    #[must_use]
    pub fn restlessness(&self) -> f64 {
        self.bed().mean_kinetic_energy() / self.quiet_energy
    }

    /// Simulated time and steps.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.world.clock()
    }

    /// Everything that changes while it settles.
    #[must_use]
    pub fn save(&self) -> SavedSettling {
        SavedSettling { world: self.world.save(), quiet_since: self.quiet_since }
    }

    /// Takes back a saved state of the same preparation; `false`, and an unusable one, if it is of
    /// another.
    #[must_use]
    pub fn restore(&mut self, saved: SavedSettling) -> bool {
        self.quiet_since = saved.quiet_since;
        self.world.restore(saved.world)
    }

    /// The bed as it stands.
    #[must_use]
    pub fn bed(&self) -> &GrainBed {
        self.world.bed()
    }
}

/// The state of a settling bed between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSettling {
    world: SavedWorld,
    quiet_since: Option<f64>,
}
