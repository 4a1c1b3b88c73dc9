//! What LAMMPS has written of an impact, as the log of a run.

pub(super) mod error;
mod faller;
mod log;
mod summary;

use std::fs;
use std::path::{Path, PathBuf};

use configs::engine::checkpoint::write_whole;
use configs::engine::record::{GRAIN_LOG, RUN_LOG};
use runner::run::Summary;

use super::dump::Dump;
use super::facts::Facts;
use super::samples::samples;
use super::{DUMP, FACTS, INTRUDER_TABLE};
use crate::Stop;
use crate::run_files::RunFiles;

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
    let staging = Staging::beside(&files.log)?;
    let turned = faller.turned(&samples);
    let frames = log::write(&facts, &faller, &turned, dump, (&staging.0, stop))?;
    let summary = summary::of(&facts, &faller, &turned, folder);
    staging.hand_over(&files, &summary)?;
    Ok(Imported { summary, files, samples: samples.len(), frames })
}

fn read(path: &Path) -> Result<String, ImportError> {
    fs::read_to_string(path).map_err(|source| ImportError::io(path, "read", source))
}

/// A folder that takes the logs until they are whole, and goes with this.
struct Staging(PathBuf);

impl Staging {
    fn beside(log: &Path) -> Result<Self, ImportError> {
        let mut name = log.file_name().unwrap_or_default().to_owned();
        name.push(".partial");
        let folder = log.with_file_name(name);
        fs::create_dir_all(&folder).map_err(|source| ImportError::Io {
            path: folder.clone(),
            doing: "make",
            source,
        })?;
        Ok(Self(folder))
    }

    /// Gives the files their names, the log last.
    fn hand_over(self, files: &RunFiles, summary: &Summary) -> Result<(), ImportError> {
        let text = format!("{:#}\n", serde_json::json!(summary));
        let refused = |path: &Path| {
            let path = path.to_owned();
            move |source| ImportError::Io { path, doing: "write", source }
        };
        write_whole(&files.summary, text.as_bytes()).map_err(refused(&files.summary))?;
        for (name, to) in [(GRAIN_LOG, &files.grains), (RUN_LOG, &files.log)] {
            fs::rename(self.0.join(name), to).map_err(refused(to))?;
        }
        Ok(())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What stays behind is called partial, and the next import takes its place.
        let _ = fs::remove_dir_all(&self.0);
    }
}
