//! `cargo xtask three-shapes`: cylinder, hemisphere and cone on beds of our own.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use runner::Unattended;
use validation::command::{Impacts, STATUS, conclude};
use validation::three_shapes::{Places, cases, depths, frictions, have_done, run, table};

/// Cylinder, hemisphere and cone at equal mass, radius and speed; and the hemisphere without and with friction.
#[derive(Parser)]
#[command(bin_name = "cargo xtask three-shapes", max_term_width = 100, after_help = STATUS)]
struct Wish {
    /// Beds per condition
    #[arg(long, value_name = "N", default_value_t = 3)]
    seeds: u64,
    #[command(flatten)]
    impacts: Impacts,
    /// Folder of results and pictures; finished impacts are not run again
    #[arg(long, value_name = "DIR", default_value = "runs/three-shapes")]
    out: PathBuf,
    /// Where prepared beds are kept
    #[arg(long, value_name = "DIR", default_value = "runs/.cache")]
    cache: PathBuf,
}

fn main() -> ExitCode {
    conclude(study)
}

fn study(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let cases = cases(wish.seeds);
    let places = Places { out: wish.out.clone(), cache: wish.cache.clone() };
    if let Some(elsewhere) = wish.impacts.elsewhere() {
        have_done(&cases, &places, elsewhere, &Unattended)?;
    }
    let workers = wish.impacts.threads.or(std::thread::available_parallelism().ok());
    let workers = workers.map_or(1, usize::from);
    let outcomes = run(&cases, &places, workers, &|case, outcome| {
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
        fs::write(places.out.join(name), picture)?;
    }
    Ok(ExitCode::SUCCESS)
}
