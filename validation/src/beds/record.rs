//! What is kept of one impact on a bed of grains, and the observables that a set asks of it.

use engine::simulation::Simulation;
use measurements::{Condition, FinalDefinition, MeasurementSet, StopDefinition};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::observable::Layout;
use crate::resampling::STOPPED;

/// Time between two samples of a path (s): a hundred and more of them lie before any stop.
const SAMPLE: f64 = 5e-4;

/// One impact, as it is kept in the cache.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Time between two samples (s).
    pub interval: f64,
    /// Depth of the lowest point below the undisturbed surface (m), from first contact on.
    pub depth: Vec<f64>,
    /// Horizontal distance along the motion (m), likewise.
    pub range: Vec<f64>,
    /// Later of the first zeros of the velocity components (s), if the intruder stopped.
    pub stopping_time: Option<f64>,
    /// When the speed first fell below 5 % of the impact speed (s), if it did.
    pub slow_time: Option<f64>,
    /// Largest depth up to the stop (m).
    pub deepest: f64,
    /// Distance when the horizontal velocity first came to zero (m).
    pub reached: f64,
    /// Simulated time (s).
    pub end: f64,
    /// Energy of the impact (J).
    pub impact_energy: f64,
    /// Largest energy unaccounted for, over it.
    pub closure: f64,
    /// Name and value (J) of every term of the ledger at the end.
    pub ledger: Vec<(String, f64)>,
    /// Grains in the bed.
    pub grains: u64,
    /// Steps.
    pub steps: u64,
    /// How long it took (s): a cost, on which no result depends.
    pub wall: f64,
}

/// Takes the samples of a running impact.
pub(super) struct Recorder {
    every: u64,
    speed: f64,
    start: f64,
    depth: Vec<f64>,
    range: Vec<f64>,
    /// Speed at the step before (m/s).
    before: f64,
    slow: Option<f64>,
}

impl Recorder {
    /// Of an impact that has not moved yet.
    pub(super) fn new(simulation: &Simulation) -> Self {
        let body = &simulation.intruder().bodies()[0];
        let speed = body.velocity.norm();
        let every = (SAMPLE / simulation.clock().dt).round().max(1.0) as u64;
        Self {
            every,
            speed,
            start: body.position.x,
            depth: Vec::new(),
            range: Vec::new(),
            before: speed,
            slow: None,
        }
    }

    /// Takes note of the state after a step, and of the first.
    pub(super) fn observe(&mut self, simulation: &Simulation) {
        let (clock, body) = (simulation.clock(), &simulation.intruder().bodies()[0]);
        let now = body.velocity.norm();
        let slow = STOPPED * self.speed;
        if self.slow.is_none() && now < slow && clock.step > 0 {
            let share = (self.before - slow) / (self.before - now);
            self.slow = Some(clock.time() - (1.0 - share) * clock.dt);
        }
        self.before = now;
        if clock.step.is_multiple_of(self.every) {
            self.depth.push(simulation.surface() - body.lowest());
            self.range.push(body.position.x - self.start);
        }
    }

    /// The whole impact, which took `wall` (s).
    pub(super) fn record(self, simulation: &Simulation, wall: f64) -> Record {
        let (clock, stopping) = (simulation.clock(), *simulation.courses()[0].stopping());
        let ledger = simulation.ledger();
        let terms = ledger.terms().iter().zip(&ledger.balance().values);
        Record {
            interval: self.every as f64 * clock.dt,
            depth: self.depth,
            range: self.range,
            stopping_time: stopping.stopping_time(),
            slow_time: self.slow,
            deepest: stopping.depth(),
            reached: stopping.range(),
            end: clock.time(),
            impact_energy: simulation.impact_energy(),
            closure: simulation.closure(),
            ledger: terms.map(|(term, value)| (term.key(), *value)).collect(),
            grains: simulation.bed().grains.len() as u64,
            steps: clock.step,
            wall,
        }
    }
}

impl Record {
    /// Depth and range (m) at `time` (s): before contact those of the free fall under `condition`,
    /// behind the end the last ones.
    pub(super) fn at(&self, time: f64, condition: &Condition, gravity: f64) -> (f64, f64) {
        if time < 0.0 {
            let (sine, cosine) = libm::sincos(condition.angle_deg.to_radians());
            let down = condition.speed * sine * time + 0.5 * gravity * time * time;
            return (down, condition.speed * cosine * time);
        }
        self.since_contact(time)
    }

