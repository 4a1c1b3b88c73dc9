//! Why a log gives no series.

use std::io;
use std::path::PathBuf;

/// Why a log gives no series.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file system refused an operation.
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io {
        /// The log.
        path: PathBuf,
        /// What was being done, as in "cannot …".
        doing: &'static str,
        /// The operating system's answer.
        source: io::Error,
    },
    /// The file does not start as an MCAP file does.
    #[error("{}: not an MCAP file", path.display())]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
    /// A part that is all there and cannot be read.
    #[error(
        "{}: damaged at byte {offset}: {why}; `plunge recover` saves what is readable",
        path.display()
    )]
    Damaged {
        /// The log.
        path: PathBuf,
        /// Where the chunk or record starts (bytes).
        offset: u64,
        /// What is wrong with it.
        why: String,
    },
    /// Messages of ours whose descriptor lacks what is needed.
    #[error("{}: {topic}: {why}", path.display())]
    Fields {
        /// The log.
        path: PathBuf,
        /// The topic of the messages.
        topic: String,
        /// What is wrong with their descriptor.
        why: String,
    },
    /// A log without the state of any body.
    #[error("{}: has no state of a body; is it the run.mcap of a run?", path.display())]
    NoBodies {
        /// The log.
        path: PathBuf,
    },
}
