//! `plunge report`, and the reports that other commands leave beside their results.

use std::path::{Path, PathBuf};

use exchange::run_files::RunFiles;
use reports::run::{Course, Seen};
use reports::{FILE, ReportError};
use runner::run::{ListSummary, Summary};
use serde_json::json;

use crate::output::{self, CommandError, CommandResult};
use crate::workbench::write_whole;

/// Arguments of `plunge report`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The folder of a run, of a list of runs, of a campaign, of a comparison, of a diagnosis or of a
    /// validation. Or the log of a run. A run that goes on has a page of its own, as far as it has come.
    folder: PathBuf,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Print nothing on success.
    #[arg(long)]
    quiet: bool,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let page = reports::of_folder(&args.folder).map_err(CommandError::bad_input)?;
    let file = RunFiles::so_far(&args.folder).report;
    write_whole(&file, &page)?;
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&json!({ "report": file.display().to_string() })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&format!("{} written\n", file.display())),
    }
}

/// Leaves the report of the run `summary` in its `folder`, unless it has one, and gives the course of
/// the run if its log can be read. A report that cannot be made is told, and fails nothing.
pub(crate) fn of_run(folder: &Path, summary: &Summary, quiet: bool) -> Option<Course> {
    let course = match Course::read(folder) {
        Ok(course) => course,
        Err(error) => {
            tell(folder, &error, quiet);
            return None;
        }
    };
    let page = || {
        let seen = Seen::read(folder, summary, &course);
        reports::run::page(summary, &course, &seen)
    };
    leave(folder, page, quiet);
    Some(course)
}

/// Likewise of a list of runs, and of each of them.
pub(crate) fn of_list(folder: &Path, summary: &ListSummary, quiet: bool) {
    for (index, run) in summary.runs.iter().enumerate() {
        let member = folder.join(format!("{:03}", index + 1));
        if !member.join(FILE).exists() {
            of_run(&member, run, quiet);
        }
    }
    leave(folder, || reports::of_list(summary), quiet);
}

/// The page of the results in `files`, as one more of them; one that cannot be made is told.
pub(crate) fn of_results(files: &[(String, String)], quiet: bool) -> Option<(String, String)> {
    match reports::of_texts(&files.iter().cloned().collect())? {
        Ok(page) => Some((FILE.to_owned(), page)),
        Err(error) => {
            tell(Path::new(""), &error, quiet);
            None
        }
    }
}

fn leave(folder: &Path, page: impl FnOnce() -> Result<String, ReportError>, quiet: bool) {
    let file = folder.join(FILE);
    if file.exists() {
        return;
    }
    match page() {
        Ok(page) => {
            if let Err(CommandError::Failed(error)) = write_whole(&file, &page) {
                tell(folder, &error, quiet);
            }
        }
        Err(error) => tell(folder, &error, quiet),
    }
}

fn tell(folder: &Path, why: &dyn std::fmt::Display, quiet: bool) {
    if !quiet {
        let text = format!("{}: {why}", folder.join(FILE).display());
        output::to_stderr(&format!("warning: {}\n", configs::printable(&text)));
    }
}
