//! The folder a run writes to: what may be in it, and that only one run writes.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use engine::checkpoint::write_whole;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::error::RunError;

/// What is done about results that are there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// Other inputs and unfinished runs are refused.
    Keep,
    /// An unfinished run of the same inputs goes on.
    Resume,
    /// Whatever is there is replaced.
    Replace,
}

/// What was found in a folder.
pub(super) enum Found {
    /// Nothing: start from the beginning.
    Nothing,
    /// An unfinished run of the same inputs, to go on with.
    Unfinished,
    /// A finished run of the same inputs.
    Finished,
}

/// The files a finished run of one condition leaves.
const RESULTS: [&str; 6] =
    ["run.mcap", "grains.mcap", "summary.json", "model.toml", "grains.csv", "report.html"];

/// The files an unfinished run may have left.
const UNFINISHED: [&str; 12] = [
    "run.mcap.partial",
    "run.mcap.partial.new",
    "grains.mcap.partial",
    "grains.mcap.partial.new",
    "summary.json.partial",
    "model.toml.partial",
    "grains.csv.partial",
    "report.html.partial",
    "report.partial.html",
    "checkpoint",
    "checkpoint.partial",
    "checkpoint.prev",
];

/// The file whose lock says that a run writes here.
const LOCK: &str = ".lock";

/// A folder that this run alone writes to, as long as it lives.
#[derive(Debug)]
pub(super) struct OutputFolder {
    path: PathBuf,
    /// Whether a run has been here before.
    is_ours: bool,
    _lock: File,
}

impl OutputFolder {
    /// Takes hold of `path`, made if it is not there.
    pub(super) fn lock(path: &Path) -> Result<Self, RunError> {
        let refused = |source| RunError::Folder { folder: path.to_owned(), source };
        fs::create_dir_all(path).map_err(refused)?;
        let name = path.join(LOCK);
        let is_ours = name.exists();
        let lock = File::create(&name).map_err(refused)?;
        match lock.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), is_ours, _lock: lock }),
            Err(TryLockError::WouldBlock) => Err(RunError::Busy { folder: path.to_owned() }),
            Err(TryLockError::Error(source)) => Err(RunError::io("lock", &name, source)),
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Compares what is there with the inputs, whose resolved text is `model`, and makes room where
    /// `existing` allows it.
    pub(super) fn claim(&self, model: &str, existing: Existing) -> Result<Found, RunError> {
        let folder = self.path.clone();
        if existing == Existing::Replace {
            self.clear()?;
            return Ok(Found::Nothing);
        }
        match fs::read_to_string(self.file("model.toml")) {
            Ok(text) if text == model => {}
            Ok(_) => {
                if !self.is_ours {
                    remove(&self.file(LOCK))?;
                }
                return Err(RunError::OtherInputs { folder });
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return match self.stranger()? {
                    Some(file) => {
                        if !self.is_ours {
                            remove(&self.file(LOCK))?;
                        }
                        Err(RunError::NotEmpty { folder, file })
                    }
                    None => Ok(Found::Nothing),
                };
            }
            Err(source) => return Err(RunError::io("read", &self.file("model.toml"), source)),
        }
        if self.file("summary.json").exists() {
            // A run killed after its last result left them.
            self.tidy()?;
            Ok(Found::Finished)
        } else if existing == Existing::Resume {
            Ok(Found::Unfinished)
        } else {
            Err(RunError::Unfinished { folder })
        }
    }

    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Removes the results of earlier runs, and nothing else: in a folder where no run has been, a file
    /// with the name of a result is somebody's own.
    fn clear(&self) -> Result<(), RunError> {
        if !self.is_ours
            && let Some(name) = RESULTS.iter().find(|name| self.file(name).exists())
        {
            // The lock would make it look like ours the next time.
            remove(&self.file(LOCK))?;
            let (folder, file) = (self.path.clone(), (*name).to_owned());
            return Err(RunError::NotOurs { folder, file });
        }
        for name in RESULTS.iter().chain(&UNFINISHED) {
            remove(&self.file(name))?;
        }
        for entry in self.entries()? {
            let is_condition = entry.len() >= 3 && entry.bytes().all(|byte| byte.is_ascii_digit());
            let sub = self.file(&entry);
            if is_condition && sub.join("model.toml").exists() {
                for name in RESULTS.iter().chain(&UNFINISHED).chain(&[LOCK]) {
                    remove(&sub.join(name))?;
                }
                // Whatever else somebody put there stays, and keeps the folder.
                let _ = fs::remove_dir(&sub);
            }
        }
        Ok(())
    }

    /// Removes what only an unfinished run needs.
    pub(super) fn tidy(&self) -> Result<(), RunError> {
        UNFINISHED.iter().try_for_each(|name| remove(&self.file(name)))
    }

    /// A file or folder that is not from a run that was killed before it had its `model.toml`.
    fn stranger(&self) -> Result<Option<String>, RunError> {
        let ours = [LOCK, "model.toml.partial"];
        Ok(self.entries()?.into_iter().find(|name| !ours.contains(&name.as_str())))
    }

    fn entries(&self) -> Result<Vec<String>, RunError> {
        let fail = |source| RunError::io("read the folder", &self.path, source);
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.path).map_err(fail)? {
            names.push(entry.map_err(fail)?.file_name().to_string_lossy().into_owned());
        }
        names.sort();
        Ok(names)
    }

    /// Writes a file whole or not at all.
    pub(super) fn write(&self, name: &str, content: &[u8]) -> Result<(), RunError> {
        let path = self.file(name);
        write_whole(&path, content).map_err(|source| RunError::io("write", &path, source))
    }

    pub(super) fn write_json<T: Serialize>(&self, name: &str, value: &T) -> Result<(), RunError> {
        let mut text = serde_json::to_string_pretty(value)
            .map_err(|error| RunError::io("encode", &self.file(name), io::Error::other(error)))?;
        text.push('\n');
        self.write(name, text.as_bytes())
    }

    pub(super) fn read_json<T: DeserializeOwned>(&self, name: &str) -> Result<T, RunError> {
        let path = self.file(name);
        let text =
            fs::read_to_string(&path).map_err(|source| RunError::io("read", &path, source))?;
        serde_json::from_str(&text)
            .map_err(|error| RunError::io("understand", &path, io::Error::other(error)))
    }
}

fn remove(path: &Path) -> Result<(), RunError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(RunError::io("remove", path, source))
        }
        _ => Ok(()),
    }
}
