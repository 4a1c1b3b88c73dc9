//! Why a run of LAMMPS is not brought in.

use std::io;
use std::path::{Path, PathBuf};

use engine::record::RecordError;
use thiserror::Error;

use super::super::{DUMP, INTRUDER_TABLE};

/// Why a run of LAMMPS is not brought in.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ImportError {
    #[error(
        "{} is not there; import takes the folder that `plunge export MODEL --to lammps` wrote, after \
         lmp -in in.impact has run in it",
        path.display()
    )]
    Missing { path: PathBuf },
    #[error("cannot {doing} {}: {source}", path.display())]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{}: {why}", path.display())]
    Misread { path: PathBuf, why: String },
    #[error(
        "{DUMP} has a frame at step {step}, of which {INTRUDER_TABLE} says nothing: `frame` has to be a \
         multiple of `every`"
    )]
    Unpaired { step: u64 },
    #[error(transparent)]
    Record(#[from] RecordError),
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
