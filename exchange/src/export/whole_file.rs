//! A file that has its name once it is whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::ExportError;

/// A file that is being written under another name; given up, it leaves nothing.
pub(crate) struct WholeFile {
    path: PathBuf,
    partial: PathBuf,
    file: BufWriter<File>,
}

impl WholeFile {
    /// The file to be at `path`.
    pub(crate) fn create(path: PathBuf) -> Result<Self, ExportError> {
        let mut partial = path.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        match File::create(&partial) {
            Ok(file) => Ok(Self { path, partial, file: BufWriter::new(file) }),
            Err(source) => Err(ExportError::Write { path, source }),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What went wrong, as an error of this file.
    pub(crate) fn failed(&self, source: impl Into<io::Error>) -> ExportError {
        ExportError::Write { path: self.path.clone(), source: source.into() }
    }

    /// Gives the file its name, and says it.
    pub(crate) fn finish(mut self) -> Result<PathBuf, ExportError> {
        let done = self.file.flush().and_then(|()| self.file.get_ref().sync_all());
        done.and_then(|()| fs::rename(&self.partial, &self.path)).map_err(|e| self.failed(e))?;
        Ok(self.path.clone())
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        // After `finish` nothing has this name any more.
        drop(fs::remove_file(&self.partial));
    }
}
