//! What goes wrong where many impacts are run.

use std::io;
use std::path::PathBuf;

use configs::{BuildError, ConfigError, Model};
use engine::checkpoint::CheckpointError;
use engine::error::{StepError, ThreadsError};
use thiserror::Error;

use crate::run::RunError;
use crate::schedulers::SchedulerError;

/// Why many impacts end early.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum CampaignError {
    #[error("cannot {action} {}: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("`{model}` has no bed of grains")]
    NoGrains { model: String },
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Step(#[from] StepError),
    #[error(
        "{:.0} % of the grains still move after {end} s, and a crater is measured when they lie still: write a longer \
         [run] duration",
        100.0 * share
    )]
    Moving { share: f64, end: f64 },
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error(transparent)]
    Scheduler(#[from] SchedulerError),
    #[error(
        "{undone} of {of} tasks have left nothing, or not all ended well; what they said is in {}, and the same \
         command hands over again what is missing",
        folder.display()
    )]
    Tasks { undone: usize, of: usize, folder: PathBuf },
    #[error("{} has the tasks 1 to {of}, not {number}", list.display())]
    NoTask { number: usize, of: usize, list: PathBuf },
    #[error("this task was planned by another version of the program")]
    OtherProgram,
    #[error("{} cannot be written: {source}", path.display())]
    Unwritable { path: PathBuf, source: serde_json::Error },
    #[error("stopped before the end")]
    Interrupted,
}

impl CampaignError {
    /// Whether it is of one impact, which is left out.
    pub(crate) fn is_of_an_impact(&self) -> bool {
        matches!(self, Self::Step(_) | Self::Moving { .. })
    }

    pub(crate) fn no_grains(model: &Model) -> Self {
        Self::NoGrains { model: model.run.name.clone() }
    }
}
