//! The study of three shapes, on beds of our own: how deep cylinder, hemisphere and cone come to rest at
//! equal mass, radius and speed, and whether friction between hemisphere and grains matters.
//!
//! Each impact is run on one thread, as many at a time as there are workers, and kept in a file of its own:
//! what is there is not run again.

mod picture;
mod table;

use std::fs;
use std::path::{Path, PathBuf};

use configs::{ConfigError, LoadOptions, Loaded, Model, ModelSource, find_shipped};
use engine::checkpoint::write_whole;
use engine::ledger::{ChannelKind, TermKind};
use engine::parallel::with_threads;
use engine::simulation::Simulation;
use runner::run::{prepare, result_key};
use serde::{Deserialize, Serialize};

use runner::{
    CampaignError, Elsewhere, ModelText, Stage, Task, Unattended, Watch, WorkerSignals, Workers,
    hexadecimal,
};

pub use picture::{depths, frictions};
pub use table::table;

/// The shipped models, which differ in their intruder alone.
pub const SHAPES: [&str; 3] = ["cylinder-3d", "hemisphere-3d", "cone-3d"];

/// Speeds of impact (m/s).
pub const SPEEDS: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

/// Friction of hemisphere and grains.
pub const FRICTIONS: [f64; 2] = [0.0, 0.8];

/// The model whose friction is varied, and its speed (m/s).
pub const RUBBED: (&str, f64) = ("hemisphere-3d", 2.0);

/// What of the shipped models is smaller here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bed {
    /// That of the study: 8 000 grains, 3.6 diameters of the intruder across, 4 deep.
    Study,
    /// 3 000 grains, 2.6 diameters across and 3 deep, for a quick look.
    Small,
}

impl Bed {
    /// As `--set` has it.
    fn sets(self) -> [String; 3] {
        let (count, width) = match self {
            Self::Study => (8000, 72),
            Self::Small => (3000, 52),
        };
        let side = |key: &str| format!("container.{key}=\"{width} mm\"");
        [format!("bed.grains.0.count={count}"), side("width"), side("depth")]
    }
}

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
    /// What it falls on.
    pub bed: Bed,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The key of the resolved model and the engine, in hexadecimal.
    pub key: String,
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
    /// Depth of the lowest point (m) at these times.
    pub path_m: Vec<f64>,
    /// How far the centre of mass has come down at the end (m): a body that tilts has it higher above its lowest
    /// point.
    pub fall_m: f64,
    /// Energies at these times.
    pub energies: Energies,
}

/// The energy in three parts over time, each counted from its value at the start (J); the intruder's kinetic
/// one is all there at the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Kinetic and potential, of the intruder.
    pub intruder_j: Vec<f64>,
    /// Kinetic, potential and elastic, of the grains.
    pub grains_j: Vec<f64>,
    /// Kinetic alone, of the grains.
    pub moving_j: Vec<f64>,
    /// Dissipated, less what was put in.
    pub dissipated_j: Vec<f64>,
}

impl Energies {
    /// The same counted from the start, where the intruder has its `impact_energy` (J) and the rest nothing:
    /// heights count from the floor in the ledger.
    fn counted_from_start(mut self, impact_energy: f64) -> Self {
        let less = |energies: &mut [f64], at_start: f64| {
            let first = energies.first().map_or(0.0, |first| first - at_start);
            energies.iter_mut().for_each(|energy| *energy -= first);
        };
        less(&mut self.intruder_j, impact_energy);
        less(&mut self.grains_j, 0.0);
        self
    }

    /// Takes note of what the ledger of `simulation` holds.
    fn observe(&mut self, simulation: &Simulation) {
        let ledger = simulation.ledger();
        let value = |key| ledger.value(key).unwrap_or(0.0);
        let moving = value("kinetic_grains_translation_J") + value("kinetic_grains_rotation_J");
        let of = |kind: ChannelKind| ledger.sum(|term| term.kind == TermKind::Channel(kind));
        self.intruder_j.push(
            value("kinetic_intruder_translation_J")
                + value("kinetic_intruder_rotation_J")
                + value("potential_intruder_J"),
        );
        self.grains_j.push(moving + value("potential_grains_J") + of(ChannelKind::Stored));
        self.moving_j.push(moving);
        self.dissipated_j.push(of(ChannelKind::Dissipated) - of(ChannelKind::Input));
    }
}

