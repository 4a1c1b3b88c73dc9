//! Grains left to fall until they are at rest.

use serde::{Deserialize, Serialize};

use super::BedReport;
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

/// A packing fraction this near below its target is reached.
const NEAR_TARGET: f64 = 0.005;

/// A tap that brings less than this in packing fraction is the last.
const LEAST_GAIN: f64 = 0.0005;

/// A bed is tapped this often at most.
const MOST_TAPS: u32 = 50;

/// How high a tap throws a free grain, in mean grain diameters.
const TAP_HEIGHT: f64 = 0.5;

/// A bed on its way to rest.
pub struct Settling {
    world: World,
    quiet_since: Option<f64>,
    quiet_energy: f64,
    /// The packing fraction that tapping is to reach, if it is wanted.
    target: Option<f64>,
    tapping: Tapping,
}

/// How far the tapping has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Tapping {
    taps: u32,
    /// Packing fraction at rest before the last tap.
    before: f64,
    /// When the last tap was (s).
    tapped_at: f64,
    is_over: bool,
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
        let tapping = Tapping { is_over: true, ..Tapping::default() };
        Self { world, quiet_since: None, quiet_energy, target: None, tapping }
    }

    /// Has the bed tapped, once it is at rest, until its packing fraction is within 0.005 of `target`:
    /// a tap gives every grain the upward velocity √(g d) of a throw half a mean diameter high, and lets
    /// the bed settle again. It ends after fifty taps, or when one brings less than 0.0005; a bed that is
    /// denser is left as it is. The ledger of a settling bed does not count what a tap puts in.
    #[must_use]
    pub fn tapped_to(self, target: f64) -> Self {
        Self { target: Some(target), tapping: Tapping::default(), ..self }
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
        if self.is_quiet() && !self.tapping.is_over {
            self.tap_if_wanted();
        }
        Ok(())
    }

    /// Ends the tapping where it has done what it can, or taps.
    fn tap_if_wanted(&mut self) {
        let fraction = BedReport::of(self.bed()).packing_fraction;
        let Tapping { taps, before, .. } = self.tapping;
        let is_near = self.target.is_none_or(|target| target - fraction <= NEAR_TARGET);
        let is_tired = taps > 0 && fraction - before < LEAST_GAIN;
        if is_near || is_tired || taps >= MOST_TAPS {
            self.tapping.is_over = true;
            return;
        }
        let bed = &self.world.bed;
        let mean_diameter = 2.0 * bed.grains.radius.iter().sum::<f64>() / bed.grains.len() as f64;
        let weight = bed.gravity.norm();
        let upward = bed.gravity * -(2.0 * TAP_HEIGHT * mean_diameter / weight).sqrt();
        self.world.bed.grains.throw(upward);
        let tapped_at = self.clock().time();
        self.tapping = Tapping { taps: taps + 1, before: fraction, tapped_at, is_over: false };
        self.quiet_since = None;
    }

    /// Whether the bed has kept quiet for long enough, and no tap is to follow.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.is_quiet() && self.tapping.is_over
    }

    fn is_quiet(&self) -> bool {
        self.quiet_since.is_some_and(|since| self.clock().time() - since >= REST_HOLD)
    }

    /// Mean kinetic energy of a grain over the one that counts as rest.
    #[must_use]
    pub fn restlessness(&self) -> f64 {
        self.bed().mean_kinetic_energy() / self.quiet_energy
    }

    /// How long (s) it has been settling since it was filled, or tapped last.
    #[must_use]
    pub fn time_since_tap(&self) -> f64 {
        self.clock().time() - self.tapping.tapped_at
    }

    /// How often it has been tapped.
    #[must_use]
    pub fn taps(&self) -> u32 {
        self.tapping.taps
    }

    /// Simulated time and steps.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.world.clock()
    }

    /// Everything that changes while it settles.
    #[must_use]
    pub fn save(&self) -> SavedSettling {
        SavedSettling {
            world: self.world.save(),
            quiet_since: self.quiet_since,
            tapping: self.tapping,
        }
    }

    /// Takes back a saved state of the same preparation; `false`, and an unusable one, if it is of
    /// another.
    #[must_use]
    pub fn restore(&mut self, saved: SavedSettling) -> bool {
        self.quiet_since = saved.quiet_since;
        self.tapping = saved.tapping;
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
    tapping: Tapping,
}
