//! What can go wrong with a log.

use std::io;
use std::path::{Path, PathBuf};

/// An error of the run log, with the file it happened to.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file system refused an operation; a full disk arrives here, at the call that met it.
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What was being done, as in "cannot …".
        doing: &'static str,
        /// The operating system's answer.
        source: io::Error,
    },
    /// The container format refused an operation.
    #[error("{}: {source}", path.display())]
    Mcap {
        /// The file.
        path: PathBuf,
        /// The writer's or reader's answer.
        source: mcap::McapError,
    },
    /// A value that is infinite or not a number; nothing of its message was written.
    #[error("step {step}: {what} is not finite")]
    NonFinite {
        /// The step the value belongs to.
        step: u64,
        /// The quantity, spelled as in the log.
        what: String,
    },
    /// A time that is negative, or a step that a 32-bit sequence number cannot hold.
    #[error("step {step} at {time_s} s is outside the log's range (steps below 2^32, 0 to 2^32 s)")]
    OutOfRange {
        /// The step.
        step: u64,
        /// The time (s).
        time_s: f64,
    },
    /// A message of an earlier step than one already written.
    #[error("{}: a message of step {step} after one of step {last}", path.display())]
    StepOrder {
        /// The file.
        path: PathBuf,
        /// The step of the refused message.
        step: u64,
        /// The last step written.
        last: u64,
    },
    /// A setup that cannot be logged.
    #[error("log setup: {0}")]
    Setup(String),
    /// The file was closed by an earlier error.
    #[error("{}: closed by an earlier error", path.display())]
    Closed {
        /// The file.
        path: PathBuf,
    },
    /// A log to be resumed does not reach the position of the checkpoint.
    #[error(
        "{}: holds {found} of the {needed} messages up to step {step}; cannot resume from there",
        path.display()
    )]
    Missing {
        /// The old log.
        path: PathBuf,
        /// The step of the checkpoint.
        step: u64,
        /// Messages needed.
        needed: u64,
        /// Messages readable.
        found: u64,
    },
    /// A log to be resumed is damaged before the position of the checkpoint.
    #[error("{}: damaged at byte {offset}: {why}", path.display())]
    Damaged {
        /// The old log.
        path: PathBuf,
        /// Where the damaged record starts (bytes).
        offset: u64,
        /// What is wrong there.
        why: String,
    },
    /// A log to be resumed has other channels than the setup.
    #[error("{}: its channels are not those of this run: {what}", path.display())]
    OtherRun {
        /// The old log.
        path: PathBuf,
        /// The first difference.
        what: String,
    },
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
