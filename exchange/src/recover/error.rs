//! Why nothing of a log could be recovered.

use std::io;
use std::path::{Path, PathBuf};

/// Why nothing could be recovered.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum RecoverError {
    #[error("{}: cannot {doing}: {source}", path.display())]
    Io { path: PathBuf, doing: &'static str, source: io::Error },
    #[error("{}: {source}", path.display())]
    Write { path: PathBuf, source: mcap::McapError },
    #[error("{}: not an MCAP file", path.display())]
    NotMcap { path: PathBuf },
    #[error("{}: exists already; name a new file", path.display())]
    OutputExists { path: PathBuf },
    #[error("stopped before the end")]
    Stopped,
}

impl RecoverError {
    pub(super) fn io(path: &Path, doing: &'static str, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing, source }
    }
}
