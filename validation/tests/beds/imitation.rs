//! Impacts without grains: a force law whose numbers follow from the switches of a model and scatter from
//! bed to bed, so that thousands of impacts take a second.

use configs::{BedSource, GrainModel};
use engine::bed::random;
use runner::CampaignError;
use runner::beds::{Impacts, Job, Lie, Outstanding, Record};
use validation::benchmark::chance::normal;

/// Step of its integration (s).
const STEP: f64 = 5e-5;

/// Seeds of beds that are measured begin here.
const MEASURED: u64 = 1_000_000;

/// Steps between samples.
const EVERY: usize = 10;

/// What stands in for grains.
pub(crate) struct Imitation {
    /// Scatter of the numbers of the law from bed to bed, relative.
    pub(crate) beds: f64,
    /// Of runs on one bed.
    pub(crate) runs: f64,
    /// Whether what is measured at held-out speeds lacks the rolling resistance that it has at others.
    pub(crate) fades: bool,
}

/// Inertial drag (kg/m), friction per depth (N/m), constant resistance (N), rolling friction of the grains.
struct Law {
    drag: f64,
    friction: f64,
    constant: f64,
    rolling: f64,
}

/// Force (N) on what is pushed to a depth (m) against `friction` per depth (N/m) and rolling resistance.
pub(crate) fn pushed(friction: f64, rolling: f64, depth: f64) -> f64 {
    friction * depth * (1.0 + 100.0 * rolling * depth)
}

/// Depth and rim diameter of the crater of an impact to this depth (m).
pub(crate) fn crater(depth: f64) -> [f64; 2] {
    [0.6 * depth, 0.03 + 1.5 * depth]
}

impl Imitation {
    fn law(&self, job: &Job) -> Law {
        let of_impact = job.model.grains().expect("a bed");
        let effect = |name: &str, key: &str| -> f64 {
            let effects = of_impact.medium.effects.iter();
            effects.filter(|one| one.entry.name == name).map(|one| one.params.get(key)).sum()
        };
        let number =
            |key: &str, value: f64| of_impact.medium.contact_law.params.get(key) / value - 1.0;
        let held_out = [0.75, 1.25].contains(&job.model.impact.speed);
        let faded = self.fades && held_out && job.bed.run.seed >= MEASURED;
        let rolling = if faded { 0.0 } else { effect("rolling-resistance", "rolling_friction") };
        let cohesion = effect("cohesion-dmt", "work_of_adhesion");
        let wet = effect("capillary-bridge", "surface_tension");
        let (rough, damped) = (number("friction", 0.3), number("normal_damping_rate", 1.5e3));
        let dense = dense(job.bed.grains().expect("a bed"));
        let mass = heavier(of_impact);
        // Another preparation is another bed, of the same seed or not.
        let (x, bed) = (of_impact.medium.start.x.unwrap_or(0.0), job.bed.hash());
        let [a, b, c, d] = [
            self.normal(job.bed.run.seed, &format!("drag {x} {bed}")) * self.beds,
            self.normal(job.bed.run.seed, &format!("friction {x} {bed}")) * self.beds,
            self.normal(job.bed.run.seed, &format!("drag {}", job.model.hash())) * self.runs,
            self.normal(job.bed.run.seed, &format!("friction {}", job.model.hash())) * self.runs,
        ];
        let scatter = |by: f64| libm::exp(by);
        Law {
            drag: 0.12
                * (1.0 + rolling + 0.25 * rough + 0.3 * damped + 0.4 * dense)
                * mass
                * scatter(a + c),
            friction: 4.0
                * (1.0 + 4.0 * rolling + 0.3 * rough + 0.1 * dense)
                * mass
                * scatter(b + d),
            constant: 1.0 * cohesion + 0.8 * wet,
            rolling,
        }
    }

    fn normal(&self, seed: u64, purpose: &str) -> f64 {
        normal(&mut random(seed, purpose))
    }

    /// A push, which rolling resistance hinders the more the deeper it is.
    fn push(&self, job: &Job, to: f64) -> Record {
        let law = self.law(job);
        let (samples, speed) = (100, job.model.impact.speed);
        let depth: Vec<f64> =
            (0..=samples).map(|at| to * f64::from(at) / f64::from(samples)).collect();
        let force =
            depth.iter().map(|z| pushed(law.friction, law.rolling, *z) + law.constant).collect();
        let end = to / speed;
        Record {
            interval: end / f64::from(samples),
            range: vec![0.0; depth.len()],
            force,
            depth,
            deepest: to,
            end,
            ..self.fall(job)
        }
    }

