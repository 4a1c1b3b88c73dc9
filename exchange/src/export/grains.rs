//! The frames of a log in a format of other programs.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

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
