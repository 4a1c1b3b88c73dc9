//! `runs.csv`: one row for each run.

use std::collections::BTreeMap;
use std::io::BufRead;

use configs::{Diagnostic, shorten};

use crate::document::Missing;
use crate::table::cells::Cell;
use crate::table::columns::RUNS;
use crate::table::findings::{Findings, lines_in_words, nearest_name};
use crate::table::row::{Row, file_name};
use crate::table::{Format, Table};
use crate::{Condition, Crater, Run};

/// Most runs of a set.
const MOST: usize = 100_000;

// The places of the columns in [`RUNS`].
const RUN: usize = 0;
const CONDITION: usize = 1;
const REPEAT: usize = 2;
const ORDER: usize = 3;
const SESSION: usize = 4;
const STOP_TIME: usize = 5;
const FINAL_Z: usize = 6;
const FINAL_X: usize = 7;
const T_ZERO: usize = 8;
const Z_ZERO: usize = 9;
const CRATER_DEPTH: usize = 10;
const RIM_DIAMETER: usize = 11;

/// Runs, and what is understood of their table.
pub(crate) struct Runs {
    /// In the order of the file, without frames.
    pub(crate) runs: Vec<Run>,
    /// What the columns t and z read (SI) at first contact and at the surface, run by run.
    pub(crate) zeros: Vec<[f64; 2]>,
    /// The columns.
    pub(crate) columns: String,
}

/// Reads the table of runs; faults are reported. `None` if nothing of it can be read.
pub(crate) fn read(
    (name, reader): (&str, impl BufRead),
    conditions: &[Condition],
    format: &Format,
    missing: Missing,
    findings: &mut Findings,
) -> Option<Runs> {
    let mut row = Row::default();
    let mut table = Table::open((name, reader), &RUNS, format, &mut row, findings)?;
    let index: BTreeMap<&str, usize> =
        conditions.iter().enumerate().map(|(index, one)| (one.id.as_str(), index)).collect();
    let mut lines = BTreeMap::<String, u64>::new();
    let (mut runs, mut zeros) = (Vec::new(), Vec::new());
    let mut marks = Vec::new();
    while table.next(&mut row, findings) {
        if runs.len() == MOST {
            findings.report(Diagnostic::error(format!(
                "{} has more than {MOST} rows",
                file_name(name)
            )));
            break;
        }
        let run = table.text(&row, RUN).to_owned();
        let condition = condition(&table, &row, &index, findings);
        let repeat = table.count(&row, REPEAT, findings);
        let order = table.count(&row, ORDER, findings);
        let session = Some(table.text(&row, SESSION)).filter(|name| !name.is_empty());
        let session = session.map(str::to_owned);
        let mut number = |key| match table.quantity(&row, key, findings) {
            Cell::Value(value) => Some(value),
            Cell::Missing => {
                marks.push((row.line, key));
                None
            }
            Cell::Empty | Cell::Wrong => None,
        };
        let [stop_time, final_z, final_x] = [STOP_TIME, FINAL_Z, FINAL_X].map(&mut number);
        let [depth, rim_diameter] = [CRATER_DEPTH, RIM_DIAMETER].map(&mut number);
        let [t_zero, z_zero] = [T_ZERO, Z_ZERO].map(|key| number(key).unwrap_or(0.0));
        if let Some(first) = lines.get(&run) {
            let span = table.place(&row, RUN, findings);
            findings.report(
                Diagnostic::error(format!("the run `{}` is listed twice", shorten(&run)))
                    .at(span, format!("it is also on line {first}")),
            );
        }
        if run.is_empty() {
            let span = table.place(&row, RUN, findings);
            findings.report(Diagnostic::error("a run without a name").at(span, "expected a name"));
        }
        if let Some(value) = stop_time.filter(|value| *value < 0.0) {
            let span = table.place(&row, STOP_TIME, findings);
            findings.report(
                Diagnostic::error(format!("a stopping time of {value} s"))
                    .at(span, "expected 0 s or more, counted from first contact"),
            );
        }
        lines.insert(run.clone(), row.line);
        let Some(condition) = condition else { continue };
        let frames = Vec::new();
        zeros.push([t_zero, z_zero]);
        runs.push(Run {
            name: run,
            condition,
            repeat,
            order,
            session,
            stop_time,
            final_z,
            final_x,
            crater: Crater { depth, rim_diameter },
            frames,
            samples: Vec::new(),
        });
    }
    if lines.is_empty() && findings.errors() == 0 {
        findings
            .report(Diagnostic::error(format!("{} has no row below its header", file_name(name))));
    }
    tell_marks(&marks, name, missing, findings);
    Some(Runs { runs, zeros, columns: table.describe() })
}

/// The index of the condition of a row; an unknown one is reported.
fn condition(
    table: &Table<impl BufRead>,
    row: &Row,
    index: &BTreeMap<&str, usize>,
    findings: &mut Findings,
) -> Option<usize> {
    let name = table.text(row, CONDITION);
    let found = index.get(name).copied();
    if found.is_none() {
        let label = match nearest_name(name, index.keys().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "not the id of a [[condition]]".to_owned(),
        };
        let span = table.place(row, CONDITION, findings);
        let known: Vec<&str> = index.keys().take(20).copied().collect();
        findings.report(
            Diagnostic::error(format!("there is no condition `{}`", shorten(name)))
                .at(span, label)
                .help(format!("conditions of the set: {}", known.join(", "))),
        );
    }
    found
}

/// Refuses or notes marks such as NaN, which leave open whether something was measured.
fn tell_marks(marks: &[(u64, usize)], name: &str, missing: Missing, findings: &mut Findings) {
    if marks.is_empty() {
        return;
    }
    let lines: Vec<u64> = marks.iter().map(|(line, _)| *line).collect();
    let (n, lines, name) = (marks.len(), lines_in_words(&lines), file_name(name));
    match missing {
        Missing::Drop => findings
            .note(format!("{n} cells of {name} without a number count as not measured: {lines}.")),
        Missing::Error => findings.report(
            Diagnostic::error(format!("{name}: {n} cells hold no number: {lines}")).help(
                "leave a cell empty when it was not measured, \
                 or write missing = \"drop\" below [files]",
            ),
        ),
    }
}
