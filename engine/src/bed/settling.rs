//! Grains left to fall until they are at rest.

use serde::{Deserialize, Serialize};

use super::BedReport;
use super::rest::Scales;
use super::tapping::Tapping;
use crate::body::NoIntruder;
use crate::boundary::Container;
use crate::clock::Clock;
use crate::contacts::stage::ContactStage;
use crate::error::StepError;
use crate::grain_bed::{GrainBed, RestingBed};
use crate::grains::Grain;
use crate::math::Vec3;
use crate::space::Space;
use crate::world::{SavedWorld, World};

/// The fall is over when the mean kinetic energy of a grain (m g d) stays below this …
const FALLEN_ENERGY: f64 = 0.02;

/// … for so many fall times: longer than all grains are slow at the top of a throw.
const FALLEN_HOLD: f64 = 0.5;

/// It is over too when the highest grain could have fallen to the bottom so often and …
const FALLS: f64 = 3.0;

/// … this share of the grains touches something. Rough grains do not slide: a wide and high bed of them
/// breathes for many seconds, as its contacts hardly dampen so long a wave.
const FALLEN_LYING: f64 = 0.9;

/// Rate of the drag that calms a fallen bed, in inverse fall times: it ends the breathing of the bed
/// within a few of them, and hardly slows the grains that still roll into a hollow.
const DRAG: f64 = 1.0;

/// Steps from one braking by the drag to the next.
const BRAKE_EVERY: u64 = 10;

/// Steps between two looks at the bed.
const LOOK_EVERY: u64 = 50;

/// A bed is at rest that has stayed so, without drag, for this long (s).
const REST_HOLD: f64 = 0.02;

/// How high a tap throws a free grain, in mean grain diameters.
const TAP_HEIGHT: f64 = 0.5;

/// A bed on its way to rest: it falls under its contact laws and nothing else; what is left of its
/// motion then, a drag takes; at last it has to show that it stays at rest without.
///
/// The drag slows the velocity and the spin of every grain at one rate. It belongs to the preparation: it
/// has ended when the bed is at rest, and no impact has it.
pub struct Settling {
    world: World,
    scales: Scales,
    stage: Stage,
    /// Step once the bed has fallen (s).
    dt: f64,
    /// Time (s) in which the highest grain would fall freely through the height of all.
    longest_fall: f64,
    /// Rate (1/s) of the drag from the start on.
    drag: f64,
    /// The packing fraction that tapping is to reach, if it is wanted.
    target: f64,
    tapping: Tapping,
}

/// What a bed on its way to rest is doing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Stage {
    /// It falls, or flies after a tap; with little energy since some time (s).
    Falling { slow_since: Option<f64> },
    /// A drag calms it.
    Calming,
    /// Without drag it has kept still since some time (s).
    Proving { since: f64 },
    /// It is at rest.
    Resting,
}

impl Stage {
    fn has_fallen(self) -> bool {
        !matches!(self, Self::Falling { .. })
    }
}

impl Settling {
    /// Lets `grains`, discs or spheres as `space` says, fall under the laws `stages`; `dt` (s) is
    /// the step.
    ///
    /// # Panics
    /// If there are no grains.
    pub fn new(
        grains: &[Grain],
        (space, container): (Space, Container),
        gravity: Vec3,
        stages: Vec<Box<dyn ContactStage>>,
        dt: f64,
    ) -> Self {
        let start = RestingBed::without_history(space, grains.to_vec());
        let bed = GrainBed::new(&start, container, gravity, stages, 0);
        let scales = Scales::of(&bed);
        let longest_fall = longest_fall(&bed);
        let world = World::new(bed, Box::new(NoIntruder), dt);
        let stage = Stage::Falling { slow_since: None };
        Self {
            world,
            scales,
            stage,
            dt,
            longest_fall,
            drag: 0.0,
            target: 0.0,
            tapping: Tapping::NONE,
        }
    }

    /// Takes longer steps of `dt` (s) until the bed has fallen for the first time: collisions that are not
    /// followed closely dissipate a little more or less, but forces at rest need the finer step.
    #[must_use]
    pub fn falling_by(mut self, dt: f64) -> Self {
        self.world.change_step(dt);
        self
    }

    /// Has the grains fall and settle as in a viscous fluid: their velocities and spins decay at `rate` (1/s)
    /// until the bed has to show that it stays at rest. A bed that settles so is looser.
    #[must_use]
    pub fn dragged_by(self, rate: f64) -> Self {
        Self { drag: rate, ..self }
    }

    /// Has the bed tapped, once it is calm, until its packing fraction is within 0.005 of `target`:
    /// a tap gives every grain the upward velocity √(g d) of a throw half a mean diameter high, and lets
    /// the bed settle again. It ends after fifty taps, or when four together bring less than 0.001; a
    /// bed that is denser is left as it is. The ledger of a settling bed does not count what a tap puts
    /// in, nor what the drag takes.
    #[must_use]
    pub fn tapped_to(self, target: f64) -> Self {
        Self { target, tapping: Tapping::WANTED, ..self }
    }

