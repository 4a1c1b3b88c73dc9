//! A table with a header, read row by row: dialect and columns are found out before the first row.

pub(crate) mod cells;
pub(crate) mod columns;
pub(crate) mod dialect;
pub(crate) mod findings;
pub(crate) mod header;
pub(crate) mod lines;
pub(crate) mod row;

use std::collections::VecDeque;
use std::io::BufRead;

use configs::{Diagnostic, Span, shorten};

use crate::table::cells::Cell;
use crate::table::columns::{ColumnNames, ColumnSpec, Content};
use crate::table::dialect::{Decimal, Delimiter, Dialect};
use crate::table::findings::Findings;
use crate::table::header::Column;
use crate::table::lines::{LineFault, Lines};
use crate::table::row::{Row, file_name};

/// How many rows are looked at before the first is understood.
const SAMPLE: usize = 200;

/// What the set says about how its tables are written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Format {
    pub(crate) delimiter: Option<Delimiter>,
    pub(crate) decimal: Option<Decimal>,
    pub(crate) columns: ColumnNames,
}

/// A table behind its header.
pub(crate) struct Table<R> {
    lines: Lines<R>,
    ahead: VecDeque<(u64, String)>,
    parser: csv_core::Reader,
    dialect: Dialect,
    specs: &'static [ColumnSpec],
    columns: Vec<Option<Column>>,
    width: usize,
}

impl<R: BufRead> Table<R> {
    /// Reads the header and finds out how the table is written. `None` if it cannot be read; that
    /// is reported then. `row` belongs to this table from now on.
    pub(crate) fn open(
        (name, reader): (&str, R),
        specs: &'static [ColumnSpec],
        format: &Format,
        row: &mut Row,
        findings: &mut Findings,
    ) -> Option<Self> {
        row.table = name.to_owned();
        let mut lines = Lines::new(reader);
        let header = lines.next(&mut row.text);
        row.line = line(header, name, findings)?.or_else(|| {
            findings.report(Diagnostic::error(format!("{} is empty", file_name(name))));
            None
        })?;
        let delimiter =
            format.delimiter.or_else(|| Delimiter::of_header(&row.text)).or_else(|| {
                let span = findings.place(row, None);
                findings.report(
                    Diagnostic::error("it is not clear what separates the columns")
                        .at(span, "two of , ; and tab stand here")
                        .help("say it below [files]: delimiter = \",\", \";\" or \"tab\""),
                );
                None
            })?;
        row.delimiter = delimiter.byte();
        let mut table = Self {
            lines,
            ahead: VecDeque::new(),
            parser: csv_core::ReaderBuilder::new().delimiter(delimiter.byte()).build(),
            dialect: Dialect { delimiter, decimal: Decimal::Point },
            specs,
            columns: Vec::new(),
            width: 0,
        };
        row.split(&mut table.parser);
        table.width = row.width;
        table.columns = header::read(row, specs, &format.columns, findings)?;
        table.look_ahead(row, findings)?;
        table.dialect.decimal = table.decimal(format.decimal, row, findings)?;
        table.note_dialect(format, row, findings);
        Some(table)
    }

    /// Puts the next row into `row`; `false` at the end, or when as much is wrong as is listed.
    pub(crate) fn next(&mut self, row: &mut Row, findings: &mut Findings) -> bool {
        while !findings.full() {
            match self.ahead.pop_front() {
                Some((number, text)) => (row.line, row.text) = (number, text),
                None => {
                    let read = self.lines.next(&mut row.text);
                    match line(read, &row.table, findings) {
                        Some(Some(number)) => row.line = number,
                        _ => return false,
                    }
                }
            }
            let closed = row.split(&mut self.parser);
            if closed && row.width == self.width {
                return true;
            }
            let span = findings.place(row, None);
            if closed && self.has_decimal_commas(row) {
                findings.report(
                    Diagnostic::error(format!(
                        "{} cells found; the header has {}, and so it is in the rows below",
                        row.width, self.width
                    ))
                    .at(span, "decimals after a comma, between columns that commas separate?")
                    .help("save the table with semicolons or tabs between the columns"),
                );
                return false;
            }
            findings.report(match closed {
                false => Diagnostic::error("a quoted cell does not end on its line")
                    .at(span, "a quote stays open here"),
                true => self.wrong_width(row.width, span),
            });
        }
        false
    }

    /// Whether this row and all that were looked at have more cells than the header, as decimal commas
    /// between commas make them.
    fn has_decimal_commas(&mut self, row: &Row) -> bool {
        if self.dialect.delimiter != Delimiter::Comma || row.width <= self.width {
            return false;
        }
        let mut other = Row::of(&row.table, row.delimiter);
        let is_wider = |(_, text): &(u64, String)| {
            other.text.clone_from(text);
            other.split(&mut self.parser) && other.width > self.width
        };
        !self.ahead.is_empty() && self.ahead.iter().all(is_wider)
    }

    fn wrong_width(&self, found: usize, span: Span) -> Diagnostic {
        let diagnostic =
            Diagnostic::error(format!("{found} cells found; the header has {}", self.width))
                .at(span, "this row");
        match self.dialect.delimiter == Delimiter::Comma && found > self.width {
            true => {
                diagnostic.help("decimals after a comma? then separate the columns by ; or tab")
            }
            false => diagnostic,
        }
    }

