//! `cargo xtask bench beds`: how often the diagnosis of a bed of grains is right.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use diagnosis::beds::Wish;
use engine::checkpoint::write_whole;
use lexopt::Parser;
use lexopt::prelude::{Long, Short, ValueExt};
use runner::beds::Place;
use runner::{Elsewhere, Unattended};
use validation::benchmark::beds::{
    Case, Outcome, all, by_lammps, of_spheres, prepared, quick, table,
};
use validation::command::{conclude, on};
use validation::speed::lammps::Lammps;

const HELP: &str = "\
How often the diagnosis of a bed of grains names what is hidden in it.

Usage: cargo xtask bench beds [--quick | --prepared | --lammps | --spheres] [--draws N] [--minutes N] [--threads N]
                             [--only TEXT] [--on WHERE] [--cache DIR] [--out FILE] [--export DIR]

  --quick      small beds: every preparation with nothing hidden, two listed effects, one that is not listed
  --prepared   small beds, prepared in seven ways, weighed or not, with nothing hidden and with two effects
  --lammps     small beds that LAMMPS rains and hits, with nothing, two effects, and one that is not listed;
               it is installed below target/peers, unless PLUNGE_LAMMPS names an lmp
  --spheres    beds of 1 000 spheres, prepared in three ways, with nothing, two effects, and one that is not listed
  --only TEXT  the cases with this in their names, such as friction or LAMMPS
  --draws N    draws of every case (2)
  --minutes N  impacts of one diagnosis at most, as estimated (as long as the largest plan takes)
  --threads N  impacts at a time (one per core)
  --on WHERE   where impacts are run: local (default), slurm or hyperqueue, which are waited for
  --cache DIR  where beds and impacts are kept (runs/.cache); those that are there are not run again
  --out FILE   outcomes so far, one JSON object per line (runs/beds-benchmark.jsonl); those that are
               there are not diagnosed again
  --export DIR writes the sets and the models of what is asked for to folders in DIR, and diagnoses nothing

Exit status: 0 done, 1 failed, 2 the command line was not understood.
";

struct Wanted {
    cases: Vec<Case>,
    wish: Wish,
    threads: Option<NonZero<usize>>,
    elsewhere: Option<Elsewhere>,
    cache: PathBuf,
    out: PathBuf,
    export: Option<PathBuf>,
}

fn main() -> ExitCode {
    conclude(HELP, parse, bench)
}

/// `None` for help.
fn parse(mut parser: Parser) -> Result<Option<Wanted>, lexopt::Error> {
    let (mut draws, mut minutes) = (2, f64::INFINITY);
    let mut list: fn(u64) -> Vec<Case> = all;
    let mut only = String::new();
    let mut wanted = Wanted {
        cases: Vec::new(),
        wish: Wish::default(),
        threads: None,
        elsewhere: None,
        cache: "runs/.cache".into(),
        out: "runs/beds-benchmark.jsonl".into(),
        export: None,
    };
    while let Some(argument) = parser.next()? {
        match argument {
            Long("quick") => list = |_| quick(),
            Long("prepared") => list = prepared,
            Long("lammps") => list = by_lammps,
            Long("spheres") => list = of_spheres,
            Long("only") => only = parser.value()?.string()?,
            Long("draws") => draws = parser.value()?.parse()?,
            Long("minutes") => minutes = parser.value()?.parse()?,
            Long("threads") => wanted.threads = Some(parser.value()?.parse()?),
            Long("on") => wanted.elsewhere = on(&mut parser)?,
            Long("cache") => wanted.cache = parser.value()?.into(),
            Long("out") => wanted.out = parser.value()?.into(),
            Long("export") => wanted.export = Some(parser.value()?.into()),
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    wanted.cases = list(draws);
    wanted.cases.retain(|case| case.name().contains(&only));
    wanted.wish.budget = Some(60.0 * minutes);
    Ok(Some(wanted))
}

fn bench(wanted: &Wanted, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let place = Place {
        cache: &wanted.cache,
        workers: wanted.threads,
        watch: &Unattended,
        elsewhere: wanted.elsewhere.as_ref(),
    };
    let text = fs::read_to_string(&wanted.out).unwrap_or_default();
    let mut known: Vec<Outcome> =
        text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
    let is_by_lammps = wanted.cases.iter().any(|case| case.is_by_lammps);
    let lammps =
        is_by_lammps.then(|| Lammps::find_or_install(Path::new("target/peers"))).transpose()?;
    let by = lammps.as_ref().map(|lammps| (lammps, Path::new("target/bench/worlds")));
    if let Some(folder) = &wanted.export {
        for (number, case) in wanted.cases.iter().enumerate() {
            let folder = folder.join(format!("{:03}", number + 1));
            let (_, set) = case.measured(&place, by)?;
            fs::create_dir_all(&folder)?;
            set.write(&folder)?;
            fs::write(folder.join("model.toml"), case.model_text())?;
            writeln!(out, "{}: {} ({})", folder.display(), case.name(), case.seed)?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let mut outcomes = Vec::with_capacity(wanted.cases.len());
    for case in &wanted.cases {
        let same = |one: &&Outcome| one.hidden == case.name() && one.seed == case.seed;
        let outcome = match known.iter().find(same) {
            Some(outcome) => outcome.clone(),
            None => {
                let outcome = case.run(&place, &wanted.wish, by)?;
                known.push(outcome.clone());
                keep(&wanted.out, &known)?;
                outcome
            }
        };
        eprintln!(
            "{} ({}): {} {:?}, {:.0} s",
            outcome.hidden, outcome.seed, outcome.verdict, outcome.named, outcome.seconds
        );
        outcomes.push(outcome);
    }
    write!(out, "{}", table(&outcomes))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the outcomes so far, whole or not at all.
fn keep(path: &Path, outcomes: &[Outcome]) -> Result<(), Box<dyn Error>> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let lines = outcomes.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
    Ok(write_whole(path, (lines.join("\n") + "\n").as_bytes())?)
}
