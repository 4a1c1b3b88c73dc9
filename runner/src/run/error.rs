//! Why a run does not end.

use std::io;
use std::path::PathBuf;

use ::resistive::ImpactError;
use configs::{BuildError, ConfigError};
use engine::checkpoint::CheckpointError;
use engine::error::StepError;
use engine::record::RecordError;
use thiserror::Error;

/// Why a run failed.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum RunError {
    #[error("cannot {action} {}: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("cannot write to the folder {}: {source}", folder.display())]
    Folder { folder: PathBuf, source: io::Error },
    #[error("{} changed while it was read", path.display())]
    TableChanged { path: PathBuf },
    #[error("another run is writing to {}", folder.display())]
    Busy { folder: PathBuf },
    #[error(
        "{} holds results of other inputs; choose another --out, or --force to replace them",
        folder.display()
    )]
    OtherInputs { folder: PathBuf },
    #[error(
        "{} holds an unfinished run of these inputs; --resume goes on with it, --force starts again",
        folder.display()
    )]
    Unfinished { folder: PathBuf },
    #[error(
        "{} is not empty (it holds `{file}`); choose another --out, or --force to write beside it",
        folder.display()
    )]
    NotEmpty { folder: PathBuf, file: String },
    #[error(
        "{} has never been an output folder, and its `{file}` would be replaced; choose another --out",
        folder.display()
    )]
    NotOurs { folder: PathBuf, file: String },
    #[error(
        "{}: the grains in lines {} and {} overlap by {overlap:.2e} m, more than a tenth of the smaller \
         radius; a table is a bed at rest",
        table.display(),
        lines[0],
        lines[1]
    )]
    TableOverlaps {
        table: PathBuf,
        lines: [u32; 2],
        /// (m).
        overlap: f64,
    },
    #[error(
        "after {time:.3} s the bed still has {restlessness:.1e} times the kinetic energy, or the \
         unbalanced force, of a bed at rest; give it more damping or friction, or a smaller \
         bed.preparation_time_step"
    )]
    Restless { time: f64, restlessness: f64 },
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("while the bed settled, {source}")]
    Settling { source: StepError },
    #[error(transparent)]
    Step(#[from] StepError),
    #[error(transparent)]
    Impact(#[from] ImpactError),
    #[error(
        "{closure:.1e} of the energy of the impact is unaccounted for, more than energy.abort_above = \
         {limit}"
    )]
    OpenBudget { closure: f64, limit: f64 },
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error("{} does not fit this run", path.display())]
    Misfit { path: PathBuf },
}
