//! `cargo xtask validate`: the published results, run again and judged.

use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::Parser;
use engine::parallel::with_threads;
use runner::beds::Place;
use runner::{Progress, Stage, Watch, cache_folder};
use validation::command::{Impacts, conclude};
use validation::published::{
    Effort, Judged, Laboratory, Missing, ROWS, Row, Verdict, checks_csv, markdown, tally, to_json,
};
use validation::{CASES, Case, three_shapes};

/// What the status means.
const STATUS: &str = "\
Exit status: 0 no row fails, 1 one does or could not be run, 2 the command line was not understood. With --expect: 0 every
verdict is the expected one, 1 one is not.";

/// Time between two lines of progress.
const EVERY: Duration = Duration::from_secs(10);

/// The published results, run again and judged.
#[derive(Parser)]
#[command(bin_name = "cargo xtask validate", max_term_width = 100, after_help = STATUS)]
struct Wish {
    /// Every row at a reduced cost (default): under ten minutes on two cores, if its beds are there
    #[arg(long = "quick", overrides_with = "full")]
    _quick: bool,
    /// What the sources ran: hours; impacts that are there are not run again
    #[arg(long, overrides_with = "_quick")]
    full: bool,
    /// Runs no impact: judges those that are there, while others are still being run
    #[arg(long)]
    so_far: bool,
    /// These rows only, with commas between them; may be given several times
    #[arg(long, value_name = "ID", value_parser = rows)]
    only: Vec<Rows>,
    /// Where validation.json, checks.csv, REPORT.md and figures are written
    #[arg(long, value_name = "DIR", default_value = "target/validation")]
    out: PathBuf,
    /// Where beds and impacts are kept (else $PLUNGE_CACHE, else runs/.cache)
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    impacts: Impacts,
    /// Instead of failing where a row fails, fails where the verdict of a row is not the expected one, better or
    /// worse: ID=VERDICT of every row that is judged, with commas between them
    #[arg(long, value_name = "E", value_parser = expected)]
    expect: Vec<Expected>,
    /// The rows, without running them
    #[arg(long)]
    list: bool,
    /// Instead, every number of a case with a known answer, as the documents have it; may be given several times
    #[arg(long = "case", value_name = "NAME", value_parser = case)]
    cases: Vec<&'static Case>,
}

type Rows = Vec<&'static Row>;
type Expected = Vec<(&'static str, Verdict)>;

fn main() -> ExitCode {
    conclude(|wish: &Wish, out| {
        let rows = if wish.only.is_empty() { ROWS.to_vec() } else { wish.only.concat() };
        if wish.list {
            for Row { id, title, source, how: [quick, full], .. } in &rows {
                writeln!(out, "{id}: {title}\n    {source}\n    quick: {quick}\n    full: {full}")?;
            }
            return Ok(ExitCode::SUCCESS);
        }
        let is_well = match &wish.cases[..] {
            [] => validate(wish, &rows, out)?,
            cases => show(cases, out)?,
        };
        Ok(if is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    })
}

/// The rows that `ids` names, with commas between them.
fn rows(ids: &str) -> Result<Rows, String> {
    let find = |id: &str| {
        let row = ROWS.iter().find(|row| row.id.eq_ignore_ascii_case(id)).copied();
        let known = || ROWS.iter().map(|row| row.id).collect::<Vec<_>>().join(", ");
        row.ok_or_else(|| format!("no row is called `{id}`; there are {}", known()))
    };
    ids.split(',').map(str::trim).map(find).collect()
}

/// The verdicts that `list` expects, as in `E9=pass,E14=fail`.
fn expected(list: &str) -> Result<Expected, String> {
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
fn show(cases: &[&Case], out: &mut dyn Write) -> Result<bool, Box<dyn Error>> {
    let mut holds = true;
    for case in cases {
        writeln!(out, "## {}\n\n{}\n\n| what | measured | expected |", case.name, case.claim)?;
        writeln!(out, "| --- | --- | --- |")?;
        for row in with_threads(1, case.run)? {
            writeln!(out, "{}", row.markdown())?;
            holds &= row.holds();
        }
        writeln!(out)?;
    }
    Ok(holds)
}

/// Judges the rows and prints the count, then a line of each; whether they are as they should be.
fn validate(
    wish: &Wish,
    rows: &[&'static Row],
    out: &mut dyn Write,
) -> Result<bool, Box<dyn Error>> {
    let effort = if wish.full { Effort::Full } else { Effort::Quick };
    let workers = wish.impacts.threads.or(std::thread::available_parallelism().ok());
    let cache = cache_folder(wish.cache.as_deref());
    let shapes = three_shapes::Places { out: cache.join("shapes"), cache: cache.clone() };
    let expected = wish.expect.concat();
    let mut judged = Vec::with_capacity(rows.len());
    for row in rows {
        let start = Instant::now();
        let teller = Teller { row: row.id, said: Mutex::new(None) };
        let laboratory = Laboratory {
            effort,
            missing: if wish.so_far { Missing::LeaveOut } else { Missing::Run },
            place: Place {
                cache: &cache,
                workers,
                watch: &teller,
                elsewhere: wish.impacts.elsewhere(),
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
        write(&wish.out, &judged, effort)?;
    }
    writeln!(out, "{}", tally(&judged))?;
    for one in &judged {
        writeln!(out, "{:4}{:14} {}", one.row.id, one.verdict(), one.row.title)?;
    }
    writeln!(out, "{}", wish.out.join("REPORT.md").display())?;
    if expected.is_empty() {
        return Ok(judged.iter().all(|one| one.verdict() < Verdict::Fail));
    }
    let found: Vec<_> = judged.iter().map(|one| (one.row.id, one.verdict())).collect();
    let surprises = surprises(&expected, &found);
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
