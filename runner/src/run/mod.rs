//! Runs a model: bed, impacts, logs, checkpoints, summaries.

mod bed_cache;
mod drawing;
mod error;
mod folder;
mod grains;
mod intrusion;
mod log_texts;
mod model_file;
mod observables;
mod resistive;
mod summary;

use std::io;
use std::path::{Path, PathBuf};

use engine::bed::BedReport;
use engine::checkpoint::FORMAT;

use configs::{Condition, GrainModel, Medium, Model, ResistiveModel};

pub use bed_cache::{PreparedBed, bed_file, bed_key, prepare};
pub use drawing::shape_of;
pub use error::RunError;
pub use folder::Existing;
pub use summary::{
    ActivitySummary, BedSummary, CostSummary, EnergyShares, EnergySummary, FinalEnergy,
    ForceSummary, Group, ImpactSummary, IntrusionSummary, LinkSummary, ListSummary, Scatter,
    StopSummary, Summary,
};

use folder::{Found, OutputFolder};

/// Counts the changes that move a result: states and beds of another number are not taken up.
const RESULTS: u32 = 3;

/// The key of everything that follows from `inputs`, by this version of the engine.
pub fn result_key(inputs: &str) -> [u8; 32] {
    let text = format!("{} {FORMAT} {RESULTS}\n{inputs}", env!("CARGO_PKG_VERSION"));
    *blake3::hash(text.as_bytes()).as_bytes()
}

/// What a run asks of whoever started it.
pub trait Control {
    /// Called now and then.
    fn progress(&mut self, progress: &Progress);
    /// Something that the user should know.
    fn warn(&mut self, message: &str);
    /// Whether to write a checkpoint and stop.
    fn wants_to_stop(&self) -> bool;
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The bed is settling.
    Settling {
        /// Steps done.
        step: u64,
        /// Simulated time (s).
        time: f64,
        /// How far from rest the bed is (–): below 1 it is at rest.
        restlessness: f64,
    },
    /// An impact is running.
    Impact {
        /// Which condition, from 0.
        index: usize,
        /// Of how many.
        of: usize,
        /// Steps done.
        step: u64,
        /// Steps at the most.
        last_step: u64,
        /// Simulated time (s).
        time: f64,
        /// Depth so far (m).
        depth: f64,
        /// Speed (m/s).
        speed: f64,
    },
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A model of one condition.
    One(Box<Summary>),
    /// A model with a list of conditions.
    List(Box<ListSummary>),
    /// It was stopped, and can be resumed.
    Interrupted,
}

impl RunError {
    pub(super) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source }
    }

    /// Whether the input is to blame, and not what happened on the way.
    pub fn is_bad_input(&self) -> bool {
        matches!(
            self,
            Self::Busy { .. }
                | Self::Folder { .. }
                | Self::TableChanged { .. }
                | Self::OtherInputs { .. }
                | Self::Unfinished { .. }
                | Self::NotEmpty { .. }
                | Self::NotOurs { .. }
                | Self::TableOverlaps { .. }
                | Self::Build(_)
                | Self::Config(_)
        )
    }
}

/// Where a run writes and what it does about what is there.
#[derive(Clone, Debug)]
pub struct Places {
    /// The output folder.
    pub out: PathBuf,
    /// The folder of prepared beds.
    pub cache: PathBuf,
    /// What is done about results that are there already.
    pub existing: Existing,
}

/// Runs `model`, whose file reads `original`, on the threads of the current pool.
///
/// # Errors
/// If the folder is taken, the model cannot be built, or a step or a file fails.
pub fn run(
    model: &Model,
    original: &str,
    places: &Places,
    control: &mut dyn Control,
) -> Result<Outcome, RunError> {
    let table = model_file::table_of(model)?;
    let folder = OutputFolder::lock(&places.out)?;
    let conditions = model.conditions();
    let is_list = model.conditions.is_some();
    let found = folder.claim(&model_file::model_text(model), places.existing)?;
    if let Found::Finished = found {
        return Ok(if is_list {
            Outcome::List(Box::new(folder.read_json("summary.json")?))
        } else {
            Outcome::One(Box::new(folder.read_json("summary.json")?))
        });
    }
    let Some(ground) = Ground::prepare(model, &places.cache, control)? else {
        return Ok(Outcome::Interrupted);
    };
    model_file::write_model(&folder, model, table.as_deref())?;
    if !is_list {
        let task = Task { model, original, of: (0, 1) };
        let summary = ground.run(task, &folder, &conditions[0], control)?;
        return Ok(summary.map_or(Outcome::Interrupted, |one| Outcome::One(Box::new(one))));
    }
    let mut summaries = Vec::new();
    for (index, condition) in conditions.iter().enumerate() {
        let single = model.single(condition, &places.out, model_file::GRAINS)?;
        let sub = OutputFolder::lock(&places.out.join(format!("{:03}", index + 1)))?;
        // The list is ours, so an unfinished member is only ever met when the list is resumed.
        if let Found::Finished = sub.claim(&model_file::model_text(&single), Existing::Resume)? {
            summaries.push(sub.read_json("summary.json")?);
            continue;
        }
        model_file::write_model(&sub, &single, table.as_deref())?;
        let task = Task { model: &single, original, of: (index, conditions.len()) };
        match ground.run(task, &sub, condition, control)? {
            Some(summary) => summaries.push(summary),
            None => return Ok(Outcome::Interrupted),
        }
    }
    let summary = ListSummary::new(model, summaries);
    folder.write_json("summary.json", &summary)?;
    Ok(Outcome::List(Box::new(summary)))
}

/// One impact among those of a model.
#[derive(Clone, Copy)]
struct Task<'a> {
    /// The model of this one impact.
    model: &'a Model,
    /// The model file as its author wrote it.
    original: &'a str,
    /// Which condition, of how many.
    of: (usize, usize),
}

/// What the impacts of a model share.
enum Ground {
    Bed(Box<(PreparedBed, BedSummary)>),
    Law,
}

impl Ground {
    /// Prepares the bed, if the medium has one. Nothing if `control` wants to stop.
    fn prepare(
        model: &Model,
        cache: &Path,
        control: &mut dyn Control,
    ) -> Result<Option<Self>, RunError> {
        let Some(grains) = model.grains() else { return Ok(Some(Self::Law)) };
        let Some(bed) = prepare(grains, cache, control)? else { return Ok(None) };
        let report = BedReport::of(&grains.bed(&bed.resting));
        let summary = BedSummary::new(&report, bed.cache, grains);
        for warning in &summary.warnings {
            control.warn(warning);
        }
        Ok(Some(Self::Bed(Box::new((bed, summary)))))
    }

    /// Runs one impact. Nothing if `control` wanted to stop.
    fn run(
        &self,
        task: Task<'_>,
        folder: &OutputFolder,
        condition: &Condition,
        control: &mut dyn Control,
    ) -> Result<Option<Summary>, RunError> {
        match (self, &task.model.medium) {
            (Self::Bed(shared), Medium::Grains(medium)) => {
                let (bed, bed_summary) = &**shared;
                let grains = GrainModel { model: task.model, medium };
                let setting = grains::Setting { grains, task, bed, bed_summary };
                setting.run(folder, condition, control)
            }
            (_, Medium::Resistive(medium)) => {
                let resistive = ResistiveModel { model: task.model, medium };
                resistive::run(resistive, task, folder, condition, control)
            }
            (Self::Law, Medium::Grains(_)) => unreachable!("an impact has the medium of its model"),
        }
    }
}
