//! Why tasks are not submitted.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why tasks are not submitted.
#[derive(Debug, Error)]
pub enum SchedulerError {
    /// It is not installed, or cannot be started.
    #[error("cannot start `{program}`: {source}; {hint}")]
    NotThere {
        /// The program.
        program: &'static str,
        /// Why not.
        source: io::Error,
        /// What to do.
        hint: &'static str,
    },
    /// It refuses.
    #[error("`{program}` refuses: {why}")]
    Refused {
        /// The program.
        program: &'static str,
        /// What it says.
        why: String,
    },
    /// A path that no script can hold.
    #[error("{} is not UTF-8, and a script cannot name it", path.display())]
    NotText {
        /// The path.
        path: PathBuf,
    },
    /// The script cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Script {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
}
