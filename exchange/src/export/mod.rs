//! Runs as files of other programs: tables for notebooks, grains for ParaView and OVITO.
//!
//! A [`Format`] is one file of this folder: tables of numbers go through `tables.rs`, states of grains
//! through `grains.rs`. An export is written into a folder inside the one it
//! goes to ([`Staging`]), and its files are moved there once all of them are whole.

mod csv;
mod error;
mod extended_xyz;
mod grains;
mod lammps_dump;
pub(crate) mod parquet;
mod tables;
mod vtp;
pub(crate) mod whole_file;

use std::fs;
use std::path::{Path, PathBuf};

use engine::record::{GRAIN_LOG, RUN_LOG};

use crate::Stop;
use crate::run_files::RunFiles;
use crate::staging::{STAGING, Staging};

pub use error::ExportError;

/// What a run can be exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated tables, one per topic of scalars.
    Csv,
    /// The same as Apache Parquet.
    Parquet,
    /// VTK poly data of grains and bodies, files for every frame, with ParaView indices over time.
    Vtp,
    /// A LAMMPS dump of all frames.
    LammpsDump,
    /// Extended XYZ of all frames.
    ExtendedXyz,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Csv, Self::Parquet, Self::Vtp, Self::LammpsDump, Self::ExtendedXyz];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
            Self::Vtp => "vtp",
            Self::LammpsDump => "lammps-dump",
            Self::ExtendedXyz => "extxyz",
        }
    }

    /// What it is for, in a few words.
    #[must_use]
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Csv => "tables of energies, states and loads, as text",
            Self::Parquet => "the same tables, smaller and read faster",
            Self::Vtp => "grains and bodies for ParaView: open both .pvd",
            Self::LammpsDump => "grains and bodies as particles, for OVITO and tools of LAMMPS",
            Self::ExtendedXyz => "grains and bodies as particles, for OVITO and ASE",
        }
    }
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    /// The files, in the order in which they were finished.
    pub files: Vec<PathBuf>,
    /// Whether the log is finished; one that is not ends with its last whole chunk.
    pub complete: bool,
}

/// Writes `run`, a log or the folder of a run, as `format` into the folder `out`, which is made if it is
/// not there. The same log gives the same bytes. An export that fails or is stopped leaves no file in `out`.
///
/// # Errors
/// If the log cannot be read or has nothing of what the format holds, a file cannot be written, or `stop`
/// says so between two messages of the log.
pub fn export(
    run: &Path,
    format: Format,
    out: &Path,
    stop: Stop<'_>,
) -> Result<Exported, ExportError> {
    let of_grains = match format {
        Format::Csv | Format::Parquet => false,
        Format::Vtp | Format::LammpsDump | Format::ExtendedXyz => true,
    };
    let files = RunFiles::so_far(run);
    let (log, path) = match of_grains {
        true => (GRAIN_LOG, files.grains),
        false => (RUN_LOG, files.log),
    };
    // A log of grains may be named itself.
    let path = if path.is_file() || run.is_dir() { path } else { run.to_owned() };
    if !path.is_file() {
        return Err(ExportError::NoRun { path: run.to_owned(), log });
    }
    let is_new = !out.exists();
    let refused = |path: &Path, source| ExportError::Write { path: path.to_owned(), source };
    let staging = Staging::at(out.join(STAGING)).map_err(|source| refused(out, source))?;
    let Exported { files, complete } =
        written(format, &path, staging.path(), stop).inspect_err(|_| {
            let _ = fs::remove_dir_all(staging.path());
            if is_new {
                // Fails where somebody else has put a file there meanwhile, which is as it should be.
                let _ = fs::remove_dir(out);
            }
        })?;
    let moved = files.iter().map(|file| {
        let to = out.join(file.file_name().unwrap_or_default());
        match fs::rename(file, &to) {
            Ok(()) => Ok(to),
            Err(source) => Err(refused(&to, source)),
        }
    });
    Ok(Exported { files: moved.collect::<Result<_, _>>()?, complete })
}

/// Writes the log at `path` as files of `format` in the folder `here`.
fn written(
    format: Format,
    path: &Path,
    here: &Path,
    stop: Stop<'_>,
) -> Result<Exported, ExportError> {
    let text =
        |name, write| grains::export(path, grains::Text::create(here.join(name), write)?, stop);
    match format {
        Format::Csv => tables::export(path, (here, csv::Csv::create), stop),
        Format::Parquet => tables::export(path, (here, parquet::Parquet::create), stop),
        Format::Vtp => grains::export(path, vtp::Vtp::new(here), stop),
        Format::LammpsDump => text("grains.dump", lammps_dump::write),
        Format::ExtendedXyz => text("grains.xyz", extended_xyz::write),
    }
}
