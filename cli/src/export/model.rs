//! An impact on a bed, written for another simulator.

use std::path::{Path, PathBuf};

use exchange::lammps::{Deck, INPUT, LammpsError};
use serde_json::json;

use crate::common::Common;
use crate::control::Terminal;
use crate::output::{self, CommandError, CommandResult};

/// Writes the impact of `model` as an input of LAMMPS.
pub(super) fn write(model: &Path, common: &Common) -> CommandResult {
    let model = common.load(model)?.model;
    let grains = model.grains().ok_or_else(|| {
        let kind = model.medium.kind();
        CommandError::bad_input(format!("LAMMPS cannot express a medium of the kind \"{kind}\""))
    })?;
    Deck::check(grains).map_err(refused)?;
    let bed = common.prepared(grains, &mut Terminal::new(common.quiet))?;
    let deck = Deck::of(grains, &bed.resting).map_err(refused)?;
    let folder = common
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("runs").join(format!("{}-lammps", model.run.name)));
    deck.write(&folder).map_err(refused)?;
    let files: Vec<&str> = deck.files().map(|(name, _)| name).collect();
    if common.json {
        // Not the paths themselves: one that is not UTF-8 cannot be encoded.
        return output::json_to_stdout(&json!({
            "folder": folder.to_string_lossy(),
            "files": files,
            "grains": bed.resting.grains.len(),
        }));
    }
    let folder = folder.display();
    output::to_stdout(&format!(
        "{folder}: {}\nrun lmp -in {INPUT} there, or mpirun -np N lmp -in {INPUT}, \
         then: plunge import {folder} -o RUN.mcap\n",
        files.join(", ")
    ))
}

fn refused(error: LammpsError) -> CommandError {
    match error {
        LammpsError::Io { .. } => CommandError::Failed(error.into()),
        LammpsError::Inexpressible(_) | LammpsError::Build(_) => CommandError::bad_input(error),
    }
}
