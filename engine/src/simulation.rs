//! One impact: the outer loop and its end.

use serde::{Deserialize, Serialize};

use crate::body::Mechanism;
use crate::clock::Clock;
use crate::error::StepError;
use crate::grain_bed::{GrainBed, SavedBed};
use crate::ledger::{Balance, Ledger};
use crate::step::{Books, prime, step};
use crate::stopping::Stopping;

/// What a run is told besides the bed and the intruder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Length of a step [s].
    pub dt: f64,
    /// The run ends here at the latest [s].
    pub duration: f64,
    /// Closure above which the run is given up.
    pub abort_above: f64,
}

/// An intruder in a bed.
pub struct Simulation {
    bed: GrainBed,
    intruder: Box<dyn Mechanism>,
    books: Books,
    clock: Clock,
    settings: Settings,
    stopping: Stopping,
    surface: f64,
    impact_energy: f64,
}

/// The state of a run between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    clock: Clock,
    bed: SavedBed,
    intruder: Vec<f64>,
    balance: Balance,
    stopping: Stopping,
    surface: f64,
    impact_energy: f64,
}

impl Snapshot {
    /// Steps done.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.clock.step
    }
}

impl Simulation {
    /// An impact of `intruder`, launched already, on `bed`.
    ///
    /// # Panics
    /// If the intruder has no body.
    #[must_use]
    pub fn new(mut bed: GrainBed, mut intruder: Box<dyn Mechanism>, settings: Settings) -> Self {
        let mut books = Books::new(Ledger::new(bed.terms()));
        prime(&mut bed, &mut *intruder, &mut books);
        let body = intruder.bodies().first().expect("an impact has an intruder");
        let stopping = Stopping::new(body.position, body.velocity);
        let surface = body.lowest();
        let impact_energy =
            intruder.bodies().iter().flat_map(|body| body.kinetic_energy()).sum::<f64>();
        Self {
            bed,
            intruder,
            books,
            clock: Clock::new(settings.dt),
            settings,
            stopping,
            surface,
            impact_energy,
        }
    }

    /// Moves on by one step.
    ///
    /// # Errors
    /// If the step cannot be trusted.
    pub fn advance(&mut self) -> Result<(), StepError> {
        let dt = self.settings.dt;
        self.clock.tick();
        step(&mut self.bed, &mut *self.intruder, &mut self.books, self.clock.step, dt)?;
        let body = &self.intruder.bodies()[0];
        self.stopping.observe(self.clock.time(), body.position, body.velocity);
        self.check_budget()
    }

    /// Whether the intruder has stopped, or time is up.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.stopping.is_over() || self.clock.step >= self.last_step()
    }

    /// The step at which the run ends at the latest.
    #[must_use]
    pub fn last_step(&self) -> u64 {
        (self.settings.duration / self.settings.dt).ceil() as u64
    }

    fn check_budget(&self) -> Result<(), StepError> {
        let closure = self.closure();
        if closure <= self.settings.abort_above {
            return Ok(());
        }
        let (overlap, grain) = self.bed.largest_overlap();
        Err(StepError::OpenBudget {
            step: self.clock.step,
            unaccounted: self.books.ledger.balance().unaccounted,
            scale: self.impact_energy,
            closure,
            limit: self.settings.abort_above,
            suggested_dt: 0.5 * self.settings.dt,
            overlap,
            grain,
        })
    }

    /// The bed.
    #[must_use]
    pub fn bed(&self) -> &GrainBed {
        &self.bed
    }

    /// The intruder.
    #[must_use]
    pub fn intruder(&self) -> &dyn Mechanism {
        &*self.intruder
    }

    /// The energy ledger.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.books.ledger
    }

    /// Largest |energy unaccounted for| so far over the initial energy of the intruder.
    #[must_use]
    pub fn closure(&self) -> f64 {
        self.books.ledger.closure(self.impact_energy)
    }

    /// Kinetic energy of the intruder at the start [J].
    #[must_use]
    pub fn impact_energy(&self) -> f64 {
        self.impact_energy
    }

    /// Simulated time and steps.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Stopping times and depth.
    #[must_use]
    pub fn stopping(&self) -> &Stopping {
        &self.stopping
    }

    /// Height of the undisturbed surface [m]: where the lowest point of the intruder was at the
    /// start.
    #[must_use]
    pub fn surface(&self) -> f64 {
        self.surface
    }

    /// Everything that changes during the run.
    #[must_use]
    pub fn save(&self) -> Snapshot {
        Snapshot {
            clock: self.clock,
            bed: self.bed.save(),
            intruder: self.intruder.save(),
            balance: self.books.ledger.balance().clone(),
            stopping: self.stopping,
            surface: self.surface,
            impact_energy: self.impact_energy,
        }
    }

    /// Takes back a saved state of the same run; `false`, and an unusable simulation, if it is of
    /// another one.
    #[must_use]
    pub fn restore(&mut self, saved: Snapshot) -> bool {
        self.clock = saved.clock;
        self.stopping = saved.stopping;
        self.surface = saved.surface;
        self.impact_energy = saved.impact_energy;
        saved.clock.dt == self.settings.dt
            && self.books.ledger.restore(saved.balance)
            && self.intruder.restore(&saved.intruder)
            && self.bed.restore(saved.bed)
    }
}
