//! A run as files of other programs.

use std::path::Path;

use exchange::export::{ExportError, Exported, Format, export};
use exchange::read::ReadError;
use exchange::staging::STAGING;
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::common::Common;
use crate::control::stopped;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;

/// Writes `run`, the folder of a run or a log, in `format`.
pub(super) fn write(run: &Path, format: Format, common: &Common) -> CommandResult {
    let out = common.out.clone().unwrap_or_else(|| beside(run).join(format.name()));
    if is_occupied(&out) && !common.force {
        return Err(CommandError::bad_input(format!(
            "{} holds files already; choose another --out, or --force to write there",
            out.display()
        )));
    }
    signals::will_be_asked_for();
    let Exported { files, complete } =
        export(run, format, &out, &signals::is_asked_to_stop).map_err(failed)?;
    if !complete && !common.quiet {
        output::to_stderr("warning: the log is cut; the export goes as far as it does\n");
    }
    let shown: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    match (common.json, common.quiet) {
        (true, _) => output::json_to_stdout(&json!({
            "format": format.name(),
            "files": shown,
            "complete": complete,
        })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&as_text(&shown)),
    }
}

/// Whether `out` holds anything but what a killed export has left.
fn is_occupied(out: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(out) else { return false };
    entries.flatten().any(|entry| entry.file_name() != STAGING)
}

/// Most files that are listed one by one.
const MOST_LISTED: usize = 8;

fn as_text(files: &[String]) -> String {
    let (Some(last), n) = (files.last(), files.len()) else { return String::new() };
    if n <= MOST_LISTED {
        return files.iter().map(|file| format!("{file}\n")).collect();
    }
    format!("{}\n… {} more\n{last}\n", files[0], n - 2)
}

/// The folder of the run that `run`, a folder or a log, is of.
fn beside(run: &Path) -> &Path {
    if run.is_dir() { run } else { run.parent().unwrap_or(Path::new("")) }
}

/// What cannot be opened, and what is no log of the kind, is bad input.
fn failed(error: ExportError) -> CommandError {
    match error {
        ExportError::Stopped => stopped(BEGINS_AGAIN),
        ExportError::Write { .. } | ExportError::Read(ReadError::Damaged { .. }) => {
            CommandError::Failed(error.into())
        }
        error => CommandError::bad_input(error),
    }
}
