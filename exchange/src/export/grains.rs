//! The frames of a log in a format of other programs.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::whole_file::WholeFile;
use super::{ExportError, Exported};
use crate::Stop;
use crate::frames::{Frame, each_frame};

/// What writes frames.
pub(super) trait FrameWriter {
    /// One more frame.
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError>;
    /// Completes what was written and says where it is.
    fn finish(self) -> Result<Vec<PathBuf>, ExportError>;
}

/// All frames in one file of text.
pub(super) struct Text {
    file: WholeFile,
    write: fn(&mut WholeFile, &Frame) -> io::Result<()>,
}

impl Text {
    /// The file at `path`, in which `write` writes each frame.
    pub(super) fn create(
        path: PathBuf,
        write: fn(&mut WholeFile, &Frame) -> io::Result<()>,
    ) -> Result<Self, ExportError> {
        Ok(Self { file: WholeFile::create(path)?, write })
    }
}

impl FrameWriter for Text {
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError> {
        (self.write)(&mut self.file, frame).map_err(|error| self.file.failed(error))
    }

    fn finish(self) -> Result<Vec<PathBuf>, ExportError> {
        Ok(vec![self.file.finish()?])
    }
}

/// Hands every frame of the log at `path` to `writer`.
pub(super) fn export(
    path: &Path,
    mut writer: impl FrameWriter,
    stop: Stop<'_>,
) -> Result<Exported, ExportError> {
    let (mut n, mut failed) = (0, None);
    let read = each_frame(path, |frame| {
        n += 1;
        let written = if stop() { Err(ExportError::Stopped) } else { writer.frame(frame) };
        match written {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                failed = Some(error);
                ControlFlow::Break(())
            }
        }
    });
    if let Some(error) = failed {
        return Err(error);
    }
    let complete = read?;
    if n == 0 {
        return Err(ExportError::Nothing { path: path.to_owned(), what: "frame of grains" });
    }
    Ok(Exported { files: writer.finish()?, complete })
}
