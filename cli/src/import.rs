//! `plunge import`: what LAMMPS made of an exported impact, as the log of a run; tables of tracking programs,
//! as a measurement set, are in `import_tables`.

use std::path::Path;

use exchange::lammps::{FACTS, ImportError, Imported, import};
use exchange::run_files::{RunFiles, is_log};
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::import_args::Args;
use crate::import_tables;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;

pub(crate) fn run(args: &Args) -> CommandResult {
    match &args.files[..] {
        [folder] if folder.is_dir() && is_of_lammps(folder) => of_lammps(args, folder),
        _ => import_tables::run(args),
    }
}

/// Whether LAMMPS ran in `folder`, or nothing that could be a table is in it.
fn is_of_lammps(folder: &Path) -> bool {
    folder.join(FACTS).exists() || !exchange::tracking::has_tables(folder)
}

fn of_lammps(args: &Args, folder: &Path) -> CommandResult {
    let out = args.out.as_deref().unwrap_or(folder);
    let files = RunFiles::of(out);
    if !args.force && files.log.exists() {
        let log = files.log.display();
        return Err(CommandError::bad_input(format!(
            "{log} is there already; --force replaces it"
        )));
    }
    signals::will_be_asked_for();
    let around = if is_log(out) { out.parent() } else { Some(out) };
    if let Some(around) = around.filter(|around| !around.as_os_str().is_empty()) {
        make(around)?;
    }
    let imported = import(folder, &files.log, &signals::is_asked_to_stop).map_err(failed)?;
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&json!({
            "log": imported.files.log.to_string_lossy(),
            "grains": imported.files.grains.to_string_lossy(),
            "summary": imported.files.summary.to_string_lossy(),
            "samples": imported.samples,
            "frames": imported.frames,
        })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&as_text(&imported)),
    }
}

fn make(folder: &Path) -> CommandResult {
    std::fs::create_dir_all(folder).map_err(|source| {
        CommandError::bad_input(format!("cannot make {}: {source}", folder.display()))
    })
}

fn as_text(Imported { summary, files, samples, frames }: &Imported) -> String {
    let stop = match summary.stop.stopping_time_s {
        Some(time) => format!("stopped after {time:.5} s"),
        None => "still moving at the end".to_owned(),
    };
    format!(
        "{}: {samples} samples, {frames} frames of {} grains; {stop}, {:.3} mm deep\n{}\n",
        summary.name,
        summary.bed.as_ref().map_or(0, |bed| bed.grains),
        1e3 * summary.stop.depth_m,
        files.log.display()
    )
}

/// A log that cannot be written is a failure; everything else is the input's fault.
fn failed(error: ImportError) -> CommandError {
    match error {
        ImportError::Stopped => stopped(BEGINS_AGAIN),
        ImportError::Record(_) | ImportError::Io { doing: "write" | "make", .. } => {
            CommandError::Failed(error.into())
        }
        error => CommandError::bad_input(error),
    }
}
