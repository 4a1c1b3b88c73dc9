//! The dump that LAMMPS writes of all atoms, read back frame by frame.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use engine::grains::Space;
use engine::math::Vec3;
use engine::record::GrainSample;

use super::atom_type::GRAIN;
use super::data::from_axes;
use super::import::error::ImportError;

/// All grains at one time.
pub(super) struct Frame {
    pub(super) step: u64,
    pub(super) grains: Vec<GrainSample>,
}

/// A dump that is being read.
pub(super) struct Dump {
    path: PathBuf,
    lines: BufReader<File>,
    /// The line read last, and its number.
    line: String,
    number: u64,
    space: Space,
    /// (m/s²), downward.
    gravity: f64,
}

impl Dump {
    /// The dump at `path` of a bed under `gravity` (m/s²).
    pub(super) fn open(path: &Path, space: Space, gravity: f64) -> Result<Self, ImportError> {
        let file = File::open(path).map_err(|source| ImportError::io(path, "open", source))?;
        let (path, line) = (path.to_owned(), String::new());
        Ok(Self { path, lines: BufReader::new(file), line, number: 0, space, gravity })
    }

    /// The next whole frame; `None` behind the last one.
    pub(super) fn next(&mut self) -> Result<Option<Frame>, ImportError> {
        let (mut step, mut atoms) = (None, None);
        while self.advance()? {
            match self.line.trim_end() {
                "ITEM: TIMESTEP" => step = Some(self.number_below()?),
                "ITEM: NUMBER OF ATOMS" => atoms = Some(self.number_below()?),
                header if header.starts_with("ITEM: ATOMS ") => {
                    let columns = Columns::of(header).ok_or_else(|| {
                        self.refused("the atoms lack a column that the input asks for")
                    })?;
                    let (Some(Some(step)), Some(Some(atoms))) = (step, atoms) else {
                        return Err(self.refused("atoms of no known number or step"));
                    };
                    let grains = self.grains(&columns, atoms)?;
                    return Ok(grains.map(|grains| Frame { step, grains }));
                }
                _ => {}
            }
        }
        Ok(None)
    }

    /// The grains in the next lines; nothing if the dump ends before.
    fn grains(
        &mut self,
        columns: &Columns,
        atoms: u64,
    ) -> Result<Option<Vec<GrainSample>>, ImportError> {
        let mut grains = Vec::new();
        let mut numbers = Vec::new();
        for _ in 0..atoms {
            if !self.advance()? {
                return Ok(None);
            }
            numbers.clear();
            numbers.extend(
                self.line.split_ascii_whitespace().map_while(|word| word.parse::<f64>().ok()),
            );
            if numbers.len() != columns.count {
                return Err(self.refused("not the numbers of an atom"));
            }
            if columns.of_kind(&numbers, GRAIN) {
                grains.push(columns.grain(&numbers, self.space, self.gravity));
            }
        }
        Ok(Some(grains))
    }

    /// The whole number in the next line; nothing if the dump ends before.
    fn number_below(&mut self) -> Result<Option<u64>, ImportError> {
        match self.advance()? {
            true => self.line.trim().parse().map(Some).map_err(|_| self.refused("no number")),
            false => Ok(None),
        }
    }

    /// Reads one more whole line; LAMMPS may have been stopped in the middle of one.
    fn advance(&mut self) -> Result<bool, ImportError> {
        self.line.clear();
        self.number += 1;
        let read: io::Result<usize> = self.lines.read_line(&mut self.line);
        read.map_err(|source| ImportError::io(&self.path, "read", source))?;
        Ok(self.line.ends_with('\n'))
    }

    fn refused(&self, why: &str) -> ImportError {
        let why = format!("line {}: {why}", self.number);
        ImportError::Misread { path: self.path.clone(), why }
    }
}

/// Where an atom's numbers stand in its line.
struct Columns {
    count: usize,
    kind: usize,
    id: usize,
    radius: usize,
    mass: usize,
    position: [usize; 3],
    velocity: [usize; 3],
    force: [usize; 3],
}

impl Columns {
    fn of(header: &str) -> Option<Self> {
        let names: Vec<&str> = header.split_ascii_whitespace().skip(2).collect();
        let at = |name: &str| names.iter().position(|one| *one == name);
        let three = |[x, y, z]: [&str; 3]| Some([at(x)?, at(y)?, at(z)?]);
        Some(Self {
            count: names.len(),
            kind: at("type")?,
            id: at("id")?,
            radius: at("radius")?,
            mass: at("mass")?,
            position: three(["x", "y", "z"])?,
            velocity: three(["vx", "vy", "vz"])?,
            force: three(["fx", "fy", "fz"])?,
        })
    }

    fn of_kind(&self, numbers: &[f64], kind: usize) -> bool {
        numbers[self.kind].to_bits() == (kind as f64).to_bits()
    }

    fn grain(&self, numbers: &[f64], space: Space, gravity: f64) -> GrainSample {
        let vector = |places: [usize; 3]| from_axes(space, places.map(|place| numbers[place]));
        // What LAMMPS calls a force has the weight in it.
        let weight = Vec3::new(0.0, 0.0, -gravity * numbers[self.mass]);
        GrainSample {
            position: vector(self.position),
            radius: numbers[self.radius],
            velocity: vector(self.velocity),
            force: (vector(self.force) - weight).norm(),
            id: (numbers[self.id] as u32).saturating_sub(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const HEAD: &str = "ITEM: TIME\n0.005\nITEM: TIMESTEP\n500\nITEM: NUMBER OF ATOMS\n2\n\
        ITEM: BOX BOUNDS mm ff pp\n0 1\n0 1\n-0.5 0.5\n\
        ITEM: ATOMS id type radius mass x y z vx vy vz fx fy fz\n";
    const ATOMS: &str = "1 1 0.01 0.5 0.25 0.125 0 1 2 0 3 -1 0\n3 2 0.02 1 0 0 0 0 0 0 0 0 0\n";

    fn frames(text: &str) -> Result<Vec<Frame>, ImportError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("grains.dump");
        fs::write(&path, text).expect("a dump");
        let mut dump = Dump::open(&path, Space::Planar, 10.0)?;
        std::iter::from_fn(|| dump.next().transpose()).collect()
    }

    #[test]
    fn grains_of_a_planar_dump_stand_upright_and_the_intruder_is_none() {
        let frames = frames(&format!("{HEAD}{ATOMS}{HEAD}{ATOMS}")).expect("two frames");
        assert_eq!((frames.len(), frames[0].step, frames[0].grains.len()), (2, 500, 1));
        let GrainSample { position, radius, velocity, force, id } = frames[0].grains[0];
        assert_eq!((position, velocity), (Vec3::new(0.25, 0.0, 0.125), Vec3::new(1.0, 0.0, 2.0)));
        // A contact force of (3, 4): LAMMPS adds the weight of 5 N.
        assert_eq!((radius, force, id), (0.01, 5.0, 0));
    }

    #[test]
    fn a_frame_that_is_cut_is_left_out_and_nonsense_is_refused_with_its_line() {
        let cut = format!("{HEAD}{ATOMS}{HEAD}{}", &ATOMS[..ATOMS.len() - 3]);
        assert_eq!(frames(&cut).expect("one frame").len(), 1);
        let strange = HEAD.to_owned() + &ATOMS.replace("0.125", "deep");
        let why = frames(&strange).err().expect("no number").to_string();
        assert!(why.contains("line 12: not the numbers of an atom"), "{why}");
        let why = frames(&HEAD.replace("mass", "mux")).err().expect("no mass").to_string();
        assert!(why.contains("lack a column"), "{why}");
    }
}
