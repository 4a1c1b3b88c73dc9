//! The folder of a campaign: a plan that never changes, and a folder per point.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use engine::checkpoint::write_whole;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::done::Done;
use super::plan::Plan;

/// The file with the plan.
pub const PLAN: &str = "points.json";

/// The folder with a folder per point, called by the hash of the point.
pub const POINTS_FOLDER: &str = "points";

/// In the folder of a point that is done.
const DONE: &str = "done.json";

/// The file whose lock says that a campaign runs here.
const LOCK: &str = ".lock";

/// Why a folder of a campaign cannot be used.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum FolderError {
    #[error("cannot {action} {}: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: io::Error },
    #[error("{} is being run by another process", folder.display())]
    Busy { folder: PathBuf },
    #[error(
        "{} holds the plan of another campaign, of other models or of another version; a plan never \
         changes: choose another --out",
        folder.display()
    )]
    OtherPlan { folder: PathBuf },
    #[error("{} holds files and no {PLAN}; choose another --out", folder.display())]
    NotOurs { folder: PathBuf },
    #[error("{} holds no {PLAN}: no campaign was planned there", folder.display())]
    NoPlan { folder: PathBuf },
    #[error("{} cannot be read: {why}", path.display())]
    Misunderstood { path: PathBuf, why: String },
}

/// The folder of a campaign.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

/// Keeps other processes from running the same campaign, as long as it lives.
#[derive(Debug)]
pub struct Held {
    _lock: File,
}

impl Folder {
    /// The folder at `path`, whatever is there.
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Takes hold of the folder, made if it is not there, and leaves `plan` in it.
    ///
    /// # Errors
    /// If another plan or something else is there, or another process holds it.
    pub fn claim(&self, plan: &Plan) -> Result<Held, FolderError> {
        match self.holds(plan) {
            Ok(()) => return self.hold(),
            Err(FolderError::NoPlan { .. }) => {}
            Err(error) => return Err(error),
        }
        let partial = format!("{PLAN}.partial");
        let ours = |name: &std::ffi::OsStr| name == LOCK || name == partial.as_str();
        let occupied = fs::read_dir(&self.path)
            .is_ok_and(|entries| entries.flatten().any(|entry| !ours(&entry.file_name())));
        if occupied {
            return Err(FolderError::NotOurs { folder: self.path.clone() });
        }
        fs::create_dir_all(&self.path).map_err(|source| failed("make", &self.path, source))?;
        let held = self.hold()?;
        self.write(PLAN, &pretty(plan, &self.path.join(PLAN))?)?;
        Ok(held)
    }

    /// Nothing, if it holds `plan`.
    fn holds(&self, plan: &Plan) -> Result<(), FolderError> {
        let (file, folder) = (self.path.join(PLAN), self.path.clone());
        match fs::read(&file) {
            Ok(found) => match found == pretty(plan, &file)?.as_bytes() {
                true => Ok(()),
                false => Err(FolderError::OtherPlan { folder }),
            },
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(FolderError::NoPlan { folder })
            }
            Err(source) => Err(failed("read", &file, source)),
        }
    }

    /// Leaves the file `name`, whole or not at all.
    fn write(&self, name: &str, text: &str) -> Result<(), FolderError> {
        write(&self.path.join(name), text)
    }

    /// The plan that it holds.
    ///
    /// # Errors
    /// If there is none, or it cannot be read.
    pub fn plan(&self) -> Result<Plan, FolderError> {
        read_json(&self.path.join(PLAN))?
            .ok_or_else(|| FolderError::NoPlan { folder: self.path.clone() })
    }

    /// The folder of the point `hash`.
    pub fn of_point(&self, hash: &str) -> PathBuf {
        self.path.join(POINTS_FOLDER).join(hash)
    }

    /// What came of the point `hash`; `None` if it is not done.
    pub fn done(&self, hash: &str) -> Result<Option<Done>, FolderError> {
        read_json(&self.of_point(hash).join(DONE))
    }

    /// Leaves `done`, whole or not at all: the point is done with it.
    pub(crate) fn conclude(&self, done: &Done) -> Result<(), FolderError> {
        let folder = self.of_point(&done.hash);
        // A point that failed before it began has none yet.
        fs::create_dir_all(&folder).map_err(|source| failed("make", &folder, source))?;
        let file = folder.join(DONE);
        write(&file, &pretty(done, &file)?)
    }

    fn hold(&self) -> Result<Held, FolderError> {
        let path = self.path.join(LOCK);
        let lock = File::create(&path).map_err(|source| failed("write", &path, source))?;
        match lock.try_lock() {
            Ok(()) => Ok(Held { _lock: lock }),
            Err(TryLockError::WouldBlock) => Err(FolderError::Busy { folder: self.path.clone() }),
            Err(TryLockError::Error(source)) => Err(failed("lock", &path, source)),
        }
    }
}

fn failed(action: &'static str, path: &Path, source: io::Error) -> FolderError {
    FolderError::Io { action, path: path.to_owned(), source }
}

/// A value for the file `path`, keys in order.
fn pretty(value: &impl Serialize, path: &Path) -> Result<String, FolderError> {
    let value = serde_json::to_value(value).map_err(|error| failed("write", path, error.into()))?;
    Ok(format!("{value:#}\n"))
}

/// Writes a file whole or not at all.
fn write(path: &Path, text: &str) -> Result<(), FolderError> {
    write_whole(path, text.as_bytes()).map_err(|source| failed("write", path, source))
}

/// What is in a file of JSON; `None` if it is not there.
fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, FolderError> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(failed("read", path, source)),
    };
    let misunderstood = |error: serde_json::Error| FolderError::Misunderstood {
        path: path.to_owned(),
        why: error.to_string(),
    };
    serde_json::from_str(&text).map(Some).map_err(misunderstood)
}
