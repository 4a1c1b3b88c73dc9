//! `cargo xtask validate`: the published results, run again and judged.

#![allow(clippy::print_stdout, reason = "stdout is where a command's result belongs")]

use std::error::Error;
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use engine::parallel::with_threads;
use lexopt::prelude::{Long, Short, ValueExt};
use validation::beds::{Elsewhere, Place, Progress, Stage, Watch};
use validation::published::{
    Effort, Judged, Laboratory, Missing, ROWS, Row, Verdict, markdown, to_json,
};
use validation::{CASES, Case, command, three_shapes};

const HELP: &str = "\
The published results, run again and judged.

Usage: cargo xtask validate [--quick | --full] [--so-far] [--only ID[,ID]...]... [--out DIR]
                            [--cache DIR] [--threads N] [--on WHERE] [--list] [--case NAME]...

  --quick      every row at a reduced cost (default): under ten minutes on two cores, if its beds are there
  --full       what the sources ran: hours; impacts that are there are not run again
  --so-far     runs no impact: judges those that are there, while others are still being run
  --only ID    these rows only; may be given several times
  --out DIR    where validation.json, REPORT.md and figures are written (target/validation)
  --cache DIR  where beds and impacts are kept (else $PLUNGE_CACHE, else runs/.cache)
  --threads N  impacts at a time (one per core)
  --on WHERE   where impacts are run: local (default), slurm or hyperqueue, which are waited for
  --list       the rows, without running them
  --case NAME  instead, every number of a case with a known answer, as the documents have it; may be
               given several times

Exit status: 0 no row fails, 1 one does or could not be run, 2 the command line was not understood.
";

/// Time between two lines of progress.
const EVERY: Duration = Duration::from_secs(10);

/// What the command line asks for.
struct Wish {
    effort: Effort,
    missing: Missing,
    rows: Vec<&'static Row>,
    out: PathBuf,
    cache: PathBuf,
    threads: Option<NonZero<usize>>,
    elsewhere: Option<Elsewhere>,
    list: bool,
    cases: Vec<&'static Case>,
}

