//! `trajectories.csv`, or several such tables: one row for each reading, in long form.

use std::collections::BTreeMap;
use std::io::BufRead;

use configs::{Diagnostic, shorten};

use crate::document::Missing;
use crate::table::cells::Cell;
use crate::table::columns::{ColumnSpec, OF_ONE_RUN, TRAJECTORIES, VERTICAL, VERTICAL_OF_ONE_RUN};
use crate::table::findings::{Findings, lines_in_words, nearest_name};
use crate::table::row::{Row, file_name};
use crate::table::{Format, Table};
use crate::{Frame, Run};

/// Most readings of a set: at 40 bytes each, and twice that while a list grows, they stay below
/// 200 MB.
pub const MOST_READINGS: usize = 2_000_000;

// The places of the columns in [`TRAJECTORIES`].
const RUN: usize = 0;
const T: usize = 1;
const Z: usize = 2;
const X: usize = 3;
const SIGMA: usize = 4;

/// A table of trajectories, and what is known of it before it is read.
pub(crate) struct Source<'a, R> {
    /// What messages call it.
    pub(crate) name: &'a str,
    pub(crate) reader: R,
    /// How many such tables the set has.
    pub(crate) is_one_of: usize,
    /// Whether all impacts of the set are vertical, and `x` may be left out.
    pub(crate) is_vertical: bool,
}

impl<R> Source<'_, R> {
    /// The run that the whole table is of where it has no column of runs: that of its name.
    pub(crate) fn run(&self, index: &BTreeMap<String, usize>) -> Option<usize> {
        let name = file_name(self.name);
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        index.get(stem).or_else(|| index.get(name)).copied()
    }

    fn columns(&self, is_of_one_run: bool) -> &'static [ColumnSpec] {
        match (is_of_one_run, self.is_vertical) {
            (true, true) => &VERTICAL_OF_ONE_RUN,
            (true, false) => &OF_ONE_RUN,
            (false, true) => &VERTICAL,
            (false, false) => &TRAJECTORIES,
        }
    }
}

/// Reads the readings into their runs, after `before` rows of other tables; faults are reported. Gives what
/// is understood of the table, `None` if nothing of it can be read.
pub(crate) fn read(
    source: Source<'_, impl BufRead>,
    runs: &mut [Run],
    (format, missing): (&Format, Missing),
    (before, findings): (&mut usize, &mut Findings),
) -> Option<String> {
    let (mut row, name) = (Row::default(), source.name);
    let known = (&*runs, *before);
    let mut readings =
        Readings::open(source, Source::columns, known, format, (&mut row, findings))?;
    let has_x = readings.table.has(X);
    // The time and the line of the last reading of every run; line 0 is that of an earlier table.
    let mut last: Vec<Option<(f64, u64)>> =
        runs.iter().map(|run| run.frames.last().map(|frame| (frame.t, 0))).collect();
    let mut zeros = 0;
    while let Some(run) = readings.next(&mut row, findings) {
        let columns = [(T, true), (Z, true), (X, has_x), (SIGMA, false)];
        let Some([t, z, x, sigma]) = readings.numbers(columns, &row, findings) else { continue };
        // Where all impacts are vertical nothing moves along the surface.
        let x = if has_x { x } else { Some(0.0) };
        let (Some(run), Some(t), Some(z), Some(x)) = (run, t, z, x) else { continue };
        if sigma.is_some_and(|sigma| sigma < 0.0) {
            let span = readings.table.place(&row, SIGMA, findings);
            let wanted = "expected a number above 0; leave it empty if it is not known";
            findings.report(Diagnostic::error("a negative error").at(span, wanted));
        }
        zeros += usize::from(sigma == Some(0.0));
        if let Some((before, line)) = last[run].filter(|(before, _)| *before >= t) {
            let what = match before > t {
                true => format!("the time runs back in the run `{}`", shorten(&runs[run].name)),
                false => {
                    format!("a time is listed twice in the run `{}`", shorten(&runs[run].name))
                }
            };
            let span = readings.table.place(&row, T, findings);
            let place = match line {
                0 => "an earlier table".to_owned(),
                line => format!("line {line}"),
            };
            findings.report(Diagnostic::error(what).at(span, format!("{place} has {before} s")));
        }
        last[run] = Some((t, row.line));
        runs[run].frames.push(Frame { t, z, x, sigma: sigma.filter(|sigma| *sigma > 0.0) });
    }
    if zeros > 0 {
        let table = file_name(name);
        findings.note(format!("An error of zero is taken as not stated: {zeros} rows of {table}."));
    }
    Some(readings.conclude(missing, (before, findings)))
}

/// The rows of a table in long form, each with the run that it is of.
pub(crate) struct Readings<'a, R> {
    pub(crate) table: Table<R>,
    name: &'a str,
    index: BTreeMap<String, usize>,
    /// The run of every row, where the table has no column of runs.
    only: Option<usize>,
    /// Rows of this table so far, and of earlier ones.
    rows: usize,
    before: usize,
    /// Lines of rows that lack a number.
    holes: Vec<u64>,
}

