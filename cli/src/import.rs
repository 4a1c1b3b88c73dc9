//! `plunge import`: what LAMMPS made of an exported impact, as the log of a run.

use std::path::{Path, PathBuf};

use exchange::lammps::{ImportError, Imported, import};
use exchange::run_files::{RunFiles, is_log};
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;
use crate::table_file;

/// Arguments of `plunge import`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The folder that `plunge export MODEL --to lammps` wrote, and in which LAMMPS has run.
    folder: PathBuf,
    /// The log to write, or a folder for it; grains and summary go beside it. Without it, into FOLDER.
    #[arg(short, long, value_name = "RUN.mcap")]
    out: Option<PathBuf>,
    /// Replace a log that is there.
    #[arg(long)]
    force: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Say nothing when it went well.
    #[arg(long)]
    quiet: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    table_file::refuse(&args.folder)?;
    if args.folder.is_file() {
        return Err(CommandError::bad_input(format!(
            "{} is a file; the folder that `plunge export MODEL --to lammps` wrote is expected",
            args.folder.display()
        )));
    }
    let out = args.out.as_ref().unwrap_or(&args.folder);
    let files = RunFiles::of(out);
    if !args.force && files.log.exists() {
        let log = files.log.display();
        return Err(CommandError::bad_input(format!(
            "{log} is there already; --force replaces it"
        )));
    }
    let folder = if is_log(out) { out.parent() } else { Some(out.as_path()) };
    if let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) {
        make(folder)?;
    }
    signals::will_be_asked_for();
    let imported = import(&args.folder, &files.log, &signals::is_asked_to_stop).map_err(failed)?;
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
