//! What an impact and a settling bed have in common: a bed, what moves in it, a ledger and a clock.

use serde::{Deserialize, Serialize};

use crate::body::Mechanism;
use crate::clock::Clock;
use crate::error::StepError;
use crate::grain_bed::{GrainBed, SavedBed};
use crate::ledger::{Balance, Ledger};
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
    pub fn new(mut bed: GrainBed, mut intruder: Box<dyn Mechanism>, dt: f64) -> Self {
        let mut books = Books::new(Ledger::new(bed.terms(&*intruder)));
        prime(&mut bed, &mut *intruder, &mut books, dt);
        Self { bed, intruder, books, clock: Clock::new(dt) }
    }

    /// Moves on by one step.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.clock.tick();
        let (number, dt) = (self.clock.step, self.clock.dt);
        step(&mut self.bed, &mut *self.intruder, &mut self.books, number, dt)
    }

    /// Goes on in steps of `dt` (s). The time is what it was, to half such a step, and the number of the
    /// step is the one that belongs to it.
    pub(crate) fn change_step(&mut self, dt: f64) {
        let step = (self.clock.time() / dt).round() as u64;
        self.clock = Clock { step, dt };
        self.bed.change_step(dt);
    }

    /// The bed.
    pub fn bed(&self) -> &GrainBed {
        &self.bed
    }

    /// The intruder.
    pub fn intruder(&self) -> &dyn Mechanism {
        &*self.intruder
    }

    /// The energy ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.books.ledger
    }

    /// Simulated time and steps.
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Everything that changes from step to step.
    pub(crate) fn save(&self) -> SavedWorld {
        SavedWorld {
            clock: self.clock,
            bed: self.bed.save(),
            intruder: self.intruder.save(),
            balance: self.books.ledger.balance().clone(),
        }
    }

    /// Takes back a saved state of the same world; `false`, and an unusable world, if it is of another
    /// one.
    pub(crate) fn restore(&mut self, saved: SavedWorld) -> bool {
        let same_step = saved.clock.dt.to_bits() == self.clock.dt.to_bits();
        self.clock = saved.clock;
        same_step
            && self.books.ledger.restore(saved.balance)
            && self.intruder.restore(&saved.intruder)
            && self.bed.restore(saved.bed)
    }
}

/// The state of a world between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SavedWorld {
    pub(crate) clock: Clock,
    bed: SavedBed,
    intruder: Vec<f64>,
    balance: Balance,
}
