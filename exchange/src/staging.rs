//! A folder that takes files until all of them are whole.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// The name of such a folder inside the one that its files go to. What is left of it after a kill belongs to nobody,
/// and the next one takes its place.
pub const STAGING: &str = ".partial";

/// The folder, which goes with this.
#[derive(Debug)]
pub struct Staging(PathBuf);

impl Staging {
    /// An empty one at `path`, which is made with what is missing above it.
    ///
    /// # Errors
    /// If it cannot be emptied or made.
    pub fn at(path: PathBuf) -> io::Result<Self> {
        if path.is_dir() {
            fs::remove_dir_all(&path)?;
        }
        fs::create_dir_all(&path)?;
        Ok(Self(path))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Moves the file called `name` from it to `to`.
    pub fn hand_over(&self, name: &str, to: &Path) -> io::Result<()> {
        fs::rename(self.0.join(name), to)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What cannot be removed is called partial, and does not stand in the way.
        drop(fs::remove_dir_all(&self.0));
    }
}
