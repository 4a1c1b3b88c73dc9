//! Why a log gives no series.

use std::io;
use std::path::PathBuf;

/// Why a log gives no series.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ReadError {
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{}: not an MCAP file", path.display())]
    NotMcap { path: PathBuf },
    #[error(
        "{}: damaged at byte {offset}: {why}; `plunge recover` saves what is readable",
        path.display()
    )]
    Damaged {
        path: PathBuf,
        /// Where the chunk or record starts (bytes).
        offset: u64,
        why: String,
    },
    #[error("{}: {topic}: {why}", path.display())]
    Fields { path: PathBuf, topic: String, why: String },
    #[error("{}: has no state of a body; is it the run.mcap of a run?", path.display())]
    NoBodies { path: PathBuf },
}
