//! How fast a bed of grains is stepped, beside a peer on the same bed: `cargo xtask bench`.
//!
//! A [`problem::Problem`] is a model and its bed at rest, on disk. A [`trial::Trial`] steps it for a while,
//! in a process of its own, or has [`lammps`] step it. [`plan`] takes trials in turns, and [`report`] says
//! what came of them.

mod clock;
pub mod lammps;
pub mod plan;
pub mod problem;
pub mod report;
pub mod sharing;
pub mod spread;
pub mod style;
pub mod trial;

use std::io;
use std::path::{Path, PathBuf};

use exchange::lammps::LammpsError;
use runner::CampaignError;
use thiserror::Error;

/// Why a benchmark ends early.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SpeedError {
    #[error(transparent)]
    Impact(#[from] CampaignError),
    #[error(transparent)]
    Lammps(#[from] LammpsError),
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error("cannot start {}: {source}", program.display())]
    Start { program: PathBuf, source: io::Error },
    #[error("{} {what}:\n{said}", program.display())]
    Program { program: PathBuf, what: String, said: String },
    #[error("{}: no bed of grains from a table", .0.display())]
    NoTable(PathBuf),
    #[error("{steps} steps are too few to be timed in a run with its log")]
    TooShort { steps: u64 },
    #[error("stopped while a bed was prepared")]
    Stopped,
}

impl SpeedError {
    /// Makes an error about the file at `path`.
    fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        |source| Self::File { path, source }
    }
}
