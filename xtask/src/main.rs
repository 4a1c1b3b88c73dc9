//! Chores of the repository: `cargo xtask <task>`.
//!
//! It links none of our crates, so it starts at once; whatever runs a bed is started in release.

#![allow(clippy::print_stdout, reason = "stdout is where a command's result belongs")]

mod lint;
mod mutants;
mod tidy;

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use lexopt::{Arg, ValueExt as _};
use xshell::{Cmd, Shell, cmd};

const HELP: &str = "\
Chores of the repository.

Usage: cargo xtask <task>

  lint               fmt, clippy, doc and tidy, then cargo-deny, typos and taplo
  tidy               the rules of the repository that no other tool knows
  bench [ARG]...     grain-steps per second, in release; the arguments go to the program
  bench resistive    impacts per second on resistive media, in release
  bench diagnosis [ARG]...
                     how often the diagnosis is right, in release; the arguments go to the program
  bench beyond [ARG]...
                     what is said of forces outside the list, in release; likewise
  bench beds [ARG]...
                     how often the diagnosis is right on small beds of grains
  mutants [NUMBER]...
                     wrong lines, one at a time in a copy of the sources: which of them no test notices
  fuzz [READER] [--minutes N]
                     changed files against every reader, or those with this word in the name of their
                     test: model, formula, set, log, checkpoint; 10 minutes each
  schema [--check]   the JSON schemas of models, sets and campaigns, written to configs/schemas, or held
                     against what is there
  three-shapes [ARG]...
                     cylinder, hemisphere and cone on beds of grains, in release; the same
  validate [ARG]...  the published results, run again in release, and the page of them; the arguments
                     go to the program as they are
  help               this text

Exit status: 0 done, 1 something was found, 2 the command line was not understood.
";

/// What the command line asks for.
#[derive(Debug, PartialEq)]
enum Task {
    Bench(Vec<OsString>),
    BenchBeds(Vec<OsString>),
    BenchDiagnosis(Vec<OsString>),
    BenchResistive,
    Fuzz(Hunt),
    Help,
    Lint,
    Mutants(Vec<u32>),
    Schema { check: bool },
    Tidy,
    ThreeShapes(Vec<OsString>),
    Validate(Vec<OsString>),
}

