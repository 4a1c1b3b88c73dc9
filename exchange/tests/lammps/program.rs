//! LAMMPS itself.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;

use exchange::lammps::INPUT;

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
