//! One impact: the outer loop and its end.

use serde::{Deserialize, Serialize};

use crate::activity::Activity;
use crate::body::{Mechanism, RigidBody};
use crate::clock::{Clock, steps_in};
use crate::course::Course;
use crate::error::StepError;
use crate::grain_bed::GrainBed;
use crate::ledger::Ledger;
use crate::world::{SavedWorld, World};

/// What a run is told besides the bed and the intruder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of a step (s).
    pub dt: f64,
    /// The run ends here at the latest (s).
    pub duration: f64,
    /// Closure above which the run is given up.
    pub abort_above: f64,
}

/// An intruder in a bed.
pub struct Simulation {
    world: World,
    settings: Settings,
    courses: Vec<Course>,
    activity: Activity,
    surface: f64,
    impact_energy: f64,
    energy_scale: f64,
}

/// The state of a run between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    world: SavedWorld,
    courses: Vec<Course>,
    activity: Activity,
    surface: f64,
    impact_energy: f64,
}

impl Snapshot {
    /// Steps done.
    pub fn step(&self) -> u64 {
        self.world.clock.step
    }
}

impl Simulation {
    /// An impact of `intruder`, launched already, on `bed`.
    ///
    /// # Panics
    /// If the intruder has no body.
    pub fn new(bed: GrainBed, intruder: Box<dyn Mechanism>, settings: Settings) -> Self {
        let world = World::new(bed, intruder, settings.dt);
        let bodies = world.intruder.bodies();
        let body = bodies.first().expect("an impact has an intruder");
        let courses = (0..bodies.len()).map(|index| Course::new(&*world.intruder, index)).collect();
        let surface = bodies.iter().map(RigidBody::lowest).fold(f64::INFINITY, f64::min);
        let impact_energy = bodies.iter().flat_map(|body| body.kinetic_energy()).sum::<f64>();
        // An intruder let go from rest has no energy of impact to compare with.
        let mass: f64 = bodies.iter().map(|body| body.mass).sum();
        let fall = mass * world.bed.gravity.norm() * 2.0 * body.reach_down();
        let energy_scale = if impact_energy > 0.0 { impact_energy } else { fall };
        let activity = Activity::default();
        Self { world, settings, courses, activity, surface, impact_energy, energy_scale }
    }

    /// The same impact with the ledger left as it is at the start: to measure what it costs.
    #[must_use]
    pub fn without_ledger(mut self) -> Self {
        self.world.bed.book_nothing();
        self.world.books.shut();
        self
    }

    /// Moves on by one step.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.world.advance()?;
        let (clock, intruder) = (self.world.clock, &*self.world.intruder);
        for (index, course) in self.courses.iter_mut().enumerate() {
            course.observe((clock.time(), clock.dt), intruder, index);
        }
        let bed = &self.world.bed;
        self.activity.observe(clock.time(), bed.moving_share(), bed.kinetic_energy());
        self.check_budget()
    }

    /// Whether every body of the intruder has stopped, or time is up.
    pub fn is_over(&self) -> bool {
        self.courses.iter().all(Course::is_over) || self.world.clock.step >= self.last_step()
    }

    /// The step at which the run ends at the latest.
    pub fn last_step(&self) -> u64 {
        steps_in(self.settings.duration, self.settings.dt)
    }

    fn check_budget(&self) -> Result<(), StepError> {
        let closure = self.closure();
        if closure <= self.settings.abort_above {
            return Ok(());
        }
        let (overlap, grain) = self.world.bed.largest_overlap();
        Err(StepError::OpenBudget {
            step: self.world.clock.step,
            unaccounted: self.world.books.ledger.balance().unaccounted,
            scale: self.energy_scale(),
            closure,
            limit: self.settings.abort_above,
            suggested_dt: 0.5 * self.settings.dt,
            overlap,
            grain,
        })
    }

    /// The bed.
    pub fn bed(&self) -> &GrainBed {
        &self.world.bed
    }

    /// The intruder.
    pub fn intruder(&self) -> &dyn Mechanism {
        &*self.world.intruder
    }

    /// The energy ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.world.books.ledger
    }

    /// Largest |energy unaccounted for| so far over the initial energy of the intruder; over what it
    /// gains in falling its own size, if it is let go from rest.
    pub fn closure(&self) -> f64 {
        self.world.books.ledger.closure(self.energy_scale())
    }

    /// What the closure is counted in (J): the energy of the impact, or, of an intruder on a drive, that and what
    /// it has given to the bed.
    fn energy_scale(&self) -> f64 {
        match self.world.intruder.drive_work() {
            Some(_) => {
                self.energy_scale + self.courses.iter().map(Course::given).sum::<f64>().abs()
            }
            None => self.energy_scale,
        }
    }

    /// Kinetic energy of the intruder at the start (J).
    pub fn impact_energy(&self) -> f64 {
        self.impact_energy
    }

    /// Simulated time and steps.
    pub fn clock(&self) -> Clock {
        self.world.clock
    }

    /// Stopping times, depth and energy given to the bed of each body of the intruder.
    pub fn courses(&self) -> &[Course] {
        &self.courses
    }

    /// How much of the bed took part.
    pub fn activity(&self) -> &Activity {
        &self.activity
    }

    /// Height (m) of the lowest point of the intruder at the start, from which depths count.
    pub fn surface(&self) -> f64 {
        self.surface
    }

    /// Everything that changes during the run.
    pub fn save(&self) -> Snapshot {
        Snapshot {
            world: self.world.save(),
            courses: self.courses.clone(),
            activity: self.activity,
            surface: self.surface,
            impact_energy: self.impact_energy,
        }
    }

    /// Takes back a saved state of the same run; `false`, and an unusable simulation, if it is of
    /// another one.
    pub fn restore(&mut self, saved: Snapshot) -> bool {
        let is_of_this_run = saved.courses.len() == self.courses.len();
        self.courses = saved.courses;
        self.activity = saved.activity;
        self.surface = saved.surface;
        self.impact_energy = saved.impact_energy;
        is_of_this_run && self.world.restore(saved.world)
    }
}
