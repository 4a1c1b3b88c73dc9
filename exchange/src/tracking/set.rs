//! A set that was imported, and what was understood of its tables.

use std::io::ErrorKind;
use std::path::Path;

use engine::checkpoint::write_whole;
use measurements::Reading;

use super::fault::TrackingError;

/// What was understood of one run, in words for a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Understood {
    /// The file, without its folder.
    pub file: String,
    /// The layout.
    pub layout: String,
    /// Rows with numbers, and how many are kept.
    pub rows: [usize; 2],
    /// The unit of time.
    pub time: String,
    /// The axis that the body falls along: its name, unit and direction.
    pub axis: String,
    /// The run.
    pub run: String,
    /// Its condition.
    pub condition: String,
    /// Time of first contact on the clock of the table (s).
    pub contact: Reading,
    /// Speed at contact (m/s).
    pub speed: Reading,
}

/// A set that is not written yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Set {
    /// One for each run.
    pub understood: Vec<Understood>,
    /// What holds for all of them, in sentences.
    pub notes: Vec<String>,
    /// Names and contents of the files.
    pub(super) files: Vec<(&'static str, String)>,
}

impl Set {
    /// Writes the files of the set into `folder`, which is made where it is missing; `import.toml` and
    /// `measurement.toml` come last, so that a set that is there is whole.
    pub fn write(&self, folder: &Path) -> Result<(), TrackingError> {
        let refused = |path: &Path| {
            let path = path.to_owned();
            move |source| TrackingError::Write { path, source }
        };
        std::fs::create_dir_all(folder).map_err(refused(folder))?;
        let last = |name: &str| name == "measurement.toml";
        let ordered = self
            .files
            .iter()
            .filter(|one| !last(one.0))
            .chain(self.files.iter().filter(|one| last(one.0)));
        for (name, content) in ordered {
            let path = folder.join(name);
            write_whole(&path, content.as_bytes()).map_err(refused(&path))?;
        }
        Ok(())
    }

    /// The present content of the files in `folder` that the set would replace.
    pub fn earlier(&self, folder: &Path) -> Earlier {
        let there = |(name, _): &(&'static str, String)| {
            match std::fs::read(folder.join(name)) {
                Ok(content) => Some((*name, Some(content))),
                Err(error) if error.kind() == ErrorKind::NotFound => Some((*name, None)),
                // What cannot be read is not touched.
                Err(_) => None,
            }
        };
        let is_new = !folder.exists();
        Earlier { files: self.files.iter().filter_map(there).collect(), is_new }
    }

    /// Whether `folder` holds these files already, byte for byte.
    pub fn is_in(&self, folder: &Path) -> bool {
        self.files.iter().all(|(name, content)| {
            std::fs::read(folder.join(name)).is_ok_and(|there| there == content.as_bytes())
        })
    }
}

/// What stood in the place of a set before it was written.
#[derive(Clone, Debug)]
pub struct Earlier {
    /// Names and contents; none of a file that is not there.
    files: Vec<(&'static str, Option<Vec<u8>>)>,
    /// Whether there is no folder.
    is_new: bool,
}

impl Earlier {
    /// Restores `folder`: the earlier files, or no folder if there was none.
    pub fn restore(self, folder: &Path) {
        // A file that cannot be changed causes an error when the set is written again.
        for (name, there) in self.files {
            let path = folder.join(name);
            let _ = match there {
                Some(content) => std::fs::write(&path, content),
                None => std::fs::remove_file(&path),
            };
        }
        if self.is_new {
            let _ = std::fs::remove_dir(folder);
        }
    }
}
