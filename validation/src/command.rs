//! What the programs of this crate have in common: a command line, words on stdout, an exit status.

use std::error::Error;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use lexopt::Parser;
use lexopt::prelude::ValueExt;
use runner::schedulers::Scheduler;

use runner::beds::BedTask;
use runner::{CampaignError, Elsewhere, Task, WORD, work};
use serde::{Deserialize, Serialize};

use crate::three_shapes::ShapeTask;

/// Status of a command line that is not understood.
const MISUNDERSTOOD: u8 = 2;

/// Does what the command line asks for, and gives the status to end with.
///
/// `parse` reads the command line; where it gives nothing, `help` is said. `work` does the rest: it writes what
/// it has found to stdout, and decides on the status. If it fails, the status is 1, and if the command line is
/// not understood, 2; why stands on stderr.
pub fn conclude<W>(
    help: &str,
    parse: impl FnOnce(Parser) -> Result<Option<W>, lexopt::Error>,
    work: impl FnOnce(&W, &mut dyn Write) -> Result<ExitCode, Box<dyn Error>>,
) -> ExitCode {
    if let Some(status) = task() {
        return status;
    }
    let streams: [&mut dyn Write; 2] = [&mut io::stdout(), &mut io::stderr()];
    answer(help, parse(Parser::from_env()), work, streams)
}

/// Who runs impacts after `--on`, if not this process.
///
/// # Errors
/// If the word is not known, or this program cannot be found.
pub fn on(parser: &mut Parser) -> Result<Option<Elsewhere>, lexopt::Error> {
    let scheduler = parser.value()?.parse_with(Scheduler::after_on)?;
    let elsewhere = scheduler.map(Elsewhere::by).transpose();
    elsewhere.map_err(|error| format!("this program cannot be found: {error}").into())
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
#[must_use]
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
    help: &str,
    parsed: Result<Option<W>, lexopt::Error>,
    work: impl FnOnce(&W, &mut dyn Write) -> Result<ExitCode, Box<dyn Error>>,
    [out, faults]: [&mut dyn Write; 2],
) -> ExitCode {
    let done = match parsed {
        Ok(Some(wish)) => work(&wish, out),
        Ok(None) => write!(out, "{help}").map(|()| ExitCode::SUCCESS).map_err(Into::into),
        Err(error) => {
            // There is nobody left to tell that stderr is gone.
            drop(write!(faults, "error: {error}\n\n{help}"));
            return ExitCode::from(MISUNDERSTOOD);
        }
    };
    done.unwrap_or_else(|error| {
        drop(writeln!(faults, "error: {error}"));
        ExitCode::FAILURE
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    type Done = Result<ExitCode, Box<dyn Error>>;

    /// What is said on stdout and stderr, and the status.
    fn told(
        parsed: Result<Option<u8>, lexopt::Error>,
        work: fn(&u8, &mut dyn Write) -> Done,
    ) -> [String; 3] {
        let (mut out, mut faults) = (Vec::new(), Vec::new());
        let status = answer("HELP\n", parsed, work, [&mut out, &mut faults]);
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
        assert_eq!(told(Ok(Some(7)), works), ["7".into(), String::new(), status(0)]);
        assert_eq!(told(Ok(None), works), ["HELP\n".into(), String::new(), status(0)]);
        assert_eq!(told(Ok(Some(7)), fails), [String::new(), "error: no bed\n".into(), status(1)]);
        let misunderstood = told(Err("what?".into()), works);
        assert_eq!(misunderstood, [String::new(), "error: what?\n\nHELP\n".into(), status(2)]);
    }
}
