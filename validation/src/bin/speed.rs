//! `cargo xtask bench`: how fast beds of grains are stepped, alone or beside a peer.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use lexopt::Parser;
use lexopt::prelude::{Long, Short, Value, ValueExt};
use validation::benchmark::document;
use validation::command::conclude;
use validation::speed::lammps::Lammps;
use validation::speed::plan::{self, Plan};
use validation::speed::problem::{PROBLEMS, Problem, usual};
use validation::speed::report;
use validation::speed::trial::{Extent, Order, Span};

const HELP: &str = "\
Grain-steps per second of beds under an impact: of the time loop alone, in processes of their own, in turns.

Usage: cargo xtask bench [--problem NAME]... [--peers] [--quick] [--repeats N] [--out DIR] [--cache DIR] [--write]

  --problem NAME  2d-15k, 3d-12k, 3d-50k, 3d-200k, or growth for those in space; steel-25k, steel-50k,
                  steel-100k; may be given several times (all up to steel-25k)
  --peers         LAMMPS too, on the same beds, laws and steps, on one core and on two ranks; it is installed
                  below target/peers, unless PLUNGE_LAMMPS names an lmp; every pair style that it has for the
                  law is timed, and beside it an lmp that was built for this processor, which
                  PLUNGE_LAMMPS_NATIVE names
  --quick         a quarter of the steps, but 100 at least; three repeats
  --repeats N     how often each is timed (5)
  --out DIR       where speed.json, speed.md, problems and decks are written (target/bench)
  --cache DIR     the folder of prepared beds (else $PLUNGE_CACHE, else runs/.cache)
  --write         the tables to docs/performance.md
  --simd avx2     compiles without AVX-512, into target/avx2 (what the processor has)

Exit status: 0 done, 1 failed or a peer disagrees, 2 the command line was not understood.
";

/// What the command line asks for.
enum Wish {
    Bench(Bench),
    /// One trial, for the benchmark itself.
    Trial(Order),
}

/// A benchmark.
struct Bench {
    problems: Vec<&'static Problem>,
    peers: bool,
    repeats: usize,
    shorter: u64,
    out: PathBuf,
    cache: PathBuf,
    write: bool,
}

fn main() -> ExitCode {
    conclude(HELP, parse, |wish, out| match wish {
        Wish::Trial(order) => trial(order, out),
        Wish::Bench(wish) => bench(wish, out),
    })
}

/// `None` for help.
fn parse(mut args: Parser) -> Result<Option<Wish>, lexopt::Error> {
    let (mut problems, mut peers, mut write) = (Vec::new(), false, false);
    let (mut repeats, mut shorter) = (None, 1);
    let (mut out, mut cache) = (PathBuf::from("target/bench"), None);
    while let Some(arg) = args.next()? {
        match arg {
            Value(word) if word == "trial" => return order(&mut args).map(Wish::Trial).map(Some),
            Long("problem") => problems.extend(args.value()?.parse_with(named)?),
            Long("peers") => peers = true,
            Long("quick") => shorter = 4,
            Long("repeats") => repeats = Some(args.value()?.parse_with(count)?),
            Long("out") => out = PathBuf::from(args.value()?),
            Long("cache") => cache = Some(PathBuf::from(args.value()?)),
            Long("write") => write = true,
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if problems.is_empty() {
        problems = usual().collect();
    }
    let from_environment = || std::env::var_os("PLUNGE_CACHE").filter(|folder| !folder.is_empty());
    let cache = cache.or_else(|| from_environment().map(PathBuf::from));
    Ok(Some(Wish::Bench(Bench {
        problems,
        peers,
        repeats: repeats.unwrap_or(if shorter > 1 { 3 } else { 5 }),
        shorter,
        out,
        cache: cache.unwrap_or_else(|| PathBuf::from("runs/.cache")),
        write,
    })))
}

/// The problems that `name` stands for.
fn named(name: &str) -> Result<Vec<&'static Problem>, String> {
    if name == "growth" {
        return Ok(PROBLEMS.iter().filter(|problem| problem.name.starts_with("3d")).collect());
    }
    let known = || PROBLEMS.iter().map(|problem| problem.name).collect::<Vec<_>>().join(", ");
    let problem = Problem::find(name);
    let unknown = || format!("no problem is called `{name}`; there are {}, growth", known());
    problem.map(|problem| vec![problem]).ok_or_else(unknown)
}

fn count(text: &str) -> Result<usize, String> {
    let found = text.parse().ok().filter(|n| (1..=100).contains(n));
    found.ok_or(format!("`{text}` is no number of 1 to 100"))
}

/// What a process of the benchmark is told: model, steps of warm-up, steps, threads, and how much of a run.
fn order(args: &mut Parser) -> Result<Order, lexopt::Error> {
    let model = PathBuf::from(args.value()?);
    let mut number = || args.value()?.parse::<u64>();
    let (warm_up, steps, threads) = (number()?, number()?, number()?);
    let extent = match args.value()?.string()?.as_str() {
        "forces" => Extent::Forces,
        "run" => Extent::Run(PathBuf::from(args.value()?)),
        _ => Extent::Steps,
    };
    Ok(Order { model, span: Span { warm_up, steps }, threads: threads as usize, extent })
}

fn trial(order: &Order, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    writeln!(out, "{}", serde_json::to_string(&order.here()?)?)?;
    Ok(ExitCode::SUCCESS)
}

fn bench(wish: &Bench, out: &mut dyn Write) -> Result<ExitCode, Box<dyn Error>> {
    let environment = PathBuf::from("target/peers");
    let lammps = match wish.peers {
        true => [Some(Lammps::find_or_install(&environment)?), Lammps::native()?],
        false => [None, None],
    };
    let lammps = lammps.into_iter().flatten().collect();
    let plan = Plan {
        problems: wish.problems.clone(),
        repeats: wish.repeats,
        shorter: wish.shorter,
        folder: wish.out.join("problems"),
        cache: wish.cache.clone(),
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
