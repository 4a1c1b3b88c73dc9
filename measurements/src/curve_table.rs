//! Tables of curves: one row for each reading, in long form.

use std::collections::BTreeMap;
use std::io::BufRead;

use configs::Diagnostic;

use super::cells::Cell;
use super::curve::Curve;
use super::document::Missing;
use super::findings::Findings;
use super::row::{Row, file_name};
use super::table::{Format, Table};
use super::trajectories::{MOST, Source, run, tell_holes};
use super::{Run, Sample};

// The places of the columns of every kind.
const RUN: usize = 0;
const AT: usize = 1;
const VALUE: usize = 2;
const SIGMA: usize = 3;

/// Reads the readings of `curve` into their runs, after `before` rows of other tables; faults are reported. Gives
/// what is understood of the table, `None` if nothing of it can be read.
pub(super) fn read(
    curve: &'static Curve,
    source: Source<'_, impl BufRead>,
    runs: &mut [Run],
    (format, missing): (&Format, Missing),
    (before, findings): (&mut usize, &mut Findings),
) -> Option<String> {
    let mut row = Row::default();
    let index: BTreeMap<String, usize> =
        runs.iter().enumerate().map(|(index, run)| (run.name.clone(), index)).collect();
    let only = source.run(&index).filter(|_| source.is_one_of > 1 || runs.len() == 1);
    let (name, columns) = (source.name, curve.columns[usize::from(only.is_some())]);
    let mut table = Table::open((name, source.reader), columns, format, &mut row, findings)?;
    let only = only.filter(|_| !table.has(RUN));
    let (mut rows, mut holes) = (0, Vec::new());
    while table.next(&mut row, findings) {
        rows += 1;
        if *before + rows > MOST {
            findings.report(
                Diagnostic::error(format!("{} has more than {MOST} rows", file_name(name)))
                    .help("keep every second or tenth row: neighbouring readings say the same"),
            );
            break;
        }
        let run = only.or_else(|| run(&table, &row, &index, findings));
        let mut hole = false;
        let mut number = |key, required: bool| match table.quantity(&row, key, findings) {
            Cell::Value(value) => Some(value),
            Cell::Empty if !required => None,
            Cell::Empty | Cell::Missing => {
                hole = true;
                None
            }
            Cell::Wrong => None,
        };
        let [at, value, sigma] = [(AT, true), (VALUE, true), (SIGMA, false)]
            .map(|(key, required)| number(key, required));
        if hole {
            holes.push(row.line);
            continue;
        }
        let (Some(run), Some(at), Some(value)) = (run, at, value) else { continue };
        if sigma.is_some_and(|sigma| sigma <= 0.0) {
            let span = table.place(&row, SIGMA, findings);
            let expected = "expected a number above 0; leave it empty if it is not known";
            findings.report(Diagnostic::error("an error that is not above 0").at(span, expected));
        }
        runs[run].samples.push(Sample { at, value, sigma });
    }
    if rows == 0 && findings.errors() == 0 {
        findings
            .report(Diagnostic::error(format!("{} has no row below its header", file_name(name))));
    }
    *before += rows;
    tell_holes(&holes, name, missing, findings);
    Some(table.describe())
}