/// Every impact of the study on beds of `seeds` seeds: all shapes at all speeds, then all frictions.
pub fn cases(seeds: u64) -> Vec<Case> {
    let seeds = 1..=seeds;
    let shapes = seeds.clone().flat_map(|seed| {
        SHAPES.into_iter().flat_map(move |model| {
            SPEEDS.into_iter().map(move |speed| Case {
                model,
                speed,
                seed,
                friction: None,
                bed: Bed::Study,
            })
        })
    });
    let frictions = seeds.flat_map(|seed| {
        let (model, speed) = RUBBED;
        FRICTIONS.into_iter().map(move |f| Case {
            model,
            speed,
            seed,
            friction: Some(f),
            bed: Bed::Study,
        })
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
) -> Result<Vec<Outcome>, CampaignError> {
    make(&places.out)?;
    let all: Vec<usize> = (0..cases.len()).collect();
    let workers = Workers { number: workers.max(1), watch: &Unattended };
    workers.side_by_side(Stage::Impacts, &all, (&|_| 1.0, 0), |at, _| {
        let case = &cases[at];
        let outcome = kept_or_run(&case.model()?.model, &case.path(places), &places.cache)?;
        done(case, &outcome);
        Ok(outcome)
    })
}

/// The outcomes of those of `cases` that are there, in their order; nothing is run.
///
/// # Errors
/// If a model does not load.
pub fn kept(cases: &[Case], places: &Places) -> Result<Vec<Option<Outcome>>, CampaignError> {
    let key = |case: &Case| -> Result<String, CampaignError> { Ok(key(&case.model()?.model)) };
    cases.iter().map(|case| Ok(found(&case.path(places), &key(case)?))).collect()
}

/// The key of an impact of `model`, in hexadecimal.
fn key(model: &Model) -> String {
    hexadecimal(&result_key(&model.hash()))
}

/// The outcome of the impact of `model`: as it was kept in `path`, or run now.
fn kept_or_run(model: &Model, path: &Path, cache: &Path) -> Result<Outcome, CampaignError> {
    let key = key(model);
    if let Some(outcome) = found(path, &key) {
        return Ok(outcome);
    }
    let outcome = Outcome { key, ..with_threads(1, || impact(model, cache))?? };
    let text = serde_json::to_string(&outcome)
        .map_err(|source| CampaignError::Unwritable { path: path.to_owned(), source })?;
    write_whole(path, text.as_bytes()).map_err(|source| CampaignError::Io {
        action: "write",
        path: path.to_owned(),
        source,
    })?;
    Ok(outcome)
}

/// An impact of the study that another process runs, and keeps its outcome.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "task", rename = "shape")]
pub(crate) struct ShapeTask {
    /// The file of its outcome.
    outcome: PathBuf,
    model: ModelText,
}

impl Task for ShapeTask {
    fn run(&self, cache: &Path) -> Result<(), CampaignError> {
        kept_or_run(&*self.model.load()?, &self.outcome, cache).map(drop)
    }
}

/// Has those of `cases` that are not there run by `elsewhere`; `watch` is told how many are.
pub fn have_done(
    cases: &[Case],
    places: &Places,
    elsewhere: &Elsewhere,
    watch: &dyn Watch,
) -> Result<(), CampaignError> {
    make(&places.out)?;
    let out = std::path::absolute(&places.out).unwrap_or_else(|_| places.out.clone());
    let (mut tasks, mut paths) = (Vec::new(), Vec::new());
    for (case, outcome) in cases.iter().zip(kept(cases, places)?) {
        if outcome.is_none() {
            let outcome = out.join(case.file());
            let model = ModelText::of(&case.model()?.model);
            paths.push(outcome.clone());
            tasks.push(ShapeTask { outcome, model });
        }
    }
    let is_there = |at: usize| paths[at].is_file();
    elsewhere.run(Stage::Impacts, &tasks, &places.cache, watch, &is_there)
}

fn make(folder: &Path) -> Result<(), CampaignError> {
    let failed = |source| CampaignError::Io { action: "make", path: folder.to_owned(), source };
    fs::create_dir_all(folder).map_err(failed)
}

/// The outcome in the file `path`, if it is of `key`. A damaged file, or one of another model or engine, is
/// one that is not there: the impact is run again.
fn found(path: &Path, key: &str) -> Option<Outcome> {
    let text = fs::read_to_string(path).ok()?;
    serde_json::from_str::<Outcome>(&text).ok().filter(|outcome| outcome.key == key)
}

impl Case {
    /// Its name in files.
    pub fn name(&self) -> String {
        let Self { model, speed, seed, friction, bed } = self;
        let friction =
            friction.map_or_else(String::new, |friction| format!("-friction-{friction}"));
        let bed = if *bed == Bed::Small { "-small" } else { "" };
        format!("{model}-{speed}-seed-{seed}{friction}{bed}")
    }

    /// Where its outcome is kept.
    fn path(&self, places: &Places) -> PathBuf {
        places.out.join(self.file())
    }

    fn file(&self) -> String {
        format!("{}.json", self.name())
    }

    /// The shipped model with the speed, the seed and the friction of this case.
    ///
    /// # Errors
    /// If it does not load.
    pub fn model(&self) -> Result<Loaded, ConfigError> {
        let shipped = find_shipped(self.model).map(ModelSource::Shipped);
        let source = shipped.unwrap_or_else(|| ModelSource::Path(self.model.into()));
        let mut sets = vec![format!("impact.speed=\"{} m/s\"", self.speed)];
        sets.extend(self.bed.sets());
        sets.extend(self.friction.map(|f| format!("contact_law.intruder_friction={f:?}")));
        let options = LoadOptions { sets, seed: Some(self.seed), ..LoadOptions::default() };
        Model::load(source, &options)
    }
}

/// Runs the one impact of `model`.
fn impact(model: &Model, cache: &Path) -> Result<Outcome, CampaignError> {
    let grains = model.grains().expect("the models of the study are beds of grains");
    let prepared = prepare(grains, cache, &mut WorkerSignals { stop: &|| false, warn: &|_| () })?;
    let resting = prepared.expect("nobody stops an unattended preparation").resting;
    let mut simulation = grains.simulation(&resting, &model.conditions()[0])?;
    let every = (SAMPLE / simulation.clock().dt).round().max(1.0) as u64;
    let (mut time_s, mut down_m_per_s, mut path_m) = (Vec::new(), Vec::new(), Vec::new());
    let mut energies = Energies::default();
    let height = |simulation: &Simulation| simulation.intruder().bodies()[0].position.z;
    let start = height(&simulation);
    loop {
        let clock = simulation.clock();
        if clock.step.is_multiple_of(every) {
            time_s.push(clock.time());
            let body = &simulation.intruder().bodies()[0];
            down_m_per_s.push(-body.velocity.z);
            path_m.push(simulation.surface() - body.lowest());
            energies.observe(&simulation);
        }
        let is_calm = simulation.activity().dissipation_time().is_some();
        if clock.step >= simulation.last_step() || (simulation.is_over() && is_calm) {
            break;
        }
        simulation.advance()?;
    }
    Ok(Outcome {
        key: String::new(),
        depth_m: simulation.courses()[0].stopping().depth(),
        stopping_time_s: simulation.courses()[0].stopping().stopping_time(),
        impact_energy_j: simulation.impact_energy(),
        closure: simulation.closure(),
        moving_share: simulation.activity().largest_share(),
        dissipation_time_s: simulation.activity().dissipation_time(),
        time_s,
        down_m_per_s,
        path_m,
        fall_m: start - height(&simulation),
        energies: energies.counted_from_start(simulation.impact_energy()),
    })
}

/// Mean and standard error of `values`; the error is 0 for a single one.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_count_from_the_start_of_the_impact() {
        let energies = Energies {
            intruder_j: vec![5.0, 3.0],
            grains_j: vec![7.0, 8.5],
            moving_j: vec![0.0, 1.0],
            dissipated_j: vec![0.0, 0.5],
        };
        let counted = energies.counted_from_start(2.0);
        // Small integers and halves: exact.
        assert_eq!((counted.intruder_j, counted.grains_j), (vec![2.0, 0.0], vec![0.0, 1.5]));
    }

    #[test]
    fn only_a_whole_outcome_of_the_same_model_and_engine_is_taken_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cone-3d-1-seed-1.json");
        let outcome = Outcome {
            key: "ab".to_owned(),
            depth_m: 0.02,
            stopping_time_s: None,
            impact_energy_j: 0.1,
            closure: 1e-4,
            moving_share: 0.5,
            dissipation_time_s: Some(0.05),
            time_s: vec![0.0],
            down_m_per_s: vec![1.0],
            path_m: vec![0.0],
            fall_m: 0.0,
            energies: Energies::default(),
        };
        assert_eq!(found(&path, "ab"), None);
        let text = serde_json::to_string(&outcome).expect("JSON");
        fs::write(&path, &text).expect("a file");
        assert_eq!(found(&path, "ab"), Some(outcome));
        assert_eq!(found(&path, "cd"), None);
        fs::write(&path, &text[..text.len() / 2]).expect("half a file");
        assert_eq!(found(&path, "ab"), None);
    }
}