    /// Likewise, not before contact.
    fn since_contact(&self, time: f64) -> (f64, f64) {
        let place = time / self.interval;
        let at = place as usize;
        let last = self.depth.len().saturating_sub(1);
        if at >= last {
            return (self.depth[last], self.range[last]);
        }
        let share = place - at as f64;
        let between = |of: &[f64]| of[at] + share * (of[at + 1] - of[at]);
        (between(&self.depth), between(&self.range))
    }

    /// Depth and range (m) at `times` (s) since first contact.
    #[must_use]
    pub fn path(&self, times: &[f64]) -> Vec<(f64, f64)> {
        times.iter().map(|&time| self.since_contact(time)).collect()
    }

    /// The observables that `layout` asks for, as `set` defines them.
    #[must_use]
    pub fn observables(
        &self,
        layout: &Layout,
        condition: &Condition,
        set: &MeasurementSet,
    ) -> DVector<f64> {
        let frames: Vec<(f64, f64)> =
            layout.times.iter().map(|&time| self.at(time, condition, set.bed.gravity)).collect();
        let mut numbers: Vec<f64> = frames.iter().map(|(depth, _)| *depth).collect();
        if layout.along_x {
            numbers.extend(frames.iter().map(|(_, range)| *range));
        }
        let stop = match set.stop {
            StopDefinition::ComponentZero => self.stopping_time,
            StopDefinition::SpeedFivePercent => self.slow_time,
        };
        let (depth, range) = match set.last {
            FinalDefinition::Deepest => (self.deepest, self.reached),
            FinalDefinition::Resting => self.at(self.end, condition, set.bed.gravity),
        };
        let scalars = [
            (layout.stop_time, stop.unwrap_or(self.end)),
            (layout.final_z, depth),
            (layout.final_x, range),
        ];
        numbers.extend(scalars.iter().filter(|(there, _)| *there).map(|(_, value)| *value));
        DVector::from_vec(numbers)
    }

    /// Energy lost (J) by every channel that dissipates.
    pub fn dissipated(&self) -> impl Iterator<Item = (&str, f64)> {
        self.ledger.iter().filter_map(|(key, value)| {
            let name = key.strip_prefix("dissipated_")?.strip_suffix("_J")?;
            Some((name, *value))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, set};
    use measurements::Kind;

    fn record() -> Record {
        Record {
            interval: 0.01,
            depth: vec![0.0, 0.01, 0.018],
            range: vec![0.0, 0.005, 0.006],
            stopping_time: Some(0.019),
            slow_time: Some(0.017),
            deepest: 0.0181,
            reached: 0.0061,
            end: 0.03,
            impact_energy: 1.0,
            closure: 0.0,
            ledger: vec![("dissipated_sliding_J".into(), 0.4), ("elastic_spring_J".into(), 0.1)],
            grains: 1,
            steps: 1,
            wall: 0.0,
        }
    }

    #[test]
    fn a_path_is_linear_between_samples_free_before_contact_and_still_at_the_end() {
        let (record, condition) = (record(), condition(1.0, 90.0));
        // Sums and products of a few rounded decimals.
        let close = |found: (f64, f64), expected: (f64, f64)| {
            (found.0 - expected.0).abs() < 1e-15 && (found.1 - expected.1).abs() < 1e-15
        };
        assert!(close(record.at(0.015, &condition, 9.81), (0.014, 0.0055)));
        assert!(close(record.at(1.0, &condition, 9.81), (0.018, 0.006)));
        let flight = record.at(-0.1, &condition, 9.81);
        assert!((flight.0 + 0.1 - 0.04905).abs() < 1e-15 && flight.1.abs() < 1e-16, "{flight:?}");
    }

    #[test]
    fn scalars_follow_the_definitions_of_the_set() {
        let condition = condition(1.0, 45.0);
        let mut set = set(Kind::Scalar, vec![condition.clone()], Vec::new());
        let layout = Layout { stop_time: true, final_z: true, final_x: true, ..Layout::default() };
        let found = record().observables(&layout, &condition, &set);
        assert_eq!(found.as_slice(), [0.017, 0.018, 0.006]);
        set.stop = StopDefinition::ComponentZero;
        set.last = FinalDefinition::Deepest;
        let found = record().observables(&layout, &condition, &set);
        assert_eq!(found.as_slice(), [0.019, 0.0181, 0.0061]);
        assert_eq!(record().dissipated().collect::<Vec<_>>(), [("sliding", 0.4)]);
    }
}
