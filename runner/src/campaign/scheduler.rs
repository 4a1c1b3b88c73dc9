//! The points of a campaign on other machines.
//!
//! Every task of the scheduler is one point and does what is not done, so that a task that is killed,
//! requeued or submitted twice does no point twice.

use std::path::PathBuf;

use crate::schedulers::{Array, Scheduler, SchedulerError, Word};
use thiserror::Error;

use super::folder::{Folder, FolderError};
use super::plan::Planned;
use super::run::missing;

/// The script in the folder of a campaign.
pub const SCRIPT: &str = "point.sh";

/// What a task needs to know to run a point.
#[derive(Clone, Debug)]
pub struct Task {
    /// This program.
    pub program: PathBuf,
    /// The campaign file.
    pub campaign: PathBuf,
    /// The folder of prepared beds.
    pub cache: PathBuf,
    /// Folders below which files may be read.
    pub allow_paths: Vec<PathBuf>,
}

/// Why points are not submitted.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum SubmitError {
    #[error(transparent)]
    Scheduler(#[from] SchedulerError),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Submits the points of `planned` that are not done to `scheduler`, and says how many they are.
///
/// # Errors
/// If the scheduler is not there or refuses, or the folder cannot be used.
pub fn submit(
    scheduler: Scheduler,
    planned: &Planned,
    folder: &Folder,
    task: &Task,
) -> Result<usize, SubmitError> {
    // Released at the end: the tasks are other processes.
    let _held = folder.claim(&planned.plan)?;
    let points: Vec<usize> = missing(planned, folder)?.into_iter().map(|index| index + 1).collect();
    let mut command = vec![
        Word::Path(&task.program),
        Word::Plain("sweep"),
        Word::Path(&task.campaign),
        Word::Plain("--out"),
        Word::Path(folder.path()),
        Word::Plain("--cache"),
        Word::Path(&task.cache),
    ];
    for path in &task.allow_paths {
        command.extend([Word::Plain("--allow-path"), Word::Path(path)]);
    }
    command.extend([Word::Plain("--quiet"), Word::Plain("--point")]);
    crate::schedulers::script(folder.path(), SCRIPT, &command)?;
    scheduler.submit(&Array {
        name: &planned.plan.name,
        tasks: &points,
        folder: folder.path(),
        script: SCRIPT,
    })?;
    Ok(points.len())
}
