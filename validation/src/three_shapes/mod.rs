//! The study of three shapes, on beds of our own: how deep cylinder, hemisphere and cone come to rest at
//! equal mass, radius and speed, and whether friction between hemisphere and grains matters.
//!
//! Each impact is run on one thread, as many at a time as there are workers, and kept in a file of its own:
//! what is there is not run again.

mod picture;
mod table;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use configs::run::{Control, Progress, RunError, prepare};
use configs::{BuildError, ConfigError, LoadOptions, Loaded, Model, ModelSource, find_shipped};
use engine::error::{StepError, ThreadsError};
use engine::parallel::with_threads;
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use picture::{depths, frictions};
pub use table::table;

/// The shipped models, which differ in their intruder alone.
pub const SHAPES: [&str; 3] = ["cylinder-3d", "hemisphere-3d", "cone-3d"];

/// Speeds of impact (m/s).
pub const SPEEDS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

/// Friction of hemisphere and grains.
pub const FRICTIONS: [f64; 2] = [0.0, 0.8];

/// The model whose friction is varied, and its speed (m/s).
const RUBBED: (&str, f64) = ("hemisphere-3d", 2.0);

/// What of the shipped models is smaller here: 3.6 diameters of the intruder across, 4 deep.
const BED: [&str; 3] =
    ["bed.grains.0.count=8000", "container.width=\"72 mm\"", "container.depth=\"72 mm\""];

/// Time between two samples of a path (s).
const SAMPLE: f64 = 1e-4;

/// One impact of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name of the shipped model.
    pub model: &'static str,
    /// (m/s).
    pub speed: f64,
    /// Seed of the bed.
    pub seed: u64,
    /// Friction of intruder and grains, where it is not the model's.
    pub friction: Option<f64>,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// blake3 of the resolved model.
    pub model_hash: String,
    /// Largest depth until the stop (m).
    pub depth_m: f64,
    /// When it stopped (s), if it did.
    pub stopping_time_s: Option<f64>,
    /// Energy of the impact (J).
    pub impact_energy_j: f64,
    /// Largest energy unaccounted for, over it.
    pub closure: f64,
    /// γ, the largest share of grains that moved at one time.
    pub moving_share: f64,
    /// T, since when the bed has been calm (s), if it is.
    pub dissipation_time_s: Option<f64>,
    /// (s).
    pub time_s: Vec<f64>,
    /// Downward speed (m/s) at these times.
    pub down_m_per_s: Vec<f64>,
}

/// Why the study ends early.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum StudyError {
    #[error("cannot {action} {}: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("{} is not a result of this study: {source}", path.display())]
    Foreign { path: PathBuf, source: serde_json::Error },
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Step(#[from] StepError),
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}

/// Every impact of the study on beds of `seeds` seeds: all shapes at all speeds, then all frictions.
#[must_use]
pub fn cases(seeds: u64) -> Vec<Case> {
    let seeds = 1..=seeds;
    let shapes = seeds.clone().flat_map(|seed| {
        SHAPES.into_iter().flat_map(move |model| {
            SPEEDS.into_iter().map(move |speed| Case { model, speed, seed, friction: None })
        })
    });
    let frictions = seeds.flat_map(|seed| {
        let (model, speed) = RUBBED;
        FRICTIONS.into_iter().map(move |f| Case { model, speed, seed, friction: Some(f) })
    });
    shapes.chain(frictions).collect()
}

/// Where results and beds are kept.
#[derive(Clone, Debug)]
pub struct Places {
    /// A file per impact.
    pub out: PathBuf,
    /// The folder of prepared beds.
    pub cache: PathBuf,
}

/// Runs `cases`, `workers` at a time; `done` is told of each as it ends. The outcomes are in the order of
/// the cases.
///
/// # Errors
/// The first that any impact ends with.
pub fn run(
    cases: &[Case],
    places: &Places,
    workers: usize,
    done: &(dyn Fn(&Case, &Outcome) + Sync),
) -> Result<Vec<Outcome>, StudyError> {
    fs::create_dir_all(&places.out).map_err(|source| StudyError::Io {
        action: "make",
        path: places.out.clone(),
        source,
    })?;
    let next = AtomicUsize::new(0);
    let found: Vec<Mutex<Option<Result<Outcome, StudyError>>>> =
        cases.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..workers.max(1) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let outcome = kept(case, places);
                    if let Ok(outcome) = &outcome {
                        done(case, outcome);
                    }
                    *found[index].lock().unwrap_or_else(PoisonError::into_inner) = Some(outcome);
                }
            });
        }
    });
    let outcomes = found
        .into_iter()
        .filter_map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner));
    outcomes.collect()
}

