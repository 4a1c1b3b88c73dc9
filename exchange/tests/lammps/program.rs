//! LAMMPS itself.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;

use configs::Loaded;
use engine::simulation::Simulation;
use exchange::lammps::{Deck, INPUT};

/// Writes the deck of the impact of `loaded` to `folder` and runs it for so many `steps` on so many `ranks`, and says what LAMMPS
/// says.
pub(crate) fn in_lammps(folder: &Path, loaded: &Loaded, ranks: usize, steps: u64) -> String {
    let grains = loaded.model.grains().expect("a bed");
    let resting = grains.read_bed().expect("a table");
    let deck = Deck::of(grains, &resting).expect("a model that LAMMPS can express");
    deck.write(folder).expect("it can be written");
    lammps(folder, ranks, steps)
}

/// The same impact in plunge, after so many `steps`.
pub(crate) fn in_plunge(loaded: &Loaded, steps: u64) -> Simulation {
    let grains = loaded.model.grains().expect("a bed");
    let resting = grains.read_bed().expect("a table");
    let condition = loaded.model.conditions()[0];
    let mut simulation = grains.simulation(&resting, &condition).expect("a simulation");
    for _ in 0..steps {
        simulation.advance().expect("a step");
    }
    simulation
}

/// Runs the deck in `folder` for so many `steps` on so many `ranks`, and says what LAMMPS says.
pub(crate) fn lammps(folder: &Path, ranks: usize, steps: u64) -> String {
    let program = program();
    let mut command = match ranks {
        1 => Command::new(&program),
        _ => {
            // The wheel brings the starter of its own MPI; another one would start separate runs.
            let beside = Path::new(&program).with_file_name("mpirun");
            let starter = if beside.is_file() { beside.into() } else { OsString::from("mpirun") };
            let mut command = Command::new(starter);
            command.arg("-np").arg(ranks.to_string()).arg(&program);
            command
        }
    };
    command.current_dir(folder).args(["-in", INPUT, "-log", "log.lammps", "-var", "steps"]);
    let output = command.arg(steps.to_string()).output().expect("PLUNGE_LAMMPS names a program");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    said
}

/// The program, so named that it is found from another folder too.
fn program() -> OsString {
    let named = std::env::var_os("PLUNGE_LAMMPS").expect("PLUNGE_LAMMPS names an lmp");
    let is_bare = Path::new(&named).file_name() == Some(OsStr::new(&named));
    if is_bare { named } else { std::path::absolute(&named).expect("a path").into() }
}
