//! What is kept of one impact on a bed of grains.

use engine::bed::surface_height;
use engine::crater::{crater, crater_size};
use engine::grains::Space;
use engine::simulation::Simulation;
use serde::{Deserialize, Serialize};

/// Share of the impact speed below which an intruder counts as stopped.
pub const STOPPED: f64 = 0.05;

/// Time between two samples of a path (s): a hundred and more of them lie before any stop.
const SAMPLE: f64 = 5e-4;

/// One impact, as it is kept in the cache.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Time between two samples (s).
    pub interval: f64,
    /// Height of the first contact, which is with the highest grains below the intruder, above the mean surface (m).
    pub contact_height: f64,
    /// Depth of the lowest point below the first contact (m), from then on.
    pub depth: Vec<f64>,
    /// Horizontal distance along the motion (m), likewise.
    pub range: Vec<f64>,
    /// Force of the grains against the velocity of an intruder that a drive pushes (N), the mean since the sample before;
    /// empty where the intruder moves freely.
    pub force: Vec<f64>,
    /// Later of the first zeros of the velocity components (s), if the intruder stopped.
    pub stopping_time: Option<f64>,
    /// When the speed first fell below 5 % of the impact speed (s), if it did.
    pub slow_time: Option<f64>,
    /// Largest depth below the first contact up to the stop (m).
    pub deepest: f64,
    /// Distance when the horizontal velocity first came to zero (m).
    pub reached: f64,
    /// Depth of the crater below the undisturbed surface at the end, and the diameter of its rim (m), where it has one.
    pub crater: Option<[f64; 2]>,
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
    /// Height of the first contact above the mean surface (m).
    contact_height: f64,
    depth: Vec<f64>,
    range: Vec<f64>,
    /// What a push has met, by sample (N).
    force: Vec<f64>,
    /// Sum of the forces since the last sample (N), and how many they are, where a drive pushes.
    since: Option<(f64, u32)>,
    /// Speed at the step before (m/s).
    before: f64,
    slow: Option<f64>,
}

impl Recorder {
    /// Of an impact that has not moved yet, or of a push.
    pub(super) fn new(simulation: &Simulation, is_pushed: bool) -> Self {
        let body = &simulation.intruder().bodies()[0];
        let speed = body.velocity.norm();
        let every = (SAMPLE / simulation.clock().dt).round().max(1.0) as u64;
        Self {
            every,
            speed,
            start: body.position.x,
            contact_height: simulation.surface() - surface_height(simulation.bed()),
            depth: Vec::new(),
            range: Vec::new(),
            force: Vec::new(),
            since: is_pushed.then_some((0.0, 0)),
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
        if let Some((sum, n)) = &mut self.since {
            *sum -= body.contact.force.dot(&body.velocity) / now;
            *n += 1;
        }
        if clock.step.is_multiple_of(self.every) {
            self.depth.push(simulation.surface() - body.lowest());
            self.range.push(body.position.x - self.start);
            if let Some((sum, n)) = &mut self.since {
                self.force.push(std::mem::take(sum) / f64::from(std::mem::take(n)));
            }
        }
    }

    /// The whole impact, which took `wall` (s).
    pub(super) fn record(self, simulation: &Simulation, wall: f64) -> Record {
        let (clock, stopping) = (simulation.clock(), *simulation.courses()[0].stopping());
        let ledger = simulation.ledger();
        let terms = ledger.terms().iter().zip(&ledger.balance().values);
        Record {
            interval: self.every as f64 * clock.dt,
            contact_height: self.contact_height,
            depth: self.depth,
            range: self.range,
            force: self.force,
            stopping_time: stopping.stopping_time(),
            slow_time: self.slow,
            deepest: stopping.depth(),
            reached: stopping.range(),
            crater: crater_of(simulation),
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

/// Depth and rim of the crater about the intruder as it is now.
fn crater_of(simulation: &Simulation) -> Option<[f64; 2]> {
    let (bed, body) = (simulation.bed(), &simulation.intruder().bodies()[0]);
    let (grains, at) = (&bed.grains, bed.image_inside(body.position));
    let y = if grains.space == Space::Planar { 0.0 } else { at.y };
    let profile = crater(grains, &bed.lying(), (at.x, y));
    let size = crater_size(&profile, simulation.surface(), grains.space)?;
    Some([size.depth, size.rim_diameter])
}

impl Record {
    /// Depth and range (m) at `time` (s) since first contact; behind the end the last ones.
    pub fn since_contact(&self, time: f64) -> (f64, f64) {
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

    /// Force (N) that a push meets `depth` (m) deep: linear between samples, nothing above the first, the last below all.
    pub fn force_at(&self, depth: f64) -> f64 {
        // A push sinks at one speed, so that depths rise.
        let after = self.depth.partition_point(|&one| one < depth);
        match (after.checked_sub(1), self.depth.get(after)) {
            (None, _) => 0.0,
            (Some(before), None) => self.force.get(before).copied().unwrap_or(0.0),
            (Some(before), Some(below)) => {
                let above = self.depth[before];
                let share = (depth - above) / (below - above);
                self.force[before] + share * (self.force[after] - self.force[before])
            }
        }
    }

    /// Depth and range (m) at `times` (s) since first contact.
    pub fn path(&self, times: &[f64]) -> Vec<(f64, f64)> {
        times.iter().map(|&time| self.since_contact(time)).collect()
    }

    /// Energy lost (J) by every channel that dissipates.
    pub fn dissipated(&self) -> impl Iterator<Item = (&str, f64)> {
        self.ledger.iter().filter_map(|(key, value)| {
            let name = key.strip_prefix("dissipated_")?.strip_suffix("_J")?;
            Some((name, *value))
        })
    }
}
