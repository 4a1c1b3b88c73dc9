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
    pub fn new(dt: f64) -> Self {
        Self { step: 0, dt }
    }

    /// Time since the start (s).
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// One step further.
    pub(crate) fn tick(&mut self) {
        self.step += 1;
    }
}

/// How many steps of `dt` (s) it takes to cover `duration` (s). A quotient that is a whole number but
/// for round-off is that number.
pub fn steps_in(duration: f64, dt: f64) -> u64 {
    let steps = duration / dt;
    let whole = steps.round();
    let is_whole = (steps - whole).abs() <= 1e-9 * whole;
    if is_whole { whole as u64 } else { steps.ceil() as u64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_off_in_a_quotient_does_not_make_a_step() {
        assert_eq!(steps_in(0.1, 1e-6), 100_000);
        assert_eq!(steps_in(0.6, 1e-5), 60_000);
        assert_eq!(steps_in(0.25, 0.1), 3);
    }
}
