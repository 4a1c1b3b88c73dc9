//! `cargo xtask bench diagnosis`: how often the diagnosis is right.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

use engine::parallel::with_threads;
use lexopt::Parser;
use lexopt::prelude::{Long, Short, ValueExt};
use validation::benchmark::calibration::{calibration, picture};
use validation::benchmark::interval::quantile;
use validation::benchmark::kept::Kept;
use validation::benchmark::plan::{Plan, Row, Seeds, Size};
use validation::benchmark::trial::{Trial, baseline, draw};
use validation::benchmark::{json, run, table};
use validation::command::conclude;

const HELP: &str = "\
Worlds in which something is hidden, measured and diagnosed blindly: how often is it found?

Usage: cargo xtask bench diagnosis [--seeds development|release] [--only ROW]... [--sets N] [--quick]
                                   [--threads N] [--keep FILE] [--json] [--out DIR] [--export DIR]

  --seeds WHICH  random numbers for work on the diagnosis (default), or those of the tables
  --only ROW     one row; may be given several times
                 (singles, nulls, unlisted, pairs, one-intruder, vertical, scalars, scalar-nulls,
                 camera, beds, repeats, apparatus; and next and beyond, which are drawn only where they are
                 asked for)
  --sets N       worlds per effect and strength (3); all rows grow with it
  --quick        a third of singles, nulls and unlisted
  --threads N    sets diagnosed at a time (one per core)
  --keep FILE    outcomes so far, one JSON object per line; those that are there are not diagnosed again. They
                 are of one program: a changed diagnosis wants another file
  --json         one JSON object, every set in it
  --out DIR      writes the worlds and tables as results.md and the calibration as calibration.svg to DIR
  --export DIR   writes the sets of what is asked for to folders in DIR, and diagnoses nothing

Exit status: 0 done, 1 failed, 2 the command line was not understood.
";

/// Sets whose time is taken on one thread.
const TIMED: usize = 5;

/// What the command line asks for.
struct Wish {
    seeds: Seeds,
    size: Size,
    threads: usize,
    keep: Option<PathBuf>,
    json: bool,
    out: Option<PathBuf>,
    export: Option<PathBuf>,
}

fn main() -> ExitCode {
    conclude(HELP, parse, work)
}

/// `None` for help.
fn parse(mut args: Parser) -> Result<Option<Wish>, lexopt::Error> {
    let (mut seeds, mut size, mut only, mut draws) =
        (Seeds::Development, Size::full(), Vec::new(), None);
    let (mut threads, mut json, mut out) = (0, false, None);
    let (mut keep, mut export) = (None, None);
    while let Some(arg) = args.next()? {
        match arg {
            Long("seeds") => {
                seeds = args.value()?.parse_with(|name| match name {
                    "development" => Ok(Seeds::Development),
                    "release" => Ok(Seeds::Release),
                    other => Err(format!("there are no seeds `{other}`")),
                })?;
            }
            Long("only") => only.push(args.value()?.parse_with(row)?),
            Long("sets") => draws = Some(args.value()?.parse_with(count)?),
            Long("threads") => threads = args.value()?.parse_with(count)?,
            Long("quick") => size = Size::quick(),
            Long("keep") => keep = Some(PathBuf::from(args.value()?)),
            Long("json") => json = true,
            Long("out") => out = Some(PathBuf::from(args.value()?)),
            Long("export") => export = Some(PathBuf::from(args.value()?)),
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if !only.is_empty() {
        size.rows = only;
    }
    size.draws = draws.unwrap_or(size.draws);
    Ok(Some(Wish { seeds, size, threads, keep, json, out, export }))
}

fn row(name: &str) -> Result<Row, String> {
    let row = Row::all().find(|row| row.name() == name);
    let known = || Row::all().map(Row::name).collect::<Vec<_>>().join(", ");
    row.ok_or_else(|| format!("no row is called `{name}`; there are {}", known()))
}

fn count(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (1..=1000).contains(n))
        .ok_or(format!("`{text}` is no number of 1 to 1000"))
}

fn work(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let plans = wish.size.plans(wish.seeds);
    if let Some(folder) = &wish.export {
        for (number, plan) in plans.iter().enumerate() {
            let folder = folder.join(format!("{:04}", number + 1));
            match draw(plan) {
                Ok((nature, set)) => {
                    fs::create_dir_all(&folder)?;
                    set.write(&folder)?;
                    let (drag, friction) = (nature.drag, nature.friction);
                    writeln!(out, "{}: drag {drag}, friction {friction}", folder.display())?;
                    for (hidden, q) in nature.hidden {
                        writeln!(out, "hidden: {}, q = {q}: {}", hidden.id(), hidden.form().law)?;
                    }
                }
                Err(why) => writeln!(out, "{}: not drawn, {why}", folder.display())?,
            }
        }
        return Ok(ExitCode::SUCCESS);
    }
    let model = baseline()?;
    let (total, finished) = (plans.len(), AtomicUsize::new(0));
    let done = || {
        let n = finished.fetch_add(1, Ordering::Relaxed) + 1;
        if n.is_multiple_of(20) || n == total {
            eprintln!("{n} of {total} sets");
        }
    };
    // A force outside the list is sought for as long as it gives hope: its time says nothing of another set.
    let is_plain = |plan: &&Plan| !matches!(plan.row, Row::Beyond | Row::Next);
    let timed: Vec<_> = plans.iter().filter(is_plain).take(TIMED).cloned().collect();
    let kept = wish.keep.as_deref().map(Kept::open).transpose()?;
    let trials = with_threads(wish.threads, || run(plans, &model, kept.as_ref(), &done))??;
    let alone = with_threads(1, || run(timed, &model, None, &|| ()))??;
    let seconds: Vec<f64> = alone.iter().filter_map(Trial::answer).map(|a| a.seconds).collect();
    let bins = calibration(&trials);
    let mut report = table::report(&trials, &bins);
    if let Some(median) = quantile(&seconds, 0.5) {
        report.insert_str(
            0,
            &format!(
                "Alone on one thread, a set takes {median:.2} s at the median of {}.\n",
                seconds.len()
            ),
        );
    }
    match wish.json {
        true => writeln!(out, "{:#}", json::report(&trials, &bins))?,
        false => writeln!(out, "{report}")?,
    }
    if let Some(folder) = &wish.out {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("results.md"), format!("{}\n{report}", table::worlds()))?;
        fs::write(folder.join("calibration.svg"), picture(&bins)?)?;
    }
    Ok(ExitCode::SUCCESS)
}