    fn record(&self, job: &Job) -> Record {
        match job.model.impact.pushed_to {
            Some(depth) => self.push(job, depth),
            None => self.fall(job),
        }
    }

    fn fall(&self, job: &Job) -> Record {
        let law = self.law(job);
        let (mass, gravity) = (job.model.intruder.mass, 9.81);
        let (mut z, mut v) = (0.0_f64, job.model.impact.speed);
        let (mut depth, mut steps, mut slow) = (vec![0.0], 0, None);
        let resisting =
            |z: f64, v: f64| (law.drag * v * v + law.friction * z + law.constant) / mass;
        while v > 0.0 && steps < 20_000 {
            let half = v + 0.5 * STEP * (gravity - resisting(z, v));
            z += STEP * half;
            v += STEP * (gravity - resisting(z, half));
            steps += 1;
            if steps % EVERY == 0 {
                depth.push(z);
            }
            if slow.is_none() && v < 0.05 * job.model.impact.speed {
                slow = Some(steps as f64 * STEP);
            }
        }
        let end = steps as f64 * STEP;
        Record {
            interval: EVERY as f64 * STEP,
            range: vec![0.0; depth.len()],
            force: Vec::new(),
            contact_height: 0.0,
            depth,
            stopping_time: Some(end),
            slow_time: slow,
            deepest: z,
            reached: 0.0,
            end,
            crater: Some(crater(z)),
            impact_energy: 1.0,
            closure: 0.0,
            ledger: vec![("dissipated_sliding_J".to_owned(), 1.0)],
            grains: 900,
            steps: steps as u64,
            wall: 0.0,
        }
    }
}

impl Impacts for Imitation {
    fn n_workers(&self) -> usize {
        1
    }

    fn rate(&self, _: GrainModel<'_>) -> Result<f64, CampaignError> {
        Ok(1e7)
    }

    fn run(&self, jobs: &[Job]) -> Result<Vec<Option<Record>>, CampaignError> {
        Ok(jobs.iter().map(|job| Some(self.record(job))).collect())
    }

    fn lies(&self, jobs: &[Job]) -> Result<Vec<Lie>, CampaignError> {
        let lie = |job: &Job| {
            let bed = job.bed.grains().expect("a bed");
            let packing_fraction =
                0.82 + 0.02 * dense(bed) + 1e-3 * self.normal(job.bed.run.seed, "packing");
            // 900 discs of 4.8 mm over 20 cm, of 50.3 g.
            let height = 0.0836 / packing_fraction;
            let bulk_density = heavier(bed) * 50.34e-3 / (0.2 * height);
            Lie {
                packing_fraction,
                height,
                bulk_density,
                mean_diameter: 4.79e-3,
                coordination: 3.7,
            }
        };
        Ok(jobs.iter().map(lie).collect())
    }

    fn outstanding(&self, jobs: &[Job]) -> Result<Outstanding, CampaignError> {
        let work = jobs.iter().map(Job::work).sum();
        Ok(Outstanding { impacts: jobs.len(), beds: 0, work })
    }
}

/// How much denser than with a preparation friction of 0.3 and no drag a bed is; neither makes it looser without end.
fn dense(bed: GrainModel<'_>) -> f64 {
    let (friction, drag) = match &bed.medium.bed.source {
        BedSource::Settle(settle) => {
            (settle.preparation_friction.unwrap_or(0.0), settle.settling_drag)
        }
        BedSource::Csv(_) => (0.0, 0.0),
    };
    (1.0 - friction / 0.3 - drag / 60.0).max(-1.5)
}

/// Mass of the first kind of grains over what the benchmark has.
fn heavier(bed: GrainModel<'_>) -> f64 {
    match &bed.medium.bed.source {
        BedSource::Settle(settle) => {
            settle.grains[0].total_mass(bed.medium.space) / (640.0 * 4.9e-5)
        }
        BedSource::Csv(_) => 1.0,
    }
}
