//! Simulated time.

use serde::{Deserialize, Serialize};

/// Counts steps of a fixed length; time is their product, so no error adds up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Steps done.
    pub step: u64,
    /// Length of a step (s).
    pub dt: f64,
}

impl Clock {
    /// At the start.
    #[must_use]
    pub fn new(dt: f64) -> Self {
        Self { step: 0, dt }
    }

    /// Time since the start (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// One step further.
    pub(crate) fn tick(&mut self) {
        self.step += 1;
    }
}
