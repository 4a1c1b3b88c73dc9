//! `cargo xtask fuzz`: changed files against every reader, for so many minutes each.

mod hunt;

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use fuzz::{TARGETS, Target, seeds};
use lexopt::Parser;
use lexopt::prelude::{Long, Short, Value, ValueExt};

use hunt::{Hunt, Tally};
use validation::command::conclude;

const HELP: &str = "\
Changed files against every reader of plunge: models, formulas, sets, logs, checkpoints.

Usage: cargo xtask fuzz [TARGET]... [--minutes N] [--seed N] [--out DIR]

  TARGET       model, formula, set, log or checkpoint (all, one after another)
  --minutes N  time for each (10)
  --seed N     of the changes (1)
  --out DIR    where inputs that broke something are written (target/fuzz)

Exit status: 0 nothing was found, 1 something was, 2 the command line was not understood.
";

/// What the command line asks for.
struct Wish {
    targets: Vec<Target>,
    minutes: f64,
    seed: u64,
    out: PathBuf,
}

fn main() -> ExitCode {
    conclude(HELP, parse, hunt)
}

/// `None` for help.
fn parse(mut args: Parser) -> Result<Option<Wish>, lexopt::Error> {
    let out = PathBuf::from("target/fuzz");
    let mut wish = Wish { targets: Vec::new(), minutes: 10.0, seed: 1, out };
    while let Some(arg) = args.next()? {
        match arg {
            Long("minutes") => wish.minutes = args.value()?.parse()?,
            Long("seed") => wish.seed = args.value()?.parse()?,
            Long("out") => wish.out = args.value()?.into(),
            Short('h') | Long("help") => return Ok(None),
            Value(name) => wish.targets.push(name.parse_with(|name| {
                let found = TARGETS.into_iter().find(|target| target.name == name);
                found.ok_or(format!("there is no target `{name}`"))
            })?),
            other => return Err(other.unexpected()),
        }
    }
    if wish.targets.is_empty() {
        wish.targets = TARGETS.to_vec();
    }
    Ok(Some(wish))
}

/// Runs every target and writes a line of a table for each.
fn hunt(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let time = Duration::try_from_secs_f64(60.0 * wish.minutes)?;
    fs::create_dir_all(&wish.out)?;
    // What a reader says as it breaks stands beside the input that broke it.
    std::panic::set_hook(Box::new(|_| {}));
    writeln!(out, "| target | inputs tried | answers told apart | slowest (ms) | found |")?;
    writeln!(out, "|---|---|---|---|---|")?;
    let mut found = 0;
    for target in &wish.targets {
        let seeds = seeds::of(target.name, &root)?;
        let hunt = Hunt { target: *target, seed: wish.seed, out: &wish.out };
        let Tally { tried, answers, slowest, broken } = hunt.run(seeds, time)?;
        let (name, slowest) = (target.name, slowest.as_millis());
        writeln!(out, "| {name} | {tried} | {answers} | {slowest} | {} |", broken.len())?;
        out.flush()?;
        for (file, why) in &broken {
            eprintln!("{}: {why}", file.display());
        }
        found += broken.len();
    }
    Ok(if found == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
