//! Extended XYZ: all frames in one file of text.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::ExportError;
use super::grains::{Frame, FrameWriter};
use super::whole_file::WholeFile;

/// What a line holds. Every grain is of the species G.
const PROPERTIES: &str = "id:I:1:species:S:1:pos:R:3:radius:R:1:speed:R:1:force:R:1";

/// `grains.xyz`, in SI units.
///
/// Source: the format of libAtoms, as ASE and OVITO document it.
pub(super) struct ExtendedXyz(WholeFile);

impl ExtendedXyz {
    pub(super) fn create(out: &Path) -> Result<Self, ExportError> {
        WholeFile::create(out.join("grains.xyz")).map(Self)
    }

    fn write(&mut self, frame: &Frame) -> io::Result<()> {
        let file = &mut self.0;
        writeln!(file, "{}", frame.grains.len())?;
        writeln!(file, "Properties={PROPERTIES} Time={:?} pbc=\"F F F\"", frame.time)?;
        for grain in &frame.grains {
            let [x, y, z] = grain.position;
            let (id, radius, speed, force) = (grain.id, grain.radius, grain.speed, grain.force);
            writeln!(file, "{id} G {x:?} {y:?} {z:?} {radius:?} {speed:?} {force:?}")?;
        }
        Ok(())
    }
}

impl FrameWriter for ExtendedXyz {
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError> {
        self.write(frame).map_err(|error| self.0.failed(error))
    }

    fn finish(self) -> Result<Vec<PathBuf>, ExportError> {
        Ok(vec![self.0.finish()?])
    }
}
