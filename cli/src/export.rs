//! `plunge export`: a run as files of other programs.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::PossibleValue;
use exchange::export::{ExportError, Exported, Format, export};
use exchange::read::ReadError;
use serde_json::json;

use crate::output::{self, CommandError, CommandResult};

/// Arguments of `plunge export`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The folder of a run, or one of its logs.
    run: PathBuf,
    /// The format.
    #[arg(long, value_name = "FORMAT")]
    to: To,
    /// The folder to write to; without, one in the folder of the run, called like the format.
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write into a folder that holds files already.
    #[arg(long)]
    force: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Say nothing when it went well.
    #[arg(long)]
    quiet: bool,
}

/// A format as an argument.
#[derive(Clone, Copy, Debug)]
pub(crate) struct To(Format);

impl ValueEnum for To {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [To; Format::ALL.len()] = {
            let mut all = [To(Format::Csv); Format::ALL.len()];
            let mut at = 0;
            while at < all.len() {
                all[at] = To(Format::ALL[at]);
                at += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let value = PossibleValue::new(self.0.name()).help(self.0.purpose());
        Some(match self.0 {
            Format::Vtp => value.alias("vtk"),
            Format::ExtendedXyz => value.alias("xyz"),
            _ => value,
        })
    }
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let To(format) = args.to;
    let out = args.out.clone().unwrap_or_else(|| beside(&args.run).join(format.name()));
    let is_occupied = std::fs::read_dir(&out).is_ok_and(|mut entries| entries.next().is_some());
    if is_occupied && !args.force {
        return Err(CommandError::bad_input(format!(
            "{} holds files already; choose another --out, or --force to write there",
            out.display()
        )));
    }
    let Exported { files, complete } = export(&args.run, format, &out).map_err(failed)?;
    if !complete && !args.quiet {
        output::to_stderr("warning: the log is cut; the export goes as far as it does\n");
    }
    let shown: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    match (args.json, args.quiet) {
        (true, _) => output::json_to_stdout(&json!({
            "format": format.name(),
            "files": shown,
            "complete": complete,
        })),
        (false, true) => Ok(()),
        (false, false) => output::to_stdout(&as_text(&shown)),
    }
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
        ExportError::Write { .. } | ExportError::Read(ReadError::Damaged { .. }) => {
            CommandError::Failed(error.into())
        }
        error => CommandError::bad_input(error),
    }
}
