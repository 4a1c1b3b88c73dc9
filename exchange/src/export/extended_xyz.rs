//! Extended XYZ: all frames in one file of text.

use std::io::{self, Write};

use super::whole_file::WholeFile;
use crate::frames::{Frame, Grain};

/// What a line holds. `body` is 0 for a grain and counts bodies from 1, in the order of their names.
const PROPERTIES: &str =
    "id:I:1:species:S:1:body:I:1:pos:R:3:radius:R:1:velo:R:3:speed:R:1:force:R:1";

/// Species of grains and of bodies. ASE takes no species but chemical elements; these stand for sand and
/// steel, whatever the grains and the body are made of.
const SPECIES: [&str; 2] = ["Si", "Fe"];

/// `grains.xyz`, in SI units.
///
/// Source: the format of libAtoms, as ASE and OVITO document it.
pub(super) fn write(file: &mut WholeFile, frame: &Frame) -> io::Result<()> {
    writeln!(file, "{}", frame.particles().count())?;
    writeln!(file, "Properties={PROPERTIES} Time={:?} pbc=\"F F F\"", frame.time)?;
    for (body, Grain { id, position, radius, velocity, speed, force }) in frame.particles() {
        let ([x, y, z], [vx, vy, vz]) = (position, velocity);
        let species = SPECIES[usize::from(body > 0)];
        writeln!(
            file,
            "{id} {species} {body} {x:?} {y:?} {z:?} {radius:?} {vx:?} {vy:?} {vz:?} {speed:?} {force:?}"
        )?;
    }
    Ok(())
}