    /// Moves on by one step.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.world.advance()?;
        let step = self.clock().step;
        let rate = match self.stage {
            Stage::Falling { .. } => self.drag,
            Stage::Calming => self.drag.max(DRAG / self.scales.fall_time),
            Stage::Proving { .. } | Stage::Resting => 0.0,
        };
        if rate > 0.0 && step.is_multiple_of(BRAKE_EVERY) {
            let time = BRAKE_EVERY as f64 * self.clock().dt;
            self.world.bed.slow_down(libm::exp(-rate * time));
        }
        if step.is_multiple_of(LOOK_EVERY) {
            self.look();
        }
        Ok(())
    }

    /// Goes on to the next stage once the bed is far enough.
    fn look(&mut self) {
        let time = self.clock().time();
        match self.stage {
            Stage::Falling { slow_since } => {
                // Grains that a drag holds back fall slowly too.
                let is_slow = self.scales.mean_energy(self.bed()) < FALLEN_ENERGY
                    && (self.drag <= 0.0 || self.lies());
                let since = slow_since.unwrap_or(time);
                let hold = FALLEN_HOLD * self.scales.fall_time;
                if is_slow && time - since >= hold || self.only_breathes() {
                    self.world.change_step(self.dt);
                    self.stage = Stage::Calming;
                } else {
                    self.stage = Stage::Falling { slow_since: is_slow.then_some(since) };
                }
            }
            Stage::Calming if self.is_still() => self.stage = self.tapped_or_proving(),
            Stage::Proving { .. } if !self.is_still() => self.stage = Stage::Calming,
            Stage::Proving { since } if time - since >= REST_HOLD => self.stage = Stage::Resting,
            Stage::Calming | Stage::Proving { .. } | Stage::Resting => {}
        }
    }

    /// Whether grains that have had the time to fall lie on each other, however the bed as a whole moves.
    fn only_breathes(&self) -> bool {
        self.time_since_tap() >= FALLS * self.longest_fall && self.lies()
    }

    /// Whether nearly all grains touch something.
    fn lies(&self) -> bool {
        let lying = self.bed().lying();
        let n_lying = lying.iter().filter(|one| **one).count();
        n_lying as f64 >= FALLEN_LYING * lying.len() as f64
    }

    fn is_still(&self) -> bool {
        self.restlessness() < 1.0
    }

    /// Taps a calm bed that is still too loose; else it is left to itself.
    fn tapped_or_proving(&mut self) -> Stage {
        let time = self.clock().time();
        if !self.tapping.is_over {
            let fraction = BedReport::of(self.bed()).packing_fraction;
            self.tapping.decide((fraction, self.target), time);
        }
        if self.tapping.is_over {
            return Stage::Proving { since: time };
        }
        let bed = &mut self.world.bed;
        let speed = (2.0 * TAP_HEIGHT).sqrt() * self.scales.diameter / self.scales.fall_time;
        bed.throw(bed.gravity.normalize() * -speed);
        Stage::Falling { slow_since: None }
    }

    /// Whether the bed has kept still without drag for long enough, and no tap is to follow.
    pub fn is_at_rest(&self) -> bool {
        self.stage == Stage::Resting
    }

    /// How far the bed is from rest (–): the mean kinetic energy of a grain over 10⁻⁶ m g d, or the mean
    /// unbalanced force over a thousandth of the mean contact force, whichever is more, each without
    /// the greatest hundredth. It has to stay below 1.
    pub fn restlessness(&self) -> f64 {
        self.scales.restlessness(self.bed())
    }

    /// How long (s) it has been settling since it was filled, or tapped last.
    pub fn time_since_tap(&self) -> f64 {
        self.clock().time() - self.tapping.tapped_at
    }

    /// How often it has been tapped.
    pub fn taps(&self) -> u32 {
        self.tapping.taps
    }

    /// Simulated time and steps.
    pub fn clock(&self) -> Clock {
        self.world.clock()
    }

    /// Everything that changes while it settles.
    pub fn save(&self) -> SavedSettling {
        SavedSettling { world: self.world.save(), stage: self.stage, tapping: self.tapping }
    }

    /// Takes back a saved state of the same preparation; `false`, and an unusable one, if it is of
    /// another.
    pub fn restore(&mut self, saved: SavedSettling) -> bool {
        if saved.stage.has_fallen() || saved.tapping.taps > 0 {
            self.world.change_step(self.dt);
        }
        self.stage = saved.stage;
        self.tapping = saved.tapping;
        self.world.restore(saved.world)
    }

    /// The bed as it stands.
    pub fn bed(&self) -> &GrainBed {
        self.world.bed()
    }
}

/// Time (s) in which the highest grain of `bed` falls freely to where the lowest is.
fn longest_fall(bed: &GrainBed) -> f64 {
    let heights = || bed.grains.positions().map(|centre| centre.z);
    let height = heights().fold(0.0, f64::max) - heights().fold(f64::INFINITY, f64::min);
    (2.0 * height.max(0.0) / bed.gravity.norm()).sqrt()
}

/// The state of a settling bed between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSettling {
    world: SavedWorld,
    stage: Stage,
    tapping: Tapping,
}
