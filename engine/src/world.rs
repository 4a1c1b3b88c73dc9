//! What an impact and a settling bed have in common: a bed, what moves in it, a ledger and a clock.

use crate::body::Mechanism;
use crate::clock::Clock;
use crate::error::StepError;
use crate::grain_bed::GrainBed;
use crate::ledger::Ledger;
use crate::step::{Books, prime, step};

/// A bed and an intruder that are stepped without asking when to stop: for preparations, and for
/// experiments on a few grains. With [`crate::body::NoIntruder`] it is a bed on its own.
pub struct World {
    pub(crate) bed: GrainBed,
    pub(crate) intruder: Box<dyn Mechanism>,
    pub(crate) books: Books,
    pub(crate) clock: Clock,
}

impl World {
    /// Finds the forces of the initial state and opens the ledger on it; `dt` (s) is the step.
    #[must_use]
    pub fn new(mut bed: GrainBed, mut intruder: Box<dyn Mechanism>, dt: f64) -> Self {
        let mut books = Books::new(Ledger::new(bed.terms()));
        prime(&mut bed, &mut *intruder, &mut books);
        Self { bed, intruder, books, clock: Clock::new(dt) }
    }

    /// Moves on by one step.
    ///
    /// # Errors
    /// If the step cannot be trusted.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.clock.tick();
        let (number, dt) = (self.clock.step, self.clock.dt);
        step(&mut self.bed, &mut *self.intruder, &mut self.books, number, dt)
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

    /// Simulated time and steps.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.clock
    }
}
