//! `cargo xtask bench diagnosis`: how often the diagnosis is right.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::{Parser, value_parser};
use engine::parallel::with_threads;
use validation::benchmark::calibration::{calibration, picture};
use validation::benchmark::interval::quantile;
use validation::benchmark::kept::Kept;
use validation::benchmark::plan::{Plan, Row, Seeds, Size};
use validation::benchmark::trial::{Trial, baseline, draw};
use validation::benchmark::{json, run, table};
use validation::command::{STATUS, conclude};

/// Sets whose time is taken on one thread.
const TIMED: usize = 5;

/// Worlds in which something is hidden, measured and diagnosed blindly: how often is it found?
#[derive(Parser)]
#[command(bin_name = "cargo xtask bench diagnosis", max_term_width = 100, after_help = STATUS)]
struct Wish {
    /// Which random numbers
    #[arg(long, value_name = "WHICH", value_enum, default_value = "development")]
    seeds: Seeds,
    /// One row; may be given several times. `next` and `beyond` are drawn only where they are asked for
    #[arg(long, value_name = "ROW", value_parser = row)]
    only: Vec<Row>,
    /// Worlds per effect and strength (3); all rows grow with it
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1000))]
    sets: Option<u16>,
    /// A third of singles, nulls and unlisted
    #[arg(long)]
    quick: bool,
    /// Sets diagnosed at a time (one per core)
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1000))]
    threads: Option<u16>,
    /// Outcomes so far, one JSON object per line; those that are there are not diagnosed again. They are of one
    /// program: a changed diagnosis wants another file
    #[arg(long, value_name = "FILE")]
    keep: Option<PathBuf>,
    /// One JSON object, every set in it
    #[arg(long)]
    json: bool,
    /// Writes the worlds and tables as results.md and the calibration as calibration.svg to DIR
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Writes the sets of what is asked for to folders in DIR, and diagnoses nothing
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
}

impl Wish {
    fn plans(&self) -> Vec<Plan> {
        let mut size = if self.quick { Size::quick() } else { Size::full() };
        if !self.only.is_empty() {
            size.rows.clone_from(&self.only);
        }
        size.draws = self.sets.map_or(size.draws, usize::from);
        size.plans(self.seeds)
    }
}

fn main() -> ExitCode {
    conclude(work)
}

fn row(name: &str) -> Result<Row, String> {
    let row = Row::all().find(|row| row.name() == name);
    let known = || Row::all().map(Row::name).collect::<Vec<_>>().join(", ");
    row.ok_or_else(|| format!("no row is called `{name}`; there are {}", known()))
}

fn work(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let plans = wish.plans();
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
    let trials = with_threads(wish.threads.map_or(0, usize::from), || {
        run(plans, &model, kept.as_ref(), &done)
    })??;
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
