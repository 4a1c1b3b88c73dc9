//! What an accelerometer in a body reads on its way.

use super::assembly::{PARTS, State};
use super::error::ImpactError;
use super::holding::accelerate;
use super::impact::Impact;
use super::modes::Modes;
use super::observe::{Observer, SolverStep};

/// Readings of an accelerometer at given times: the acceleration of the first part against gravity, upward (m/s²).
/// It is 0 in free fall, and that of gravity at rest.
pub struct Accelerometer<'a> {
    times: &'a [f64],
    gravity: f64,
    readings: Vec<f64>,
}

impl<'a> Accelerometer<'a> {
    /// Will hold the readings at `times` (s), in rising order and none before the start, of a body in `gravity`
    /// (m/s²); after the end the body rests.
    pub fn at(times: &'a [f64], gravity: f64) -> Self {
        Self { times, gravity, readings: Vec::with_capacity(times.len()) }
    }

    /// One reading per time (m/s²).
    #[must_use]
    pub fn into_readings(self) -> Vec<f64> {
        self.readings
    }
}

impl Observer for Accelerometer<'_> {
    fn solver_step(&mut self, solver_step: &mut SolverStep<'_, '_>) {
        let to = solver_step.to();
        while let Some(&time) = self.times.get(self.readings.len()).filter(|&&t| t <= to) {
            let state = solver_step.state(time);
            let (acceleration, _) = accelerate(solver_step.system, &state, solver_step.modes);
            self.readings.push(acceleration[1] + self.gravity);
        }
    }

    fn end(&mut self, _: f64, _: &State) {
        self.readings.resize(self.times.len(), self.gravity);
    }
}

impl Impact {
    /// What an accelerometer reads at `times` (s), all before first contact and in falling order (m/s²).
    ///
    /// # Errors
    /// As [`Impact::flight`].
    pub fn felt_in_flight(&self, times: &[f64]) -> Result<Vec<f64>, ImpactError> {
        let (states, system) = (self.flight(times)?, self.system());
        let felt = |state: &State| {
            let modes = Modes::at(&system, state, [false; PARTS], [[false; 2]; PARTS]);
            accelerate(&system, state, &modes).0[1] + self.bed().gravity
        };
        Ok(states.iter().map(felt).collect())
    }
}
