//! A table of numbers where a set or a model is expected: what it is, and what to type.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use configs::{printable, shorten};

use crate::output::{CommandError, CommandResult};

/// Endings of names that only tables have.
const ENDINGS: [&str; 4] = ["csv", "tsv", "tab", "dat"];

/// Endings of files that spreadsheets keep to themselves.
const SPREADSHEETS: [&str; 3] = ["xlsx", "xls", "ods"];

/// Rows that a table is known by.
const SAMPLE: usize = 20;

/// Most rows that are counted.
const MOST: usize = 10_000_000;

/// Most columns that are shown.
const SHOWN: usize = 12;

/// Programs whose tables are known by their head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Program {
    Tracker,
    TrackMate,
}

/// What is understood of a table.
#[derive(Debug, PartialEq)]
struct Found {
    program: Option<Program>,
    delimiter: char,
    columns: Vec<String>,
    rows: usize,
    decimal_commas: bool,
}

/// Refuses `path` if it is a table of numbers, with what it is and what to type instead.
///
/// # Errors
/// If it is one.
pub(crate) fn refuse(path: &Path) -> CommandResult {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let ending = ending.to_ascii_lowercase();
    if !path.is_file() || ["toml", "mcap", "json"].contains(&ending.as_str()) {
        return Ok(());
    }
    let name = printable(&path.display().to_string());
    if SPREADSHEETS.contains(&ending.as_str()) {
        return Err(CommandError::BadInput(format!(
            "error: {name} is a file of a spreadsheet, not a measurement set or a model\n{}",
            steps(&name)
        )));
    }
    let found = match read(path) {
        Some(found) => found,
        None if ENDINGS.contains(&ending.as_str()) => {
            return Err(CommandError::BadInput(format!(
                "error: {name} is called like a table, and no table can be read from it\n\
                 a table is text in UTF-8: a line of names, then rows of as many cells, separated by \
                 commas, semicolons or tabs\n"
            )));
        }
        None => return Ok(()),
    };
    Err(CommandError::BadInput(format!("error: {}\n{}", found.describe(&name), steps(&name))))
}

/// The table in the file at `path`, if it is one.
fn read(path: &Path) -> Option<Found> {
    let mut lines = BufReader::new(File::open(path).ok()?).lines();
    let mut head = Vec::new();
    // What is no text is no table.
    while head.len() < SAMPLE {
        let Some(line) = lines.next() else { break };
        let line = line.ok()?;
        let line = line.trim_start_matches('\u{feff}');
        if !line.trim().is_empty() && !line.starts_with('#') {
            head.push(line.trim_end_matches('\r').to_owned());
        }
    }
    let mut found = understand(&head)?;
    let rest = lines.take(MOST).map_while(Result::ok).filter(|line| !line.trim().is_empty());
    found.rows += rest.count();
    Some(found)
}

/// The table that begins with the lines `head`.
fn understand(head: &[String]) -> Option<Found> {
    let first = head.first()?.to_ascii_lowercase();
    let named = head.get(1).is_some_and(|line| cells(line, delimiter(line)).len() > 1);
    let (program, names, skipped) = match () {
        () if first.contains("track_id") && first.contains("position_x") => {
            let words = |line: &&String| numbers(&cells(line, delimiter(line))) == 0;
            let skipped = head.iter().take(4).take_while(words).count();
            (Some(Program::TrackMate), 0, skipped)
        }
        () if first.trim_start_matches(['\t', ',', ';']).starts_with("mass") && named => {
            (Some(Program::Tracker), 1, 2)
        }
        () => (None, 0, 1),
    };
    let delimiter = delimiter(head.get(names)?);
    let columns = cells(head.get(names)?, delimiter);
    let rows = head.get(skipped..)?;
    let like = |line: &&String| {
        let cells = cells(line, delimiter);
        cells.len() == columns.len() && 2 * numbers(&cells) >= cells.len()
    };
    let fitting = rows.iter().filter(like).count();
    // Decimal commas between commas make more cells than names.
    let broken = rows.iter().filter(|line| cells(line, delimiter).len() > columns.len()).count();
    let is_table = columns.len() > 1
        && !rows.is_empty()
        && (2 * fitting > rows.len() || (delimiter == ',' && broken == rows.len()));
    let commas = |line: &String| delimiter != ',' && line.contains(',');
    is_table.then(|| Found {
        program,
        delimiter,
        decimal_commas: rows.iter().any(commas),
        rows: rows.len(),
        columns,
    })
}

