//! A dump as LAMMPS writes it: all frames in one file of text.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::ExportError;
use super::grains::{Frame, FrameWriter};
use super::whole_file::WholeFile;

/// `grains.dump`, in SI units. Columns: `id type radius x y z speed force`.
///
/// Source: LAMMPS documentation, dump style custom, with `ITEM: UNITS` and `ITEM: TIME`.
pub(super) struct LammpsDump(WholeFile);

impl LammpsDump {
    pub(super) fn create(out: &Path) -> Result<Self, ExportError> {
        WholeFile::create(out.join("grains.dump")).map(Self)
    }

    fn write(&mut self, frame: &Frame) -> io::Result<()> {
        let file = &mut self.0;
        if frame.number == 0 {
            writeln!(file, "ITEM: UNITS\nsi")?;
        }
        writeln!(file, "ITEM: TIME\n{:?}", frame.time)?;
        writeln!(file, "ITEM: TIMESTEP\n{}", frame.number)?;
        writeln!(file, "ITEM: NUMBER OF ATOMS\n{}", frame.grains.len())?;
        writeln!(file, "ITEM: BOX BOUNDS ff ff ff")?;
        for [low, high] in frame.bounds() {
            writeln!(file, "{low:?} {high:?}")?;
        }
        writeln!(file, "ITEM: ATOMS id type radius x y z speed force")?;
        for grain in &frame.grains {
            let [x, y, z] = grain.position;
            let (id, radius, speed, force) = (grain.id, grain.radius, grain.speed, grain.force);
            writeln!(file, "{id} 1 {radius:?} {x:?} {y:?} {z:?} {speed:?} {force:?}")?;
        }
        Ok(())
    }
}

impl FrameWriter for LammpsDump {
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError> {
        self.write(frame).map_err(|error| self.0.failed(error))
    }

    fn finish(self) -> Result<Vec<PathBuf>, ExportError> {
        Ok(vec![self.0.finish()?])
    }
}
