//! What LAMMPS has written of an impact, as the log of a run.

pub(super) mod error;
mod faller;
mod log;
mod summary;

use std::path::Path;
use std::{fs, io};

use engine::checkpoint::write_whole;
use engine::record::{GRAIN_LOG, RUN_LOG};
use runner::run::Summary;

use super::dump::Dump;
use super::facts::Facts;
use super::samples::samples;
use super::{DUMP, FACTS, INTRUDER_TABLE};
use crate::Stop;
use crate::run_files::RunFiles;
use crate::staging::Staging;

pub use error::ImportError;
use faller::Faller;

/// A run that was brought in.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// What it came to, without what LAMMPS does not tell.
    pub summary: Summary,
    /// Where it lies.
    pub files: RunFiles,
    /// Samples of the intruder in the log.
    pub samples: usize,
    /// Frames of the grains.
    pub frames: usize,
}

/// Brings what LAMMPS wrote in `folder` into a log called `log`, with the channels of a run of plunge, its
/// grains and its summary beside it. What LAMMPS does not tell is not in them: of the energies all but
/// motion and height, and what touches the intruder. How a body is turned follows from its spins.
///
/// # Errors
/// If a file is missing, unreadable or not what the input asks for, the log cannot be written, or `stop` says
/// so between two samples.
pub fn import(folder: &Path, log: &Path, stop: Stop<'_>) -> Result<Imported, ImportError> {
    let path = folder.join(FACTS);
    let facts: Facts = serde_json::from_str(&read(&path)?)
        .map_err(|error| ImportError::Misread { path: path.clone(), why: error.to_string() })?;
    let faller = Faller::of(&facts, &path)?;
    let path = folder.join(INTRUDER_TABLE);
    let samples = samples(&path, &read(&path)?)?;
    let dump = Dump::open(&folder.join(DUMP), facts.space(), facts.gravity_m_per_s2)?;
    let files = RunFiles::of(log);
    let partial = files.log.with_added_extension("partial");
    let staging = Staging::at(partial.clone()).map_err(|source| ImportError::Io {
        path: partial,
        doing: "make",
        source,
    })?;
    let turned = faller.turned(&samples);
    let frames = log::write(&facts, &faller, &turned, dump, (staging.path(), stop))?;
    let summary = summary::of(&facts, &faller, &turned, folder);
    let text = format!("{:#}\n", serde_json::json!(summary));
    write_whole(&files.summary, text.as_bytes())
        .map_err(|source| refused(&files.summary, source))?;
    // The log comes last: where it is, all is.
    for (name, to) in [(GRAIN_LOG, &files.grains), (RUN_LOG, &files.log)] {
        staging.hand_over(name, to).map_err(|source| refused(to, source))?;
    }
    Ok(Imported { summary, files, samples: samples.len(), frames })
}

fn refused(path: &Path, source: io::Error) -> ImportError {
    ImportError::Io { path: path.to_owned(), doing: "write", source }
}

fn read(path: &Path) -> Result<String, ImportError> {
    fs::read_to_string(path).map_err(|source| ImportError::io(path, "read", source))
}