    /// Whether the table has the column `key` of the specs.
    pub(crate) fn has(&self, key: usize) -> bool {
        self.columns[key].is_some()
    }

    /// The text of the column `key` of the specs; empty where the table has no such column.
    pub(crate) fn text<'r>(&self, row: &'r Row, key: usize) -> &'r str {
        self.columns[key].as_ref().map_or("", |column| row.cell(column.at))
    }

    /// The number in the column `key` of the specs, in SI and counted our way.
    pub(crate) fn quantity(&self, row: &Row, key: usize, findings: &mut Findings) -> Cell {
        let Some(column) = &self.columns[key] else {
            return Cell::Empty;
        };
        let Content::Quantity(dimension) = self.specs[key].content else {
            return Cell::Empty;
        };
        let unit = column.unit.as_deref().map(|unit| (unit, dimension));
        match cells::number(row.cell(column.at), self.dialect.decimal, unit) {
            // A zero has no sign afterwards.
            Ok(Cell::Value(value)) => Cell::Value((value - column.zero) * column.sign + 0.0),
            Ok(cell) => cell,
            Err(what) => {
                let span = self.place(row, key, findings);
                findings.report(
                    Diagnostic::error(what)
                        .at(span, format!("`{}` is {}", column.name, dimension.name())),
                );
                Cell::Wrong
            }
        }
    }

    /// The whole number in the column `key` of the specs.
    pub(crate) fn count(&self, row: &Row, key: usize, findings: &mut Findings) -> Option<i64> {
        let text = self.text(row, key);
        if text.is_empty() {
            return None;
        }
        let number = text.parse().ok();
        if number.is_none() {
            let span = self.place(row, key, findings);
            findings.report(
                Diagnostic::error(format!("\"{}\" is not a whole number", shorten(text)))
                    .at(span, format!("`{}` is a whole number", self.specs[key].key)),
            );
        }
        number
    }

    /// The place of the cell in the column `key` of the specs.
    pub(crate) fn place(&self, row: &Row, key: usize, findings: &mut Findings) -> Span {
        findings.place(row, self.columns[key].as_ref().map(|column| column.at))
    }

    /// What is understood of the table: columns with their units.
    pub(crate) fn describe(&self) -> String {
        let columns = self.columns.iter().zip(self.specs);
        let known = columns.filter_map(|(column, spec)| Some(column.as_ref()?.describe(spec)));
        known.collect::<Vec<_>>().join(", ")
    }

    fn look_ahead(&mut self, row: &Row, findings: &mut Findings) -> Option<()> {
        let mut text = String::new();
        while self.ahead.len() < SAMPLE {
            let read = self.lines.next(&mut text);
            match line(read, &row.table, findings)? {
                Some(number) => self.ahead.push_back((number, std::mem::take(&mut text))),
                None => break,
            }
        }
        Some(())
    }

    /// The decimals of the rows ahead.
    fn decimal(
        &mut self,
        given: Option<Decimal>,
        header: &Row,
        findings: &mut Findings,
    ) -> Option<Decimal> {
        if given.is_some() {
            return given;
        }
        let mut row = Row::of(&header.table, header.delimiter);
        let mut numbers: Vec<(usize, usize, String)> = Vec::new();
        for (index, (_, text)) in self.ahead.iter().enumerate() {
            row.text.clone_from(text);
            row.split(&mut self.parser);
            for (column, spec) in self.columns.iter().zip(self.specs) {
                if let (Some(column), Content::Quantity(_)) = (column, spec.content)
                    && column.at < row.width
                {
                    numbers.push((index, column.at, row.cell(column.at).to_owned()));
                }
            }
        }
        let cells = numbers.iter().map(|(_, _, cell)| cell.as_str());
        Decimal::of_cells(cells)
            .map_err(|cell| {
                let Some((index, at, _)) = numbers.iter().find(|(_, _, other)| *other == cell)
                else {
                    return;
                };
                (row.line, row.text) = self.ahead[*index].clone();
                let span = findings.place(&row, Some(*at));
                findings.report(
                    Diagnostic::error(format!("\"{cell}\" can be read in two ways"))
                        .at(span, "is the comma decimal, or does it group thousands?")
                        .help(
                            "say it below [files]: decimal = \",\" or \".\"; \
                             grouped digits are not read",
                        ),
                );
            })
            .ok()
    }

    fn note_dialect(&self, format: &Format, row: &Row, findings: &mut Findings) {
        let table = file_name(&row.table);
        if format.delimiter.is_none() && self.dialect.delimiter != Delimiter::Comma {
            let noun = self.dialect.delimiter.noun();
            findings.note(format!("The columns of {table} are separated by {noun}."));
        }
        if format.decimal.is_none() && self.dialect.decimal == Decimal::Comma {
            findings.note(format!("The numbers of {table} have a decimal comma."));
        }
    }
}

/// The number of the next line; `None` when there is none to be read, which is reported.
fn line(
    read: Result<Option<u64>, LineFault>,
    table: &str,
    findings: &mut Findings,
) -> Option<Option<u64>> {
    let name = file_name(table);
    read.map_err(|fault| findings.report(Diagnostic::error(format!("{name}: {fault}")))).ok()
}