impl<'a, R: BufRead> Readings<'a, R> {
    /// The rows of `source`, whose columns are those that `columns` gives for a table of one run or of several; `before`
    /// rows of other tables have been read. `None` if nothing of it can be read; that is reported.
    pub(crate) fn open(
        source: Source<'a, R>,
        columns: impl Fn(&Source<'a, R>, bool) -> &'static [ColumnSpec],
        (runs, before): (&[Run], usize),
        format: &Format,
        (row, findings): (&mut Row, &mut Findings),
    ) -> Option<Self> {
        let index: BTreeMap<String, usize> =
            runs.iter().enumerate().map(|(index, run)| (run.name.clone(), index)).collect();
        let only = source.run(&index).filter(|_| source.is_one_of > 1 || runs.len() == 1);
        let (columns, name) = (columns(&source, only.is_some()), source.name);
        let table = Table::open((name, source.reader), columns, format, row, findings)?;
        let only = only.filter(|_| !table.has(RUN));
        Some(Self { table, name, index, only, rows: 0, before, holes: Vec::new() })
    }

    /// Puts the next row into `row` and gives its run, if it has one; `None` at the end, and where there are too many rows.
    pub(crate) fn next(&mut self, row: &mut Row, findings: &mut Findings) -> Option<Option<usize>> {
        if !self.table.next(row, findings) {
            return None;
        }
        self.rows += 1;
        if self.before + self.rows > MOST_READINGS {
            let what = format!("{} has more than {MOST_READINGS} rows", file_name(self.name));
            findings.report(
                Diagnostic::error(what)
                    .help("keep every second or tenth row: neighbouring readings say the same"),
            );
            return None;
        }
        Some(self.only.or_else(|| run(&self.table, row, &self.index, findings)))
    }

    /// The numbers of `row` in these columns, each required or not; `None` where one that is required is missing.
    pub(crate) fn numbers<const N: usize>(
        &mut self,
        columns: [(usize, bool); N],
        row: &Row,
        findings: &mut Findings,
    ) -> Option<[Option<f64>; N]> {
        let mut hole = false;
        let numbers =
            columns.map(|(key, required)| match self.table.quantity(row, key, findings) {
                Cell::Value(value) => Some(value),
                Cell::Empty if !required => None,
                Cell::Empty | Cell::Missing => {
                    hole = true;
                    None
                }
                Cell::Wrong => None,
            });
        if hole {
            self.holes.push(row.line);
        }
        (!hole).then_some(numbers)
    }

    /// Tells of rows that lack numbers, or that there is no row, and what is understood of the table; counts its rows.
    pub(crate) fn conclude(
        self,
        missing: Missing,
        (before, findings): (&mut usize, &mut Findings),
    ) -> String {
        if self.rows == 0 && findings.errors() == 0 {
            let what = format!("{} has no row below its header", file_name(self.name));
            findings.report(Diagnostic::error(what));
        }
        *before += self.rows;
        tell_holes(&self.holes, self.name, missing, findings);
        self.table.describe()
    }
}

/// The index of the run of a row; an unknown one is reported.
fn run(
    table: &Table<impl BufRead>,
    row: &Row,
    index: &BTreeMap<String, usize>,
    findings: &mut Findings,
) -> Option<usize> {
    let name = table.text(row, RUN);
    let found = index.get(name).copied();
    if found.is_none() {
        let label = match nearest_name(name, index.keys().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "not in the table of runs".to_owned(),
        };
        let span = table.place(row, RUN, findings);
        findings.report(
            Diagnostic::error(format!("there is no run `{}`", shorten(name))).at(span, label),
        );
    }
    found
}

/// Refuses or notes rows without a place or a reading.
fn tell_holes(holes: &[u64], name: &str, missing: Missing, findings: &mut Findings) {
    if holes.is_empty() {
        return;
    }
    let (n, lines, name) = (holes.len(), lines_in_words(holes), file_name(name));
    let rows = if n == 1 { "row" } else { "rows" };
    match missing {
        Missing::Drop => {
            findings.note(format!("{n} {rows} of {name} without a number were dropped: {lines}."));
        }
        Missing::Error => findings.report(
            Diagnostic::error(format!("{name}: {n} {rows} without a number: {lines}"))
                .help("write missing = \"drop\" below [files] to go on without these rows"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, BufReader, Read};

    use super::*;

    /// A table without an end.
    struct Endless {
        row: u64,
        rest: Vec<u8>,
    }

    impl Read for Endless {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            while self.rest.len() < buffer.len() {
                self.row += 1;
                self.rest.extend_from_slice(format!("r1,{}e-6,0.01,0\n", self.row).as_bytes());
            }
            let taken = buffer.len();
            buffer.copy_from_slice(&self.rest[..taken]);
            self.rest.drain(..taken);
            Ok(taken)
        }
    }

    #[test]
    fn a_table_of_too_many_rows_is_refused_before_it_fills_the_memory() {
        let table = Endless { row: 0, rest: b"run,t,z,x\n".to_vec() };
        let run = |name: &str| Run { ..Run::new(name.to_owned(), 0) };
        let (mut runs, mut findings) = ([run("r1")], Findings::default());
        let source = Source {
            name: "trajectories.csv",
            reader: BufReader::new(table),
            is_one_of: 1,
            is_vertical: true,
        };
        let format = Format::default();
        read(source, &mut runs, (&format, Missing::Error), (&mut 0, &mut findings));
        let messages: Vec<&str> =
            findings.diagnostics.iter().map(|one| one.message.as_str()).collect();
        assert_eq!(messages, ["trajectories.csv has more than 2000000 rows"]);
        let held = runs[0].frames.capacity() * size_of::<Frame>();
        // While the list grows, half of it again is held.
        assert!(held + held / 2 < 200_000_000, "{held} bytes");
    }
}
