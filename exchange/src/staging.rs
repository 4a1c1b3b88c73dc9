//! A folder that takes the files of an export until all of them are whole.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::ExportError;

/// The name of that folder inside the one that the export goes to. What is left of it after a kill belongs to
/// nobody, and the next export takes its place.
pub const STAGING: &str = ".partial";

/// The folder; given up, it goes, and so does the one around it if it was made for it.
pub(super) struct Staging {
    out: PathBuf,
    path: PathBuf,
    is_new: bool,
}

impl Staging {
    /// An empty one inside `out`, which is made if it is not there.
    pub(super) fn inside(out: &Path) -> Result<Self, ExportError> {
        let path = out.join(STAGING);
        let is_new = !out.exists();
        // What was left by a kill would be taken for a part of this export.
        let cleared = if path.is_dir() { fs::remove_dir_all(&path) } else { Ok(()) };
        cleared
            .and_then(|()| fs::create_dir_all(&path))
            .map_err(|source| ExportError::Write { path: out.to_owned(), source })?;
        Ok(Self { out: out.to_owned(), path, is_new })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Moves `files`, which lie in it, to where the export goes, and says where they are then.
    pub(super) fn hand_over(mut self, files: &[PathBuf]) -> Result<Vec<PathBuf>, ExportError> {
        self.is_new = false;
        let moved = files.iter().map(|file| {
            let to = self.out.join(file.file_name().unwrap_or_default());
            match fs::rename(file, &to) {
                Ok(()) => Ok(to),
                Err(source) => Err(ExportError::Write { path: to, source }),
            }
        });
        moved.collect()
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What cannot be removed is called partial, and does not stand in the way.
        drop(fs::remove_dir_all(&self.path));
        if self.is_new {
            // Fails where somebody else has put a file there meanwhile, which is as it should be.
            drop(fs::remove_dir(&self.out));
        }
    }
}
