//! `cargo xtask validate`: runs the cases and holds what comes out against what is right.

#![allow(clippy::print_stdout, reason = "stdout is where a command's result belongs")]

use std::process::ExitCode;

use engine::parallel::with_threads;
use serde_json::{Value, json};
use validation::{CASES, Case, Expected, Outcome};

const HELP: &str = "\
Runs cases whose answer is known and compares.

Usage: cargo xtask validate [--only NAME] [--json | --markdown] [--list]

  --only NAME  one case; may be given several times
  --json       one JSON document instead of tables
  --markdown   the tables as they stand in the documents
  --list       the names and claims of the cases, without running them

Exit status: 0 all rows hold, 1 a row does not, 2 the command line was not understood.
";

/// What the command line asks for.
#[derive(Default)]
struct Wish {
    only: Vec<String>,
    format: Format,
    list: bool,
    help: bool,
}

/// How results are shown.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Format {
    #[default]
    Text,
    Json,
    Markdown,
}

fn main() -> ExitCode {
    let cases = parse(std::env::args().skip(1)).and_then(|wish| Ok((chosen(&wish.only)?, wish)));
    let (cases, wish) = match cases {
        Ok(both) => both,
        Err(message) => {
            eprintln!("error: {message}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    if wish.help {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    if wish.list {
        for case in cases {
            println!("{}\n    {}", case.name, case.claim);
        }
        return ExitCode::SUCCESS;
    }
    // A few grains are no work for more than one thread.
    match with_threads(1, || report(&cases, wish.format)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn parse(mut args: impl Iterator<Item = String>) -> Result<Wish, String> {
    let mut wish = Wish::default();
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--only" => wish.only.push(args.next().ok_or("`--only` needs the name of a case")?),
            "--json" => wish.format = Format::Json,
            "--markdown" => wish.format = Format::Markdown,
            "--list" => wish.list = true,
            "-h" | "--help" => wish.help = true,
            other => return Err(format!("`{other}` is not understood")),
        }
    }
    Ok(wish)
}

/// The cases called `names`, or all.
fn chosen(names: &[String]) -> Result<Vec<&'static Case>, String> {
    if names.is_empty() {
        return Ok(CASES.to_vec());
    }
    let find = |name: &String| {
        let case = CASES.iter().find(|case| case.name == name).copied();
        let known = || CASES.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
        case.ok_or_else(|| format!("no case is called `{name}`; there are {}", known()))
    };
    names.iter().map(find).collect()
}

/// Runs and prints; returns whether every row holds.
fn report(cases: &[&Case], format: Format) -> bool {
    let mut all_hold = true;
    let mut documents = Vec::new();
    for case in cases {
        match format {
            Format::Text => println!("{}\n  {}", case.name, case.claim),
            Format::Markdown => println!("## {}\n\n{}\n", case.name, case.claim),
            Format::Json => {}
        }
        let rows = (case.run)();
        all_hold &= rows.iter().all(Outcome::holds);
        match format {
            Format::Json => {
                let rows: Vec<Value> = rows.iter().map(to_json).collect();
                documents.push(json!({ "case": case.name, "claim": case.claim, "rows": rows }));
            }
            Format::Text => rows.iter().for_each(print_row),
            Format::Markdown => {
                println!("| what | measured | expected |\n| --- | --- | --- |");
                rows.iter().for_each(|row| println!("{}", row.markdown()));
            }
        }
        if format != Format::Json {
            println!();
        }
    }
    match format {
        Format::Json => println!("{:#}", json!({ "holds": all_hold, "cases": documents })),
        Format::Text if all_hold => println!("every row holds"),
        Format::Text => println!("a row does not hold"),
        Format::Markdown => {}
    }
    all_hold
}

fn print_row(row: &Outcome) {
    let mark = if row.holds() { "ok   " } else { "FAILS" };
    println!("  {mark} {:72} {:>13.6e}  {}", row.what, row.measured, row.expected);
    if !row.holds() {
        println!("        the tolerance: {}", row.why);
    }
}

fn to_json(row: &Outcome) -> Value {
    let expected = match row.expected {
        Expected::Near { value, tolerance } => json!({ "value": value, "tolerance": tolerance }),
        Expected::AtMost(limit) => json!({ "at_most": limit }),
        Expected::AtLeast(limit) => json!({ "at_least": limit }),
    };
    json!({
        "what": row.what,
        "measured": row.measured,
        "expected": expected,
        "why": row.why,
        "holds": row.holds(),
    })
}
