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
use runner::beds::Place;
use runner::{Elsewhere, Progress, Stage, Watch};
use validation::published::{
    Effort, Judged, Laboratory, Missing, ROWS, Row, Verdict, checks_csv, markdown, tally, to_json,
};
use validation::{CASES, Case, command, three_shapes};

const HELP: &str = "\
The published results, run again and judged.

Usage: cargo xtask validate [--quick | --full] [--so-far] [--only ID[,ID]...]... [--out DIR]
                            [--cache DIR] [--threads N] [--on WHERE] [--expect ID=VERDICT[,...]]...
                            [--list] [--case NAME]...

  --quick      every row at a reduced cost (default): under ten minutes on two cores, if its beds are there
  --full       what the sources ran: hours; impacts that are there are not run again
  --so-far     runs no impact: judges those that are there, while others are still being run
  --only ID    these rows only; may be given several times
  --out DIR    where validation.json, checks.csv, REPORT.md and figures are written (target/validation)
  --cache DIR  where beds and impacts are kept (else $PLUNGE_CACHE, else runs/.cache)
  --threads N  impacts at a time (one per core)
  --on WHERE   where impacts are run: local (default), slurm or hyperqueue, which are waited for
  --expect E   instead of failing where a row fails, fails where the verdict of a row is not the expected one,
               better or worse: ID=VERDICT of every row that is judged, with commas between them
  --list       the rows, without running them
  --case NAME  instead, every number of a case with a known answer, as the documents have it; may be
               given several times

Exit status: 0 no row fails, 1 one does or could not be run, 2 the command line was not understood. With --expect: 0 every
verdict is the expected one, 1 one is not.
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
    expected: Vec<(&'static str, Verdict)>,
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
        [] => validate(&wish),
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
        expected: Vec::new(),
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
            Long("expect") => wish.expected.extend(parser.value()?.parse_with(expected)?),
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

/// The verdicts that `list` expects, as in `E9=pass,E14=fail`.
fn expected(list: &str) -> Result<Vec<(&'static str, Verdict)>, String> {
    let one = |pair: &str| {
        let (id, word) = pair.split_once('=').ok_or(format!("`{pair}` is no ID=VERDICT"))?;
        let verdict = Verdict::ALL.into_iter().find(|verdict| verdict.name() == word.trim());
        let known = || Verdict::ALL.map(Verdict::name).join(", ");
        let verdict =
            verdict.ok_or_else(|| format!("`{word}` is no verdict; there are {}", known()))?;
        Ok(rows(id)?.into_iter().map(|row| (row.id, verdict)).collect())
    };
    let pairs: Result<Vec<Vec<_>>, String> = list.split(',').map(one).collect();
    Ok(pairs?.concat())
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

/// Judges the rows and prints the count, then a line of each; whether they are as they should be.
fn validate(wish: &Wish) -> Result<bool, Box<dyn Error>> {
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
        eprintln!("{}: {} ({:.0} s)", row.id, one.verdict(), start.elapsed().as_secs_f64());
        if let Err(why) = &one.findings {
            eprintln!("error: {}: {why}", row.id);
        }
        judged.push(one);
        // What is judged so far stays, also where a later row is interrupted.
        write(&wish.out, &judged, wish.effort)?;
    }
    println!("{}", tally(&judged));
    for one in &judged {
        println!("{:4}{:14} {}", one.row.id, one.verdict(), one.row.title);
    }
    println!("{}", wish.out.join("REPORT.md").display());
    if wish.expected.is_empty() {
        return Ok(judged.iter().all(|one| one.verdict() < Verdict::Fail));
    }
    let found: Vec<_> = judged.iter().map(|one| (one.row.id, one.verdict())).collect();
    let surprises = surprises(&wish.expected, &found);
    surprises.iter().for_each(|surprise| eprintln!("error: {surprise}"));
    Ok(surprises.is_empty())
}

/// What is not as `expected` in the verdicts `found`, row by row.
fn surprises(expected: &[(&str, Verdict)], found: &[(&str, Verdict)]) -> Vec<String> {
    let of = |list: &[(&str, Verdict)], id: &str| {
        list.iter().find(|(own, _)| *own == id).map(|(_, verdict)| *verdict)
    };
    let judged = found.iter().filter_map(|(id, verdict)| match of(expected, id) {
        None => Some(format!("{id}: {verdict}, and no verdict is expected of it")),
        Some(wanted) if wanted != *verdict => {
            Some(format!("{id}: {verdict}, where {wanted} is expected"))
        }
        Some(_) => None,
    });
    let not_judged = expected.iter().filter(|(id, _)| of(found, id).is_none());
    judged.chain(not_judged.map(|(id, _)| format!("{id}: expected, and not judged"))).collect()
}

/// Writes what there is to `folder`.
fn write(folder: &Path, judged: &[Judged], effort: Effort) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    for figure in judged.iter().flat_map(|one| &one.findings).flat_map(|found| &found.figures) {
        fs::write(folder.join(&figure.file), &figure.svg)?;
    }
    fs::write(folder.join("validation.json"), format!("{:#}\n", to_json(judged, effort)))?;
    let checks = checks_csv(judged).map_err(std::io::Error::other)?;
    fs::write(folder.join("checks.csv"), checks)?;
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
        let minutes = |left: Duration| format!(", {:.0} min left", left.as_secs_f64() / 60.0);
        let left = progress.left.map_or_else(String::new, minutes);
        eprintln!("{}: {} of {} {what}{left}", self.row, progress.done, progress.of);
    }

    fn warn(&self, message: &str) {
        eprintln!("{}: {message}", self.row);
    }

    fn wants_to_stop(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_that_changes_is_a_surprise_in_either_direction() {
        let expected = expected("e9=pass, E14=fail").expect("both are rows");
        let found = |e9, e14| surprises(&expected, &[("E9", e9), ("E14", e14)]);
        assert_eq!(found(Verdict::Pass, Verdict::Fail), Vec::<String>::new());
        assert_eq!(found(Verdict::Fail, Verdict::Fail), ["E9: fail, where pass is expected"]);
        assert_eq!(found(Verdict::Pass, Verdict::Pass), ["E14: pass, where fail is expected"]);
    }

    #[test]
    fn a_row_without_an_expectation_and_one_that_was_not_judged_are_surprises() {
        let expected = expected("E9=pass").expect("a row");
        let found = surprises(&expected, &[("E1", Verdict::Pass)]);
        assert_eq!(found.len(), 2, "{found:?}");
    }

    #[test]
    fn an_expectation_of_no_row_or_no_verdict_is_not_understood() {
        for wrong in ["E9", "E9=good", "E0=pass"] {
            assert!(expected(wrong).is_err(), "{wrong}");
        }
    }
}
