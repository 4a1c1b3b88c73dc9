//! Why a run is not exported.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::read::ReadError;

/// Why a run is not exported.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ExportError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("{} has no {what}", path.display())]
    Nothing { path: PathBuf, what: &'static str },
    #[error("{} is neither a log nor a folder with a {log}", path.display())]
    NoRun { path: PathBuf, log: &'static str },
    #[error("stopped before the end")]
    Stopped,
}
