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
pub enum RunError {
    /// The system refused.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was being done.
        action: &'static str,
        /// To which file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A folder that cannot be written to.
    #[error("cannot write to the folder {}: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A table of grains is no longer what it was when the model was read.
    #[error("{} changed while it was read", path.display())]
    TableChanged {
        /// The table.
        path: PathBuf,
    },
    /// Another run is writing there.
    #[error("another run is writing to {}", folder.display())]
    Busy {
        /// The folder.
        folder: PathBuf,
    },
    /// Results of other inputs are there.
    #[error(
        "{} holds results of other inputs; choose another --out, or --force to replace them",
        folder.display()
    )]
    OtherInputs {
        /// The folder.
        folder: PathBuf,
    },
    /// An unfinished run of the same inputs is there.
    #[error(
        "{} holds an unfinished run of these inputs; --resume goes on with it, --force starts again",
        folder.display()
    )]
    Unfinished {
        /// The folder.
        folder: PathBuf,
    },
    /// Something that is not ours is there.
    #[error(
        "{} is not empty (it holds `{file}`); choose another --out, or --force to write beside it",
        folder.display()
    )]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
        /// One of the files.
        file: String,
    },
    /// A file with the name of a result, in a folder where no run has been.
    #[error(
        "{} has never been an output folder, and its `{file}` would be replaced; choose another --out",
        folder.display()
    )]
    NotOurs {
        /// The folder.
        folder: PathBuf,
        /// The file.
        file: String,
    },
    /// Grains of a table that lie in each other.
    #[error(
        "{}: the grains in lines {} and {} overlap by {overlap:.2e} m, more than a tenth of the smaller \
         radius; a table is a bed at rest",
        table.display(),
        lines[0],
        lines[1]
    )]
    TableOverlaps {
        /// The table.
        table: PathBuf,
        /// Of the first such pair.
        lines: [u32; 2],
        /// (m).
        overlap: f64,
    },
    /// The bed does not come to rest.
    #[error(
        "after {time:.3} s the bed still has {restlessness:.1e} times the kinetic energy, or the \
         unbalanced force, of a bed at rest; give it more damping or friction, or a smaller \
         bed.preparation_time_step"
    )]
    Restless {
        /// Simulated time (s).
        time: f64,
        /// How far from rest it is (–): below 1 it is at rest.
        restlessness: f64,
    },
    /// The model cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The text of one condition does not load; a mistake of ours.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A step of the preparation cannot be trusted.
    #[error("while the bed settled, {source}")]
    Settling {
        /// Why.
        source: StepError,
    },
    /// A step of the impact cannot be trusted.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The motion in a resistive medium cannot be integrated.
    #[error(transparent)]
    Impact(#[from] ImpactError),
    /// The energies of an impact on a resistive medium do not add up.
    #[error(
        "{closure:.1e} of the energy of the impact is unaccounted for, more than energy.abort_above = \
         {limit}"
    )]
    OpenBudget {
        /// The closure.
        closure: f64,
        /// What is accepted.
        limit: f64,
    },
    /// The log cannot be written or continued.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A checkpoint or a prepared bed cannot be written or read.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A checkpoint does not fit the run it belongs to.
    #[error("{} does not fit this run", path.display())]
    Misfit {
        /// The checkpoint.
        path: PathBuf,
    },
}
