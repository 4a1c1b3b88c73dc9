//! What the programs of this crate have in common: a command line, words on stdout, an exit status.

use std::error::Error;
use std::io::{self, Write};
use std::num::NonZero;
use std::path::Path;
use std::process::ExitCode;

use clap::{Args, Parser};
use runner::beds::BedTask;
use runner::schedulers::Scheduler;
use runner::{CampaignError, Elsewhere, Task, WORD, work};
use serde::{Deserialize, Serialize};

use crate::three_shapes::ShapeTask;

/// What the status of a program of this crate means.
pub const STATUS: &str = "Exit status: 0 done, 1 failed, 2 the command line was not understood.";

/// How impacts of a study are run.
#[derive(Args, Debug)]
pub struct Impacts {
    /// Impacts at a time (one per core)
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZero<usize>>,
    /// Where impacts are run: local (default), slurm or hyperqueue, which are waited for
    #[arg(long, value_name = "WHERE", default_value = "local", hide_default_value = true, value_parser = on)]
    on: On,
}

/// Who runs impacts, if not this process.
#[derive(Clone, Debug)]
struct On(Option<Elsewhere>);

impl Impacts {
    /// Who runs them, if not this process.
    pub fn elsewhere(&self) -> Option<&Elsewhere> {
        self.on.0.as_ref()
    }
}

fn on(word: &str) -> Result<On, String> {
    let elsewhere = Scheduler::after_on(word)?.map(Elsewhere::by).transpose();
    elsewhere.map(On).map_err(|error| format!("this program cannot be found: {error}"))
}

/// Does what the command line asks for, and gives the status to end with.
///
/// `work` writes what it has found to stdout, and decides on the status. If it fails, the status is 1 and why stands
/// on stderr. Where the command line asks for help, or is not understood, the process ends here.
pub fn conclude<W: Parser>(
    work: impl FnOnce(&W, &mut dyn Write) -> Result<ExitCode, Box<dyn Error>>,
) -> ExitCode {
    task().unwrap_or_else(|| answer(&W::parse(), work, [&mut io::stdout(), &mut io::stderr()]))
}

/// What a scheduler calls a program of this crate for.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
enum StudyTask {
    Bed(BedTask),
    Shape(ShapeTask),
}

impl Task for StudyTask {
    fn run(&self, cache: &Path) -> Result<(), CampaignError> {
        match self {
            Self::Bed(task) => task.run(cache),
            Self::Shape(task) => task.run(cache),
        }
    }
}

/// Does the one task that a scheduler called this program for, if one did: the word for it, a list, a cache
/// and a number. Gives the status to end with.
pub fn task() -> Option<ExitCode> {
    let mut words = std::env::args_os().skip(1);
    if words.next()? != WORD {
        return None;
    }
    let (list, cache, number) = (words.next()?, words.next()?, words.next()?);
    let done = match number.to_str().and_then(|number| number.parse().ok()) {
        Some(number) => {
            work::<StudyTask>(list.as_ref(), cache.as_ref(), number).map_err(|e| e.to_string())
        }
        None => Err(format!("`{}` is no number of a task", number.display())),
    };
    Some(match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    })
}

fn answer<W>(
    wish: &W,
    work: impl FnOnce(&W, &mut dyn Write) -> Result<ExitCode, Box<dyn Error>>,
    [out, faults]: [&mut dyn Write; 2],
) -> ExitCode {
    work(wish, out).unwrap_or_else(|error| {
        // There is nobody left to tell that stderr is gone.
        drop(writeln!(faults, "error: {error}"));
        ExitCode::FAILURE
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    type Done = Result<ExitCode, Box<dyn Error>>;

    /// What is said on stdout and stderr, and the status.
    fn told(work: fn(&u8, &mut dyn Write) -> Done) -> [String; 3] {
        let (mut out, mut faults) = (Vec::new(), Vec::new());
        let status = answer(&7, work, [&mut out, &mut faults]);
        let text = |bytes| String::from_utf8(bytes).expect("text");
        [text(out), text(faults), format!("{status:?}")]
    }

    #[test]
    fn every_end_has_its_status_and_its_stream() {
        let works = |wish: &u8, out: &mut dyn Write| -> Done {
            write!(out, "{wish}")?;
            Ok(ExitCode::SUCCESS)
        };
        let fails = |_: &u8, _: &mut dyn Write| -> Done { Err("no bed".into()) };
        let status = |code: u8| format!("{:?}", ExitCode::from(code));
        assert_eq!(told(works), ["7".into(), String::new(), status(0)]);
        assert_eq!(told(fails), [String::new(), "error: no bed\n".into(), status(1)]);
    }

    #[test]
    fn a_place_that_is_none_is_not_understood() {
        assert!(on("local").is_ok_and(|on| on.0.is_none()));
        assert!(on("slurm").is_ok_and(|on| on.0.is_some()));
        assert!(on("moon").is_err_and(|error| error.contains("moon")));
    }
}
