//! Why tasks are not submitted.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why tasks are not submitted.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SchedulerError {
    #[error("cannot start `{program}`: {source}; {hint}")]
    NotThere { program: &'static str, source: io::Error, hint: &'static str },
    #[error("`{program}` refuses: {why}")]
    Refused { program: &'static str, why: String },
    #[error("{} is not UTF-8, and a script cannot name it", path.display())]
    NotText { path: PathBuf },
    #[error("cannot write {}: {source}", path.display())]
    Script { path: PathBuf, source: io::Error },
}
