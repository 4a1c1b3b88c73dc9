//! Why nothing of a log could be recovered.

use std::io;
use std::path::{Path, PathBuf};

/// Why nothing could be recovered.
#[derive(Debug, thiserror::Error)]
pub enum RecoverError {
    /// The file system refused an operation.
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was being done, as in "cannot …".
        doing: &'static str,
        /// The operating system's answer.
        source: io::Error,
    },
    /// The new log could not be written.
    #[error("{}: {source}", path.display())]
    Write {
        /// The new log.
        path: PathBuf,
        /// The writer's answer.
        source: mcap::McapError,
    },
    /// The input has neither the mark of an MCAP file nor any record of one.
    #[error("{}: not an MCAP file", path.display())]
    NotMcap {
        /// The input.
        path: PathBuf,
    },
    /// The output exists, or is the input.
    #[error("{}: exists already; name a new file", path.display())]
    OutputExists {
        /// The output.
        path: PathBuf,
    },
    /// It was asked to stop; nothing was written.
    #[error("stopped before the end")]
    Stopped,
}

impl RecoverError {
    pub(super) fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing, source }
    }
}