/// The separator that a line has most of.
fn delimiter(line: &str) -> char {
    let all = [';', '\t', ','];
    let tabs_or = |one: &char| line.matches(*one).count();
    all.into_iter().rev().max_by_key(tabs_or).unwrap_or(',')
}

fn cells(line: &str, delimiter: char) -> Vec<String> {
    line.split(delimiter).map(|cell| cell.trim().trim_matches('"').to_owned()).collect()
}

/// How many cells are numbers.
fn numbers(cells: &[String]) -> usize {
    let is_number = |cell: &&String| cell.replace(',', ".").parse::<f64>().is_ok();
    cells.iter().filter(is_number).count()
}

impl Found {
    fn describe(&self, name: &str) -> String {
        let (n, noun) = (self.rows, if self.rows == 1 { "row" } else { "rows" });
        let separated = match self.delimiter {
            ';' => "semicolons",
            '\t' => "tabs",
            _ => "commas",
        };
        let decimals = if self.decimal_commas { ", with decimal commas" } else { "" };
        let from = match self.program {
            Some(Program::Tracker) => " that Tracker exported",
            Some(Program::TrackMate) => " of spots that TrackMate exported",
            None => "",
        };
        let columns: Vec<String> =
            self.columns.iter().take(SHOWN).map(|name| printable(&shorten(name))).collect();
        let more = if self.columns.len() > SHOWN { ", …" } else { "" };
        format!(
            "{name} is a table{from}, not a measurement set or a model\n  {n} {noun} of {} columns \
             separated by {separated}{decimals}: {}{more}",
            self.columns.len(),
            columns.join(", ")
        )
    }
}

/// What to type to make a set of a table.
fn steps(name: &str) -> String {
    format!(
        "  plunge import {name} -o my-drops --diameter 25.4mm --mass \"67 g\"\n  makes a measurement set of it, and of all \
         tables that are named with it; then plunge diagnose my-drops\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn separators_decimals_and_programs_are_found_out() {
        let drops = understand(&lines("t (ms);y1 (cm);y2 (cm)\n0;18,4;18,4\n1,5;18,2;18,1\n"));
        let drops = drops.expect("a table");
        assert_eq!((drops.delimiter, drops.rows, drops.decimal_commas), (';', 2, true));
        let tracker = understand(&lines("mass A\nt\tx\ty\n0.0\t1E-2\t0.2\n0.1\t1E-2\t0.19\n"));
        let tracker = tracker.expect("a table");
        assert_eq!((tracker.program, tracker.rows), (Some(Program::Tracker), 2));
        let spots = "LABEL,ID,TRACK_ID,POSITION_X,POSITION_Y,POSITION_T\nLabel,Spot ID,Track ID,X,Y,T\n\
                     Label,Spot ID,Track ID,X,Y,T\n,,,(mm),(mm),(sec)\nID1,1,0,1.5,2.5,0\n";
        let spots = understand(&lines(spots)).expect("a table");
        assert_eq!((spots.program, spots.rows), (Some(Program::TrackMate), 1));
        assert_eq!(
            understand(&lines("t,y\n0,5,18,4\n1,5,18,2\n")).map(|found| found.rows),
            Some(2)
        );
    }

    #[test]
    fn what_is_toml_or_prose_is_no_table() {
        for text in [
            "schema = 1\n[run]\nname = \"a\"\nlist = [1, 2, 3]\n",
            "Once, a ball fell.\nIt fell, and fell.\nThen it rested.\n",
            "",
            "t,y\n",
        ] {
            assert_eq!(understand(&lines(text)), None, "{text}");
        }
    }
}
