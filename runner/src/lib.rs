//! Runs models: one impact or list into a folder of its own, many impacts side by side, and campaigns.
//!
//! [`run`](mod@run) makes the files of an output folder of a model; [`beds`] runs impacts on beds whose records
//! are kept in a cache; [`campaign`] plans many impacts from one file, runs what is not done and reads what there
//! is. [`Workers`] does tasks side by side in this process, [`Elsewhere`] has a [`Task`] done by another one that a
//! scheduler ([`schedulers`]) starts.

pub mod beds;
pub mod campaign;
mod elsewhere;
mod error;
pub mod run;
pub mod schedulers;
mod workers;

use std::path::{Path, PathBuf};

pub use elsewhere::{Elsewhere, ModelText, Task, WORD, work};
pub use error::CampaignError;
pub use workers::{Progress, Stage, Unattended, Watch, WorkerSignals, Workers};

/// The folder of prepared beds and finished impacts: the one `asked` for, else `$PLUNGE_CACHE`, else `runs/.cache`.
pub fn cache_folder(asked: Option<&Path>) -> PathBuf {
    let from_environment = || std::env::var_os("PLUNGE_CACHE").filter(|dir| !dir.is_empty());
    asked
        .map(Path::to_owned)
        .or_else(|| from_environment().map(PathBuf::from))
        .unwrap_or_else(|| PathBuf::from("runs/.cache"))
}

/// `key` in hexadecimal, as names of files have it.
pub fn hexadecimal(key: &[u8; 32]) -> String {
    key.iter().map(|byte| format!("{byte:02x}")).collect()
}
