//! What can go wrong with a log.

use std::io;
use std::path::{Path, PathBuf};

/// An error of the run log, with the file it happened to.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum RecordError {
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{}: {source}", path.display())]
    Mcap { path: PathBuf, source: mcap::McapError },
    #[error("step {step}: {what} is not finite")]
    NonFinite { step: u64, what: String },
    #[error("step {step} at {time_s} s is outside the log's range (steps below 2^32, 0 to 2^32 s)")]
    OutOfRange { step: u64, time_s: f64 },
    #[error("{}: a message of step {step} after one of step {last}", path.display())]
    StepOrder { path: PathBuf, step: u64, last: u64 },
    #[error("log setup: {0}")]
    Setup(String),
    #[error("{}: closed by an earlier error", path.display())]
    Closed { path: PathBuf },
    #[error(
        "{}: holds {found} of the {needed} messages up to step {step}; cannot resume from there",
        path.display()
    )]
    Missing { path: PathBuf, step: u64, needed: u64, found: u64 },
    #[error("{}: damaged at byte {offset}: {why}", path.display())]
    Damaged {
        path: PathBuf,
        /// Where the damaged record starts (bytes).
        offset: u64,
        why: String,
    },
    #[error("{}: its channels are not those of this run: {what}", path.display())]
    OtherRun { path: PathBuf, what: String },
}

impl RecordError {
    pub(super) fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing, source }
    }

    /// Unwraps the container's I/O errors, so that callers find a full disk in one place.
    pub(super) fn mcap(path: &Path, source: mcap::McapError) -> Self {
        match source {
            mcap::McapError::Io(source) => Self::io(path, "write", source),
            source => Self::Mcap { path: path.to_owned(), source },
        }
    }
}
