//! The commands of plunge: they read arguments, call the libraries, and turn errors into messages and exit codes.
//!
//! [`main`] is the program. [`call`] is a command within another program, the [`Host`]: it prints to the host and is
//! stopped by it.

mod add;
mod after;
mod bed;
mod bed_changes;
mod beds;
mod check;
mod check_cost;
mod check_set;
mod common;
mod compare;
mod compare_runs;
mod completions;
mod control;
mod diagnose;
mod effects;
mod export;
mod host;
mod import;
mod import_args;
mod import_tables;
mod movie;
mod new;
mod next;
mod output;
mod own_effects;
mod recover;
mod report;
mod run;
mod signals;
mod sweep;
mod table_file;
mod task;
mod text;
mod verdict;
mod view;
mod workbench;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;

use clap::{CommandFactory, Parser, Subcommand};
use engine::parallel::with_threads;
use output::{CommandError, CommandResult};

pub use engine::grains::Grain;
pub use host::{Host, Progress};
pub use output::Failure;

/// Impacts on granular beds: simulate them, compare them with measurements, find what is missing.
#[derive(Debug, Parser)]
#[command(name = "plunge", version, about, propagate_version = true, max_term_width = 100, after_help = START)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// What the commands are for, and where to begin.
const START: &str = "\
Start here:
  plunge run two-term-vector         an impact, and a page of it
  plunge new --list                  models and sets to start from
  plunge import drop*.csv -o drops   a measurement set of your own tables

Simulate:                  new, check, bed, run, sweep, effects
See and convert:           report, movie, view, export, recover
Compare with measurements: import, check, compare, diagnose, add

plunge COMMAND --help has an example of each.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the impacts of a model.
    #[command(after_help = "Example: plunge run vertical-2d --set 'impact.speed=\"3 m/s\"'")]
    Run(run::Args),
    /// Prepare the bed of a model into the cache.
    #[command(after_help = "Example: plunge bed vertical-2d")]
    Bed(bed::Args),
    /// Validate a model, or a measurement set, and show what it means in SI, without running it.
    #[command(after_help = "Example: plunge check my-model.toml")]
    Check(check::Args),
    /// Compare models with measurements: errors, and where the force is wrong. Or compare two runs.
    #[command(
        after_help = "Example: plunge compare drops --model two-term-vector --model poncelet"
    )]
    Compare(compare::Args),
    /// Find out which physical effect a model lacks.
    #[command(after_help = "Example: plunge diagnose drops")]
    Diagnose(diagnose::Args),
    /// Add an effect to a model, with fitted values and all comments kept.
    #[command(
        after_help = "Example: plunge add two-term-vector --from runs/drops-diagnose/diagnosis.json -o better.toml"
    )]
    Add(add::Args),
    /// Describe the laws and effects that a model can use.
    #[command(after_help = "Example: plunge effects yield-stress")]
    Effects(effects::Args),
    /// Write what comes with plunge here: commented models, measurement sets, files to fill in, layouts, schemas.
    #[command(after_help = "Example: plunge new measurements")]
    New(new::Args),
    /// Run a campaign: many models, seeds and settings side by side, each once.
    #[command(after_help = "Example: plunge sweep campaign.toml")]
    Sweep(sweep::Args),
    /// Make the HTML report of a run, a list of runs, a campaign, a comparison or a diagnosis again.
    #[command(after_help = "Example: plunge report runs/vertical-2d")]
    Report(report::Args),
    /// Make a film of an impact, or pictures at single times.
    #[command(
        after_help = "Example: plunge movie runs/vertical-2d -o impact.gif\n         plunge movie runs/vertical-2d -o impact.svg --at contact,greatest,20ms"
    )]
    Movie(movie::Args),
    /// Write a run or an impact as files of other programs: tables, grains for viewers, a LAMMPS input.
    #[command(after_help = "Example: plunge export runs/vertical-2d --to parquet")]
    Export(export::Args),
    /// Make a measurement set of tables of tracking programs; or a log of a run of LAMMPS.
    #[command(
        after_help = "Example: plunge import drop1.csv drop2.csv -o drops --diameter 25.4mm --mass 67g"
    )]
    Import(Box<import_args::Args>),
    /// Save everything readable of a damaged or unfinished log.
    #[command(after_help = "Example: plunge recover run.mcap.partial saved.mcap")]
    Recover(recover::Args),
    /// Serve a log to viewers in a browser, and say how to open it in the others.
    #[command(after_help = "Example: plunge view runs/vertical-2d")]
    View(view::Args),
    /// Do one task of a list: what a scheduler calls this program for.
    #[command(hide = true)]
    Task(task::Args),
    /// Print a completion script for a shell.
    #[command(after_help = "Example: plunge completions bash > plunge.bash")]
    Completions(completions::CompletionArgs),
    /// Write manual pages.
    #[command(after_help = "Example: plunge man man-pages")]
    Man(completions::ManArgs),
}

