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
pub enum SpeedError {
    /// A model, a bed or an impact of a problem fails.
    #[error(transparent)]
    Impact(#[from] CampaignError),
    /// LAMMPS cannot express a problem.
    #[error(transparent)]
    Lammps(#[from] LammpsError),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A program cannot be started.
    #[error("cannot start {}: {source}", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A program failed, or said something else than it should.
    #[error("{} {what}:\n{said}", program.display())]
    Program {
        /// The program.
        program: PathBuf,
        /// What it did.
        what: String,
        /// The end of what it wrote.
        said: String,
    },
    /// A problem has no bed of grains from a table.
    #[error("{}: no bed of grains from a table", .0.display())]
    NoTable(PathBuf),
    /// A run that ends before it is looked at.
    #[error("{steps} steps are too few to be timed in a run with its log")]
    TooShort {
        /// How many were asked for.
        steps: u64,
    },
    /// The preparation of a bed was stopped.
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