/// The outcome of `case`: as it was kept, or run now.
fn kept(case: &Case, places: &Places) -> Result<Outcome, StudyError> {
    let Loaded { model, .. } = case.model()?;
    let path = places.out.join(format!("{}.json", case.name()));
    let io = |action, path: &Path| {
        let path = path.to_owned();
        move |source| StudyError::Io { action, path, source }
    };
    if path.exists() {
        let text = fs::read_to_string(&path).map_err(io("read", &path))?;
        let outcome: Outcome = serde_json::from_str(&text)
            .map_err(|source| StudyError::Foreign { path: path.clone(), source })?;
        if outcome.model_hash == model.hash() {
            return Ok(outcome);
        }
    }
    let outcome = with_threads(1, || impact(&model, &places.cache))??;
    let text = serde_json::to_string(&outcome)
        .map_err(|source| StudyError::Foreign { path: path.clone(), source })?;
    let partial = path.with_extension("partial");
    fs::write(&partial, text).map_err(io("write", &partial))?;
    fs::rename(&partial, &path).map_err(io("rename", &partial))?;
    Ok(outcome)
}

impl Case {
    /// Its name in files.
    #[must_use]
    pub fn name(&self) -> String {
        let Self { model, speed, seed, friction } = self;
        let friction =
            friction.map_or_else(String::new, |friction| format!("-friction-{friction}"));
        format!("{model}-{speed}-seed-{seed}{friction}")
    }

    /// The shipped model with the speed, the seed and the friction of this case.
    ///
    /// # Errors
    /// If it does not load.
    pub fn model(&self) -> Result<Loaded, ConfigError> {
        let shipped = find_shipped(self.model).map(ModelSource::Shipped);
        let source = shipped.unwrap_or_else(|| ModelSource::Path(self.model.into()));
        let mut sets = vec![format!("impact.speed=\"{} m/s\"", self.speed)];
        sets.extend(BED.map(str::to_owned));
        sets.extend(self.friction.map(|f| format!("contact_law.intruder_friction={f:?}")));
        let options = LoadOptions { sets, seed: Some(self.seed), ..LoadOptions::default() };
        Model::load(source, &options)
    }
}

/// Runs the one impact of `model`.
fn impact(model: &Model, cache: &Path) -> Result<Outcome, StudyError> {
    let grains = model.grains().expect("the models of the study are beds of grains");
    let prepared = prepare(grains, cache, &mut Unattended)?;
    let resting = prepared.expect("nobody stops an unattended preparation").resting;
    let mut simulation = grains.simulation(&resting, &model.conditions()[0])?;
    let every = (SAMPLE / simulation.clock().dt).round().max(1.0) as u64;
    let (mut time_s, mut down_m_per_s) = (Vec::new(), Vec::new());
    loop {
        let clock = simulation.clock();
        if clock.step.is_multiple_of(every) {
            time_s.push(clock.time());
            down_m_per_s.push(-simulation.intruder().bodies()[0].velocity.z);
        }
        if simulation.is_over() {
            break;
        }
        simulation.advance()?;
    }
    Ok(Outcome {
        model_hash: model.hash(),
        depth_m: simulation.courses()[0].stopping().depth(),
        stopping_time_s: simulation.courses()[0].stopping().stopping_time(),
        impact_energy_j: simulation.impact_energy(),
        closure: simulation.closure(),
        moving_share: simulation.activity().largest_share(),
        dissipation_time_s: simulation.activity().dissipation_time(),
        time_s,
        down_m_per_s,
    })
}

/// Nobody watches and nobody stops it.
struct Unattended;

impl Control for Unattended {
    fn progress(&mut self, _: &Progress) {}

    fn warn(&mut self, _: &str) {}

    fn wants_to_stop(&self) -> bool {
        false
    }
}

/// Mean and standard error of `values`; the error is 0 for a single one.
#[must_use]
pub fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let error = if values.len() > 1 { (square / (n - 1.0) / n).sqrt() } else { 0.0 };
    (mean, error)
}

/// The outcomes of `model` at `speed`, one per seed.
fn group<'a>(
    results: &'a [(Case, Outcome)],
    model: &str,
    speed: f64,
    friction: Option<f64>,
) -> Vec<&'a Outcome> {
    let same = |case: &Case| {
        case.model == model
            && case.speed.to_bits() == speed.to_bits()
            && case.friction.map(f64::to_bits) == friction.map(f64::to_bits)
    };
    results.iter().filter(|(case, _)| same(case)).map(|(_, outcome)| outcome).collect()
}
