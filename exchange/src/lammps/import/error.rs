//! Why a run of LAMMPS is not brought in.

use std::io;
use std::path::{Path, PathBuf};

use engine::record::RecordError;
use thiserror::Error;

use super::super::{DUMP, INTRUDER_TABLE};

/// Why a run of LAMMPS is not brought in.
#[derive(Debug, Error)]
pub enum ImportError {
    /// A file is not there.
    #[error(
        "{} is not there; import takes the folder that `plunge export MODEL --to lammps` wrote, after \
         lmp -in in.impact has run in it",
        path.display()
    )]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// The system refuses.
    #[error("cannot {doing} {}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// The system's answer.
        source: io::Error,
    },
    /// A file that does not say what the input asks LAMMPS for.
    #[error("{}: {why}", path.display())]
    Misread {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// A frame at a step at which nothing is known of the intruder.
    #[error(
        "{DUMP} has a frame at step {step}, of which {INTRUDER_TABLE} says nothing: `frame` has to be a \
         multiple of `every`"
    )]
    Unpaired {
        /// The step.
        step: u64,
    },
    /// The log cannot be written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// It was asked to stop; no log is left.
    #[error("stopped before the end")]
    Stopped,
}

impl ImportError {
    /// That `doing` to `path` failed; a missing file is told as such.
    pub(in super::super) fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::Missing { path },
            _ => Self::Io { path, doing, source },
        }
    }
}
