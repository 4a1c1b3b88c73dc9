//! Why a run is not exported.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::read::ReadError;

/// Why a run is not exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The log.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A file that cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A log without what the format holds.
    #[error("{} has no {what}", path.display())]
    Nothing {
        /// The log.
        path: PathBuf,
        /// What is missing.
        what: &'static str,
    },
    /// A run that is not there.
    #[error("{} is neither a log nor a folder with a {log}", path.display())]
    NoRun {
        /// What was named.
        path: PathBuf,
        /// The name of the log in a folder.
        log: &'static str,
    },
    /// It was asked to stop; nothing of it is left.
    #[error("stopped before the end")]
    Stopped,
}