fn main() -> ExitCode {
    let outcome = match parse(std::env::args_os().skip(1)) {
        Ok(task) => run(task),
        Err(error) => {
            eprintln!("error: {error}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

fn parse(args: impl Iterator<Item = OsString>) -> Result<Task, lexopt::Error> {
    let mut parser = lexopt::Parser::from_args(args);
    let Some(first) = parser.next()? else {
        return Err("a task is missing".into());
    };
    let task = match first {
        Arg::Short('h') | Arg::Long("help") => return Ok(Task::Help),
        Arg::Value(name) => match name.to_str() {
            Some("bench") => return benchmark(parser.raw_args()?.collect()),
            Some("fuzz") => return hunt(parser),
            Some("help") => Task::Help,
            Some("lint") => Task::Lint,
            Some("mutants") => return mutants(parser),
            Some("schema") => return schema(parser),
            Some("tidy") => Task::Tidy,
            Some("three-shapes") => return Ok(Task::ThreeShapes(parser.raw_args()?.collect())),
            Some("validate") => return Ok(Task::Validate(parser.raw_args()?.collect())),
            _ => return Err(format!("no task is called `{}`", name.display()).into()),
        },
        other => return Err(other.unexpected()),
    };
    match parser.next()? {
        None => Ok(task),
        Some(Arg::Short('h') | Arg::Long("help")) => Ok(Task::Help),
        Some(other) => Err(other.unexpected()),
    }
}

/// Schemas, written or checked.
fn schema(mut parser: lexopt::Parser) -> Result<Task, lexopt::Error> {
    let mut check = false;
    while let Some(arg) = parser.next()? {
        match arg {
            Arg::Short('h') | Arg::Long("help") => return Ok(Task::Help),
            Arg::Long("check") => check = true,
            other => return Err(other.unexpected()),
        }
    }
    Ok(Task::Schema { check })
}

/// Mutants by their numbers.
fn mutants(mut parser: lexopt::Parser) -> Result<Task, lexopt::Error> {
    let mut numbers = Vec::new();
    while let Some(arg) = parser.next()? {
        match arg {
            Arg::Short('h') | Arg::Long("help") => return Ok(Task::Help),
            Arg::Value(number) => numbers.push(number.parse()?),
            other => return Err(other.unexpected()),
        }
    }
    Ok(Task::Mutants(numbers))
}

/// What `fuzz` is asked for.
#[derive(Debug, PartialEq)]
struct Hunt {
    reader: Option<String>,
    minutes: f64,
}

fn hunt(mut parser: lexopt::Parser) -> Result<Task, lexopt::Error> {
    let mut hunt = Hunt { reader: None, minutes: 10.0 };
    while let Some(arg) = parser.next()? {
        match arg {
            Arg::Long("minutes") => hunt.minutes = parser.value()?.parse()?,
            Arg::Short('h') | Arg::Long("help") => return Ok(Task::Help),
            Arg::Value(reader) if hunt.reader.is_none() => hunt.reader = Some(reader.string()?),
            other => return Err(other.unexpected()),
        }
    }
    Ok(Task::Fuzz(hunt))
}

/// Tries changed files for some minutes. Not in release: arithmetic that overflows is something to be found.
fn fuzz(sh: &Shell, Hunt { reader, minutes }: &Hunt) -> Result<ExitCode> {
    let time = format!("{:.0}", 60e3 * minutes);
    let most = u32::MAX.to_string();
    let tests =
        cmd!(sh, "cargo test --locked -p fuzz --test readers -- --test-threads=1 {reader...}");
    start(tests.env("BOLERO_RANDOM_TEST_TIME_MS", time).env("BOLERO_RANDOM_ITERATIONS", most))
}

/// The benchmark that the first of `args` names; without a name, that of beds of grains.
fn benchmark(mut args: Vec<OsString>) -> Result<Task, lexopt::Error> {
    let name = args.first().map(|name| name.to_string_lossy().into_owned());
    match name.as_deref() {
        Some("beds") => {
            args.remove(0);
            Ok(Task::BenchBeds(args))
        }
        Some("diagnosis") => {
            args.remove(0);
            Ok(Task::BenchDiagnosis(args))
        }
        Some("beyond") => {
            args.splice(0..1, ["--only", "beyond"].map(OsString::from));
            Ok(Task::BenchDiagnosis(args))
        }
        Some("resistive") if args.len() == 1 => Ok(Task::BenchResistive),
        Some(name) if !name.starts_with('-') => {
            let named = args.join(OsStr::new(" "));
            Err(format!("no benchmark is called `{}`", named.display()).into())
        }
        _ => Ok(Task::Bench(args)),
    }
}

fn run(task: Task) -> Result<ExitCode> {
    let sh = Shell::new()?;
    match task {
        Task::Help => {
            print!("{HELP}");
            Ok(ExitCode::SUCCESS)
        }
        Task::Lint => {
            sh.change_dir(root()?);
            lint::run(&sh)
        }
        Task::Mutants(numbers) => {
            sh.change_dir(root()?);
            mutants::run(&sh, &numbers)
        }
        Task::Schema { check } => {
            let bless = if check { "0" } else { "1" };
            start(
                cmd!(sh, "cargo test --quiet --locked -p plunge --test schemas")
                    .env("BLESS", bless),
            )
        }
        Task::Tidy => {
            sh.change_dir(root()?);
            tidy::run(&sh)
        }
        Task::Bench(args) => speed(&sh, args),
        Task::BenchBeds(args) => study(&sh, "beds", &args),
        Task::BenchDiagnosis(args) => study(&sh, "accuracy", &args),
        Task::BenchResistive => study(&sh, "bench", &[]),
        Task::Fuzz(hunt) => fuzz(&sh, &hunt),
        Task::ThreeShapes(args) => study(&sh, "three_shapes", &args),
        Task::Validate(args) => validate(&sh, &args),
    }
}

/// Runs the published results again and makes the page of what came out, also where a row fails.
fn validate(sh: &Shell, args: &[OsString]) -> Result<ExitCode> {
    let code = study(sh, "validate", args)?;
    let shows_only = |arg: &OsString| ["--list", "--help", "-h"].iter().any(|one| arg == one);
    let folder = written_to(args);
    if args.iter().any(shows_only) || !folder.join("validation.json").is_file() {
        return Ok(code);
    }
    let page = cmd!(sh, "cargo run --quiet --release --locked -p plunge -- report {folder}");
    let status = std::process::Command::from(page).status().context("cannot start cargo")?;
    Ok(if status.success() { code } else { ExitCode::FAILURE })
}

/// The folder that the published results are written to.
fn written_to(args: &[OsString]) -> PathBuf {
    let mut args = args.iter().map(|arg| arg.to_string_lossy());
    let mut folder = PathBuf::from("target/validation");
    while let Some(arg) = args.next() {
        if arg == "--out" {
            folder = args.next().map_or(folder, |value| PathBuf::from(value.as_ref()));
        } else if let Some(value) = arg.strip_prefix("--out=") {
            folder = PathBuf::from(value);
        }
    }
    folder
}

/// The benchmark of beds, compiled for this processor, or with `--simd avx2` without AVX-512.
fn speed(sh: &Shell, mut args: Vec<OsString>) -> Result<ExitCode> {
    let Some(at) = args.iter().position(|arg| arg == "--simd") else {
        return study(sh, "speed", &args);
    };
    anyhow::ensure!(args.get(at + 1).is_some_and(|kind| kind == "avx2"), "--simd takes `avx2`");
    args.drain(at..at + 2);
    let flags = "-C target-cpu=native -C target-feature=-avx512f";
    let cargo = cmd!(
        sh,
        "cargo run --quiet --release --locked --target-dir target/avx2 -p validation --bin speed -- {args...}"
    );
    start(cargo.env("RUSTFLAGS", flags))
}

/// Runs a program of `validation`.
fn study(sh: &Shell, name: &str, args: &[OsString]) -> Result<ExitCode> {
    start(cmd!(sh, "cargo run --quiet --release --locked -p validation --bin {name} -- {args...}"))
}

/// Runs a program from where the user stands and hands its exit status on.
fn start(cargo: Cmd<'_>) -> Result<ExitCode> {
    let status = std::process::Command::from(cargo).status().context("cannot start cargo")?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}

/// The folder of the workspace.
fn root() -> Result<PathBuf> {
    let manifest_dir = std::env::var_os("CARGO_MANIFEST_DIR")
        .context("start this as `cargo xtask`: cargo says where the workspace is")?;
    let root = PathBuf::from(manifest_dir).parent().map(PathBuf::from);
    root.context("the xtask crate stands one level below the workspace")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(args: &[&str]) -> Result<Task, String> {
        parse(args.iter().map(OsString::from)).map_err(|error| error.to_string())
    }

    #[test]
    fn each_task_is_reached_by_its_name() {
        assert_eq!(parsed(&["lint"]), Ok(Task::Lint));
        assert_eq!(parsed(&["tidy"]), Ok(Task::Tidy));
        assert_eq!(parsed(&["bench"]), Ok(Task::Bench(Vec::new())));
        assert_eq!(parsed(&["bench", "resistive"]), Ok(Task::BenchResistive));
        for help in ["help", "-h", "--help"] {
            assert_eq!(parsed(&[help]), Ok(Task::Help));
        }
        assert_eq!(parsed(&["lint", "--help"]), Ok(Task::Help));
    }

    #[test]
    fn everything_after_validate_is_passed_on_untouched() {
        let task = parsed(&["validate", "--only", "row 3", "--", "--help"]);
        let args = ["--only", "row 3", "--", "--help"].map(OsString::from).to_vec();
        assert_eq!(task, Ok(Task::Validate(args)));
    }

    #[test]
    fn the_folder_of_the_published_results_is_the_last_that_is_given() {
        let of = |args: &[&str]| written_to(&args.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(of(&["--quick"]), PathBuf::from("target/validation"));
        assert_eq!(of(&["--out", "a", "--only", "E1"]), PathBuf::from("a"));
        assert_eq!(of(&["--out", "a", "--out=b"]), PathBuf::from("b"));
    }

    #[test]
    fn a_benchmark_is_chosen_by_its_name_and_gets_its_arguments() {
        let task = parsed(&["bench", "diagnosis", "--quick", "--help"]);
        assert_eq!(
            task,
            Ok(Task::BenchDiagnosis(["--quick", "--help"].map(OsString::from).into()))
        );
        let quick = vec![OsString::from("--quick")];
        assert_eq!(parsed(&["bench", "beds", "--quick"]), Ok(Task::BenchBeds(quick)));
        let beyond = ["--only", "beyond", "--quick"].map(OsString::from).into();
        assert_eq!(parsed(&["bench", "beyond", "--quick"]), Ok(Task::BenchDiagnosis(beyond)));
        assert_eq!(
            parsed(&["bench", "diagnoses"]),
            Err("no benchmark is called `diagnoses`".into())
        );
        assert!(parsed(&["bench", "resistive", "--quick"]).is_err());
        // The one without a name takes everything else, its own help included.
        let args = ["--peers", "--help"];
        let task = Task::Bench(args.map(OsString::from).into());
        assert_eq!(parsed(&["bench", args[0], args[1]]), Ok(task));
    }

    #[test]
    fn schemas_are_written_unless_they_are_only_checked() {
        assert_eq!(parsed(&["schema"]), Ok(Task::Schema { check: false }));
        assert_eq!(parsed(&["schema", "--check"]), Ok(Task::Schema { check: true }));
        assert!(parsed(&["schema", "model"]).is_err());
    }

    #[test]
    fn mutants_are_chosen_by_their_numbers() {
        assert_eq!(parsed(&["mutants"]), Ok(Task::Mutants(Vec::new())));
        assert_eq!(parsed(&["mutants", "4", "13"]), Ok(Task::Mutants(vec![4, 13])));
        assert!(parsed(&["mutants", "four"]).is_err_and(|error| error.contains("four")));
    }

    #[test]
    fn what_is_not_understood_is_named() {
        assert_eq!(parsed(&[]), Err("a task is missing".into()));
        assert_eq!(parsed(&["tydi"]), Err("no task is called `tydi`".into()));
        assert!(parsed(&["lint", "--fast"]).is_err_and(|error| error.contains("--fast")));
    }
}
