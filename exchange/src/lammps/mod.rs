//! An impact on a bed of grains, written for LAMMPS: the way out when a bed outgrows one machine, and
//! a second opinion on a small one.
//!
//! [`Deck::of`] gives three files: [`DATA`] with the grains and the intruder as they stand at first
//! contact, [`INPUT`], which runs them under the same law, walls, gravity and step, and [`FACTS`], by which
//! [`import`] makes a log of what LAMMPS writes. What LAMMPS cannot express is refused by name
//! ([`LammpsError::Inexpressible`]) and never left out.
//!
//! Two things differ, and the input says so: a data file holds no contact histories, so every contact
//! starts without its tangential spring; and where a contact slides, LAMMPS keeps the viscous part of the
//! tangential force and lets the spring make up the rest, where plunge keeps the spring alone.
//!
//! An intruder that is no disc or sphere is a rigid clump of balls inside it, with the mass and the
//! inertia of the body, in a fourth file, [`BODY`]; the input says how far its surface is from that
//! of the body.

mod atom_type;
mod clump;
mod data;
mod dump;
mod facts;
mod import;
mod input;
mod intruder;
mod law;
mod refusal;
mod rigid;
mod samples;
#[cfg(test)]
mod tests;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use configs::{BuildError, GrainModel};
use engine::grain_bed::RestingBed;
use thiserror::Error;

use facts::Facts;
use intruder::Intruder;

pub use import::{ImportError, Imported, import};

/// Name of the input script.
pub const INPUT: &str = "in.impact";

/// Name of the file with grains and intruder.
pub const DATA: &str = "bed.data";

/// Name of the file with mass and inertia of an intruder that is a clump.
pub const BODY: &str = "body.data";

/// Name of the file with what LAMMPS has no use for and an import has.
pub const FACTS: &str = "impact.json";

/// Name of the table that LAMMPS writes of the intruder.
const INTRUDER_TABLE: &str = "intruder.csv";

/// Name of the dump that LAMMPS writes of all atoms.
const DUMP: &str = "grains.dump";

/// An impact as LAMMPS reads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Deck {
    /// Text of [`INPUT`].
    pub input: String,
    /// Text of [`DATA`].
    pub data: String,
    /// Text of [`BODY`], of an intruder that is no disc or sphere.
    pub body: Option<String>,
    /// Text of [`FACTS`].
    pub facts: String,
}

/// Why a model cannot be handed to LAMMPS.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum LammpsError {
    #[error("LAMMPS cannot express {}", .0.join("; nor "))]
    Inexpressible(Vec<String>),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error("cannot write {}: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
}

impl Deck {
    /// Whether LAMMPS can express `model`, before its bed is prepared.
    ///
    /// # Errors
    /// If it cannot.
    pub fn check(model: GrainModel<'_>) -> Result<(), LammpsError> {
        refusal::checked(model, &model.model.conditions()).map(|_| ())
    }

    /// The impact of `model` on its bed `resting`.
    ///
    /// # Errors
    /// If LAMMPS cannot express it, or the model cannot be built.
    pub fn of(model: GrainModel<'_>, resting: &RestingBed) -> Result<Self, LammpsError> {
        let conditions = model.model.conditions();
        let law = refusal::checked(model, &conditions)?;
        let simulation = model.simulation(resting, &conditions[0])?;
        let intruder = Intruder::of(model, &simulation, &law);
        let contacts = law.contacts(&intruder.stiffness);
        let facts = Facts::of(model, resting, &conditions[0], &simulation);
        let is_clump = intruder.clump.is_some();
        Ok(Self {
            facts: format!("{:#}\n", serde_json::json!(facts)),
            input: input::text(model, &simulation, &contacts, &intruder),
            data: data::text(model, &simulation, &intruder),
            body: is_clump.then(|| rigid::text(&simulation, model.medium.space)),
        })
    }

    /// Names of its files, with their texts.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let body = self.body.as_ref().map(|text| (BODY, text));
        let files = [(INPUT, &self.input), (DATA, &self.data), (FACTS, &self.facts)];
        files.into_iter().chain(body).map(|(name, text)| (name, text.as_str()))
    }

    /// Writes its files into `folder`, which is made if it is missing.
    pub fn write(&self, folder: &Path) -> Result<(), LammpsError> {
        let io = |path: &Path| {
            let path = path.to_owned();
            |source| LammpsError::Io { path, source }
        };
        fs::create_dir_all(folder).map_err(io(folder))?;
        for (name, text) in self.files() {
            let path = folder.join(name);
            fs::write(&path, text).map_err(io(&path))?;
        }
        Ok(())
    }
}
