//! A dump as LAMMPS writes it: all frames in one file of text.

use std::io::{self, Write};

use super::whole_file::WholeFile;
use crate::frames::{Frame, Grain};

/// `grains.dump`, in SI units. Columns: `id type radius x y z vx vy vz speed force`. Grains are of type 1,
/// bodies of one type each from 2 on, in the order of their names.
///
/// Source: LAMMPS documentation, dump style custom, with `ITEM: UNITS` and `ITEM: TIME`.
pub(super) fn write(file: &mut WholeFile, frame: &Frame) -> io::Result<()> {
    if frame.number == 0 {
        writeln!(file, "ITEM: UNITS\nsi")?;
    }
    writeln!(file, "ITEM: TIME\n{:?}", frame.time)?;
    writeln!(file, "ITEM: TIMESTEP\n{}", frame.number)?;
    writeln!(file, "ITEM: NUMBER OF ATOMS\n{}", frame.particles().count())?;
    writeln!(file, "ITEM: BOX BOUNDS ff ff ff")?;
    for [low, high] in frame.bounds() {
        writeln!(file, "{low:?} {high:?}")?;
    }
    writeln!(file, "ITEM: ATOMS id type radius x y z vx vy vz speed force")?;
    for (body, Grain { id, position, radius, velocity, speed, force }) in frame.particles() {
        let ([x, y, z], [vx, vy, vz]) = (position, velocity);
        let kind = 1 + body;
        writeln!(
            file,
            "{id} {kind} {radius:?} {x:?} {y:?} {z:?} {vx:?} {vy:?} {vz:?} {speed:?} {force:?}"
        )?;
    }
    Ok(())
}
