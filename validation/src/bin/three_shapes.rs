//! `cargo xtask three-shapes`: cylinder, hemisphere and cone on beds of our own.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use lexopt::Parser;
use lexopt::prelude::{Long, Short, ValueExt};
use runner::{Elsewhere, Unattended};
use validation::command::{conclude, on};
use validation::three_shapes::{Places, cases, depths, frictions, have_done, run, table};

const HELP: &str = "\
Cylinder, hemisphere and cone at equal mass, radius and speed; and the hemisphere without and with friction.

Usage: cargo xtask three-shapes [--seeds N] [--threads N] [--on WHERE] [--out DIR] [--cache DIR]

  --seeds N    beds per condition (3)
  --threads N  impacts at a time (one per core)
  --on WHERE   where impacts are run: local (default), slurm or hyperqueue, which are waited for
  --out DIR    folder of results and pictures (runs/three-shapes); finished impacts are not run again
  --cache DIR  where prepared beds are kept (runs/.cache)

Exit status: 0 done, 1 failed, 2 the command line was not understood.
";

struct Wish {
    seeds: u64,
    threads: usize,
    elsewhere: Option<Elsewhere>,
    places: Places,
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
    };
    while let Some(argument) = parser.next()? {
        match argument {
            Long("seeds") => wish.seeds = parser.value()?.parse()?,
            Long("threads") => wish.threads = parser.value()?.parse()?,
            Long("on") => wish.elsewhere = on(&mut parser)?,
            Long("out") => wish.places.out = PathBuf::from(parser.value()?),
            Long("cache") => wish.places.cache = PathBuf::from(parser.value()?),
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
    for (name, picture) in
        [("depth.svg", depths(&results)?), ("friction.svg", frictions(&results)?)]
    {
        fs::write(wish.places.out.join(name), picture)?;
    }
    Ok(ExitCode::SUCCESS)
}
