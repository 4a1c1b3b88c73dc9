//! `cargo xtask bench beds`: how often the diagnosis of a bed of grains is right.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser};
use diagnosis::beds::Wish;
use engine::checkpoint::write_whole;
use runner::Unattended;
use runner::beds::Place;
use validation::benchmark::beds::{
    Case, Outcome, all, by_lammps, of_spheres, prepared, quick, table,
};
use validation::command::{Impacts, STATUS, conclude};
use validation::speed::lammps::Lammps;

/// How often the diagnosis of a bed of grains names what is hidden in it.
#[derive(Parser)]
#[command(bin_name = "cargo xtask bench beds", max_term_width = 100, after_help = STATUS)]
struct Wanted {
    #[command(flatten)]
    list: List,
    /// The cases with this in their names, such as friction or LAMMPS
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    only: String,
    /// Draws of every case
    #[arg(long, value_name = "N", default_value_t = 2)]
    draws: u64,
    /// Impacts of one diagnosis at most, as estimated (as long as the largest plan takes)
    #[arg(long, value_name = "N", default_value_t = f64::INFINITY, hide_default_value = true)]
    minutes: f64,
    #[command(flatten)]
    impacts: Impacts,
    /// Where beds and impacts are kept; those that are there are not run again
    #[arg(long, value_name = "DIR", default_value = "runs/.cache")]
    cache: PathBuf,
    /// Outcomes so far, one JSON object per line; those that are there are not diagnosed again
    #[arg(long, value_name = "FILE", default_value = "runs/beds-benchmark.jsonl")]
    out: PathBuf,
    /// Writes the sets and the models of what is asked for to folders in DIR, and diagnoses nothing
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
}

#[derive(Args)]
#[group(multiple = false)]
struct List {
    /// Small beds: every preparation with nothing hidden, two listed effects, one that is not listed
    #[arg(long)]
    quick: bool,
    /// Small beds, prepared in seven ways, weighed or not, with nothing hidden and with two effects
    #[arg(long)]
    prepared: bool,
    /// Small beds that LAMMPS rains and hits, with nothing, two effects, and one that is not listed; it is installed
    /// below target/peers, unless PLUNGE_LAMMPS names an lmp
    #[arg(long)]
    lammps: bool,
    /// Beds of 1 000 spheres, prepared in three ways, with nothing, two effects, and one that is not listed
    #[arg(long)]
    spheres: bool,
}

impl Wanted {
    fn cases(&self) -> Vec<Case> {
        let mut cases = match self.list {
            List { quick: true, .. } => quick(),
            List { prepared: true, .. } => prepared(self.draws),
            List { lammps: true, .. } => by_lammps(self.draws),
            List { spheres: true, .. } => of_spheres(self.draws),
            _ => all(self.draws),
        };
        cases.retain(|case| case.name().contains(&self.only));
        cases
    }
}

fn main() -> ExitCode {
    conclude(bench)
}

fn bench(wanted: &Wanted, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let place = Place {
        cache: &wanted.cache,
        workers: wanted.impacts.threads,
        watch: &Unattended,
        elsewhere: wanted.impacts.elsewhere(),
    };
    let cases = wanted.cases();
    let wish = Wish { budget: Some(60.0 * wanted.minutes), ..Wish::default() };
    let text = fs::read_to_string(&wanted.out).unwrap_or_default();
    let mut known: Vec<Outcome> =
        text.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
    let is_by_lammps = cases.iter().any(|case| case.is_by_lammps);
    let lammps =
        is_by_lammps.then(|| Lammps::find_or_install(Path::new("target/peers"))).transpose()?;
    let by = lammps.as_ref().map(|lammps| (lammps, Path::new("target/bench/worlds")));
    if let Some(folder) = &wanted.export {
        for (number, case) in cases.iter().enumerate() {
            let folder = folder.join(format!("{:03}", number + 1));
            let (_, set) = case.measured(&place, by)?;
            fs::create_dir_all(&folder)?;
            set.write(&folder)?;
            fs::write(folder.join("model.toml"), case.model_text())?;
            writeln!(out, "{}: {} ({})", folder.display(), case.name(), case.seed)?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let mut outcomes = Vec::with_capacity(cases.len());
    for case in &cases {
        let same = |one: &&Outcome| one.hidden == case.name() && one.seed == case.seed;
        let outcome = match known.iter().find(same) {
            Some(outcome) => outcome.clone(),
            None => {
                let outcome = case.run(&place, &wish, by)?;
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
