//! `cargo xtask three-shapes`: cylinder, hemisphere and cone on beds of our own.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use lexopt::Parser;
use lexopt::prelude::{Long, Short, ValueExt};
use runner::{Elsewhere, Unattended};
use validation::command::{conclude, on};
use validation::three_shapes::{Places, cases, depths, frictions, have_done, run, table};

const HELP: &str = "\
Cylinder, hemisphere and cone at equal mass, radius and speed; and the hemisphere without and with friction.

Usage: cargo xtask three-shapes [--seeds N] [--threads N] [--on WHERE] [--out DIR] [--cache DIR] [--write]

  --seeds N    beds per condition (3)
  --threads N  impacts at a time (one per core)
  --on WHERE   where impacts are run: local (default), slurm or hyperqueue, which are waited for
  --out DIR    where results are kept (runs/three-shapes); those that are there are not run again
  --cache DIR  where prepared beds are kept (runs/.cache)
  --write      the table to docs/three-shapes.md below its mark, the pictures beside it

Exit status: 0 done, 1 failed, 2 the command line was not understood.
";

/// Everything below this line of the document is written by the program.
const MARK: &str = "<!-- written by cargo xtask three-shapes --write -->";

struct Wish {
    seeds: u64,
    threads: usize,
    elsewhere: Option<Elsewhere>,
    places: Places,
    write: bool,
}

fn main() -> ExitCode {
    conclude(HELP, parse, study)
}

/// `None` for help.
fn parse(mut parser: Parser) -> Result<Option<Wish>, lexopt::Error> {
    let mut wish = Wish {
        seeds: 3,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        elsewhere: None,
        places: Places { out: "runs/three-shapes".into(), cache: "runs/.cache".into() },
        write: false,
    };
    while let Some(argument) = parser.next()? {
        match argument {
            Long("seeds") => wish.seeds = parser.value()?.parse()?,
            Long("threads") => wish.threads = parser.value()?.parse()?,
            Long("on") => wish.elsewhere = on(&mut parser)?,
            Long("out") => wish.places.out = PathBuf::from(parser.value()?),
            Long("cache") => wish.places.cache = PathBuf::from(parser.value()?),
            Long("write") => wish.write = true,
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    Ok(Some(wish))
}

fn study(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let cases = cases(wish.seeds);
    if let Some(elsewhere) = &wish.elsewhere {
        have_done(&cases, &wish.places, elsewhere, &Unattended)?;
    }
    let outcomes = run(&cases, &wish.places, wish.threads, &|case, outcome| {
        eprintln!(
            "{}: {:.1} mm, closure {:.1e}",
            case.name(),
            1e3 * outcome.depth_m,
            outcome.closure
        );
    })?;
    let results: Vec<_> = cases.into_iter().zip(outcomes).collect();
    let text = table(&results);
    write!(out, "{text}")?;
    if wish.write {
        let path = Path::new("docs/three-shapes.md");
        let before = fs::read_to_string(path)?;
        let (kept, _) = before.split_once(MARK).ok_or("docs/three-shapes.md has lost its mark")?;
        fs::write(path, format!("{kept}{MARK}\n\n{text}"))?;
        fs::write("docs/three-shapes-depth.svg", depths(&results)?)?;
        fs::write("docs/three-shapes-friction.svg", frictions(&results)?)?;
    }
    Ok(ExitCode::SUCCESS)
}