fn main() -> ExitCode {
    if let Some(status) = command::task() {
        return status;
    }
    let wish = match parse(lexopt::Parser::from_env()) {
        Ok(Some(wish)) => wish,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            eprintln!("error: {error}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    if wish.list {
        for Row { id, title, source, how: [quick, full], .. } in &wish.rows {
            println!("{id}: {title}\n    {source}\n    quick: {quick}\n    full: {full}");
        }
        return ExitCode::SUCCESS;
    }
    let done = match &wish.cases[..] {
        [] => validate(&wish).map(|verdict| verdict < Verdict::Fail),
        cases => with_threads(1, || show(cases)).map_err(Box::from),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// `None` for help.
fn parse(mut parser: lexopt::Parser) -> Result<Option<Wish>, lexopt::Error> {
    let cache = std::env::var_os("PLUNGE_CACHE").unwrap_or_else(|| "runs/.cache".into());
    let mut wish = Wish {
        effort: Effort::Quick,
        missing: Missing::Run,
        rows: Vec::new(),
        out: "target/validation".into(),
        cache: cache.into(),
        threads: None,
        elsewhere: None,
        list: false,
        cases: Vec::new(),
    };
    while let Some(argument) = parser.next()? {
        match argument {
            Long("quick") => wish.effort = Effort::Quick,
            Long("full") => wish.effort = Effort::Full,
            Long("so-far") => wish.missing = Missing::LeaveOut,
            Long("only") => wish.rows.extend(parser.value()?.parse_with(rows)?),
            Long("out") => wish.out = parser.value()?.into(),
            Long("cache") => wish.cache = parser.value()?.into(),
            Long("threads") => wish.threads = Some(parser.value()?.parse()?),
            Long("on") => wish.elsewhere = command::on(&mut parser)?,
            Long("list") => wish.list = true,
            Long("case") => wish.cases.push(parser.value()?.parse_with(case)?),
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if wish.rows.is_empty() {
        wish.rows = ROWS.to_vec();
    }
    Ok(Some(wish))
}

/// The rows that `ids` names, with commas between them.
fn rows(ids: &str) -> Result<Vec<&'static Row>, String> {
    let find = |id: &str| {
        let row = ROWS.iter().find(|row| row.id.eq_ignore_ascii_case(id)).copied();
        let known = || ROWS.iter().map(|row| row.id).collect::<Vec<_>>().join(", ");
        row.ok_or_else(|| format!("no row is called `{id}`; there are {}", known()))
    };
    ids.split(',').map(str::trim).map(find).collect()
}

fn case(name: &str) -> Result<&'static Case, String> {
    let case = CASES.iter().find(|case| case.name == name).copied();
    let known = || CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
    case.ok_or_else(|| format!("no case is called `{name}`; there are {}", known()))
}

/// Runs `cases` and prints their numbers; whether every one is right.
fn show(cases: &[&Case]) -> bool {
    let mut holds = true;
    for case in cases {
        println!("## {}\n\n{}\n\n| what | measured | expected |", case.name, case.claim);
        println!("| --- | --- | --- |");
        for row in (case.run)() {
            println!("{}", row.markdown());
            holds &= row.holds();
        }
        println!();
    }
    holds
}

fn validate(wish: &Wish) -> Result<Verdict, Box<dyn Error>> {
    let workers = wish.threads.or(std::thread::available_parallelism().ok());
    let shapes = three_shapes::Places { out: wish.cache.join("shapes"), cache: wish.cache.clone() };
    let mut judged = Vec::with_capacity(wish.rows.len());
    for row in &wish.rows {
        let start = Instant::now();
        let teller = Teller { row: row.id, said: Mutex::new(None) };
        let laboratory = Laboratory {
            effort: wish.effort,
            missing: wish.missing,
            place: Place {
                cache: &wish.cache,
                workers,
                watch: &teller,
                elsewhere: wish.elsewhere.as_ref(),
            },
            shapes: shapes.clone(),
            sets: "validation/data".into(),
        };
        let one = Judged::by(row, &laboratory);
        println!(
            "{:4}{:14} {} ({:.0} s)",
            row.id,
            one.verdict(),
            row.title,
            start.elapsed().as_secs_f64()
        );
        if let Err(why) = &one.findings {
            eprintln!("error: {}: {why}", row.id);
        }
        judged.push(one);
        // What is judged so far stays, also where a later row is interrupted.
        write(&wish.out, &judged, wish.effort)?;
    }
    println!("{}", wish.out.join("REPORT.md").display());
    Ok(judged.iter().map(Judged::verdict).max().unwrap_or(Verdict::NotCheckable))
}

/// Writes what there is to `folder`.
fn write(folder: &Path, judged: &[Judged], effort: Effort) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    for figure in judged.iter().flat_map(|one| &one.findings).flat_map(|found| &found.figures) {
        fs::write(folder.join(&figure.file), &figure.svg)?;
    }
    fs::write(folder.join("validation.json"), format!("{:#}\n", to_json(judged, effort)))?;
    fs::write(folder.join("REPORT.md"), markdown(judged, effort))
}

/// Says how far a row has come, now and then.
struct Teller {
    row: &'static str,
    said: Mutex<Option<Instant>>,
}

impl Watch for Teller {
    fn progress(&self, progress: &Progress) {
        let Ok(mut said) = self.said.lock() else { return };
        if progress.done == progress.of || said.is_some_and(|last| last.elapsed() < EVERY) {
            return;
        }
        *said = Some(Instant::now());
        let what = match progress.what {
            Stage::Beds => "beds",
            Stage::Impacts => "impacts",
        };
        let left =
            progress.left.map_or_else(String::new, |left| format!(", {:.0} min left", left / 60.0));
        eprintln!("{}: {} of {} {what}{left}", self.row, progress.done, progress.of);
    }

    fn warn(&self, message: &str) {
        eprintln!("{}: {message}", self.row);
    }

    fn wants_to_stop(&self) -> bool {
        false
    }
}