/// The program: the command that its arguments name, stopped by signals.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) => {
            // A closed pipe is no reason to fail: there is nobody left to tell.
            let _ = usage.print();
            return ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2));
        }
    };
    let result = signals::listen(cli.command.if_stopped()).map_err(Into::into);
    output::conclude(result.and_then(|()| cli.command.run()))
}

/// Does the command that `words` name, without the name of the program, for `host`; gives what it prints.
///
/// # Errors
/// What the program would say in its place, with its exit status.
pub fn call(host: &Arc<Host>, words: &[OsString]) -> Result<String, Failure> {
    let command: Cli = understood("plunge", words)?;
    within(host, || command.command.run())?;
    Ok(host.take_printed())
}

/// `plunge run` with `words`, once for each of `variants`, which are further values of its `--set`: side by side,
/// `--threads` at a time and each on one thread, into the folders `001`, `002` … of `--out`. No run begins before
/// all models have been read. Gives the summaries; reports are not made.
///
/// # Errors
/// As [`call`]; the first of any variant in their order.
pub fn run_many(
    host: &Arc<Host>,
    words: &[OsString],
    variants: &[Vec<String>],
) -> Result<Vec<serde_json::Value>, Failure> {
    let Words { args } = understood::<Words<run::Args>>("plunge run", words)?;
    within(host, || run::many(&args, variants))
}

/// `plunge bed` with `words`: what it prints, and the grains at rest.
///
/// # Errors
/// As [`call`].
pub fn bed(host: &Arc<Host>, words: &[OsString]) -> Result<(String, Vec<Grain>), Failure> {
    let Words { args } = understood::<Words<bed::Args>>("plunge bed", words)?;
    let bed = within(host, || bed::prepared(&args))?;
    Ok((host.take_printed(), bed.grains))
}

/// Does `work` for `host`, on a pool of its own: a process that was forked has lost the threads of the shared one.
fn within<R: Send>(
    host: &Arc<Host>,
    work: impl FnOnce() -> Result<R, CommandError> + Send,
) -> Result<R, Failure> {
    let done = with_threads(0, || host.during(work)).map_err(anyhow::Error::new);
    Ok(done.map_err(CommandError::from).flatten()?)
}

/// Arguments of one command, without its name.
#[derive(Debug, Parser)]
struct Words<A: clap::Args> {
    #[command(flatten)]
    args: A,
}

fn understood<P: Parser>(program: &str, words: &[OsString]) -> Result<P, Failure> {
    let line = std::iter::once(OsString::from(program)).chain(words.iter().cloned());
    P::try_parse_from(line).map_err(|usage| Failure::usage(&usage))
}

impl Command {
    fn run(self) -> CommandResult {
        match self {
            Self::Run(args) => run::run(&args),
            Self::Bed(args) => bed::run(&args),
            Self::Check(args) => check::run(&args),
            Self::Compare(args) => compare::run(&args),
            Self::Diagnose(args) => diagnose::run(&args),
            Self::Add(args) => add::run(&args),
            Self::Effects(args) => effects::run(&args),
            Self::New(args) => new::run(&args),
            Self::Sweep(args) => sweep::run(&args),
            Self::Report(args) => report::run(&args),
            Self::Movie(args) => movie::run(&args),
            Self::Export(args) => export::run(&args),
            Self::Import(args) => import::run(&args),
            Self::Recover(args) => recover::run(&args),
            Self::View(args) => view::run(&args),
            Self::Task(args) => task::run(&args),
            Self::Completions(args) => completions::completions(&args, Cli::command()),
            Self::Man(args) => completions::man(&args, Cli::command()),
        }
    }

    /// What is left of a command that a signal has ended, and how to go on.
    fn if_stopped(&self) -> &'static str {
        match self {
            Self::Run(_) => "--resume goes on from the last checkpoint",
            Self::Bed(_) | Self::Sweep(_) | Self::Task(_) => {
                "what has ended is kept; the same command goes on"
            }
            Self::Compare(_) | Self::Diagnose(_) => {
                "impacts that have ended are kept; the same command goes on"
            }
            Self::View(_) => "nothing is served any more",
            Self::Check(_)
            | Self::Add(_)
            | Self::Effects(_)
            | Self::New(_)
            | Self::Report(_)
            | Self::Movie(_)
            | Self::Export(_)
            | Self::Import(_)
            | Self::Recover(_)
            | Self::Completions(_)
            | Self::Man(_) => BEGINS_AGAIN,
        }
    }
}

/// What a command says that keeps nothing when a signal ends it.
pub(crate) const BEGINS_AGAIN: &str = "nothing of it is kept; the same command begins again";
