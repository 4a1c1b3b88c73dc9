//! A table with a header, read row by row: dialect and columns are found out before the first row.

use std::collections::VecDeque;
use std::io::BufRead;
use std::ops::Range;

use configs::{Diagnostic, SourceId, Span, nearest, shorten};
use engine::units::{self, Dimension};

use super::cells::{self, Cell};
use super::columns::{ColumnNames, ColumnSpec, Content};
use super::dialect::{Decimal, Delimiter, Dialect};
use super::findings::Findings;
use super::lines::{LineFault, Lines};

/// How many rows are looked at before the first is understood.
const SAMPLE: usize = 200;

/// What the set says about how its tables are written.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Format {
    pub(super) delimiter: Option<Delimiter>,
    pub(super) decimal: Option<Decimal>,
    pub(super) columns: ColumnNames,
}

/// One row, in place of the one before.
#[derive(Default)]
pub(super) struct Row {
    /// Name of the table, for messages.
    pub(super) table: String,
    /// From 1.
    pub(super) line: u64,
    /// As it stands in the file.
    pub(super) text: String,
    delimiter: u8,
    /// The cells without quotes, one after the other, and where each ends.
    fields: Vec<u8>,
    ends: Vec<usize>,
    width: usize,
}

impl Row {
    /// The cell at `column`, without blanks around it.
    fn cell(&self, column: usize) -> &str {
        let start = if column == 0 { 0 } else { self.ends[column - 1] };
        std::str::from_utf8(&self.fields[start..self.ends[column]]).unwrap_or_default().trim()
    }

    fn cells(&self) -> impl Iterator<Item = &str> {
        (0..self.width).map(|column| self.cell(column))
    }

    /// Where the cell at `column` stands in the text.
    pub(super) fn range(&self, column: usize) -> Range<usize> {
        let (mut start, mut at, mut quoted) = (0, 0, false);
        for (index, byte) in self.text.bytes().enumerate() {
            if byte == b'"' {
                quoted = !quoted;
            } else if byte == self.delimiter && !quoted {
                if at == column {
                    return start..index;
                }
                at += 1;
                start = index + 1;
            }
        }
        start..self.text.len()
    }

    /// Takes the text apart; `false` when a quote stays open.
    fn split(&mut self, parser: &mut csv_core::Reader) -> bool {
        // No text has more cells than bytes, nor longer ones.
        self.fields.resize(self.text.len() + 1, 0);
        self.ends.resize(self.text.len() + 2, 0);
        parser.reset();
        let (_, _, written, ended) =
            parser.read_record(self.text.as_bytes(), &mut self.fields, &mut self.ends);
        let (_, _, _, last) =
            parser.read_record(&[], &mut self.fields[written..], &mut self.ends[ended..]);
        self.width = ended + last;
        self.text.bytes().filter(|byte| *byte == b'"').count() % 2 == 0
    }
}

/// Where a column stands, and how it is written.
struct Column {
    at: usize,
    name: String,
    unit: Option<String>,
    sign: f64,
}

/// A table behind its header.
pub(super) struct Table<R> {
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
    pub(super) fn open(
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
        table.header(row, &format.columns, findings)?;
        table.look_ahead(row, findings)?;
        table.dialect.decimal = table.decimal(format.decimal, row, findings)?;
        table.note_dialect(format, row, findings);
        Some(table)
    }

    /// Puts the next row into `row`; `false` at the end, or when as much is wrong as is listed.
    pub(super) fn next(&mut self, row: &mut Row, findings: &mut Findings) -> bool {
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
            findings.report(match closed {
                false => Diagnostic::error("a quoted cell does not end on its line")
                    .at(span, "the number of quotes is odd"),
                true => self.wrong_width(row.width, span),
            });
        }
        false
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

    /// The text of the column `key` of the specs; empty where the table has no such column.
    pub(super) fn text<'r>(&self, row: &'r Row, key: usize) -> &'r str {
        self.columns[key].as_ref().map_or("", |column| row.cell(column.at))
    }

    /// The number in the column `key` of the specs, in SI and counted our way.
    pub(super) fn quantity(&self, row: &Row, key: usize, findings: &mut Findings) -> Cell {
        let Some(column) = &self.columns[key] else {
            return Cell::Empty;
        };
        let Content::Quantity(dimension) = self.specs[key].content else {
            return Cell::Empty;
        };
        let unit = column.unit.as_deref().map(|unit| (unit, dimension));
        match cells::number(row.cell(column.at), self.dialect.decimal, unit) {
            // A zero has no sign afterwards.
            Ok(Cell::Value(value)) => Cell::Value(value * column.sign + 0.0),
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
    pub(super) fn count(&self, row: &Row, key: usize, findings: &mut Findings) -> Option<i64> {
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
    pub(super) fn place(&self, row: &Row, key: usize, findings: &mut Findings) -> Span {
        findings.place(row, self.columns[key].as_ref().map(|column| column.at))
    }

    /// What is understood of the table: columns with their units.
    pub(super) fn describe(&self) -> String {
        let columns = self.columns.iter().zip(self.specs).filter_map(|(column, spec)| {
            let column = column.as_ref()?;
            let unit = match (spec.content, &column.unit) {
                (Content::Quantity(dimension), None) => format!(" ({})", dimension.si_unit()),
                (_, Some(unit)) if column.sign < 0.0 => format!(" ({unit}, turned round)"),
                (_, Some(unit)) => format!(" ({unit})"),
                (Content::Name | Content::Count, None) => String::new(),
            };
            Some(match column.name == spec.key {
                true => format!("{}{unit}", spec.key),
                false => format!("{} = {}{unit}", spec.key, column.name),
            })
        });
        columns.collect::<Vec<_>>().join(", ")
    }

    fn header(
        &mut self,
        row: &mut Row,
        names: &ColumnNames,
        findings: &mut Findings,
    ) -> Option<()> {
        row.split(&mut self.parser);
        self.width = row.width;
        let found: Vec<String> = row.cells().map(str::to_owned).collect();
        let before = findings.errors();
        for (at, name) in found.iter().enumerate() {
            if let Some(first) = found[..at].iter().position(|other| other == name) {
                let (again, first) = (row.range(at), row.range(first));
                let whole = findings.place(row, None);
                let part = |range: Range<usize>| part(whole.source, range);
                findings.report(
                    Diagnostic::error(format!("the column `{}` stands twice", shorten(name)))
                        .at(part(again), "again here")
                        .with(part(first), "first here"),
                );
            }
        }
        for spec in self.specs {
            let renamed = names.of(spec.key);
            let name = renamed.map_or(spec.key, |renamed| renamed.name.as_str());
            let (mut name, mut at) = (name, found.iter().position(|found| found == name));
            // Both tables have a column `run`, and perhaps only one calls it otherwise.
            if at.is_none() && spec.key == "run" {
                name = spec.key;
                at = found.iter().position(|found| found == name);
            }
            if at.is_none() && (spec.required || renamed.is_some()) {
                missing(name, spec, &found, row, findings);
            }
            self.columns.push(at.map(|at| Column {
                at,
                name: name.to_owned(),
                unit: renamed.and_then(|renamed| renamed.unit.clone()),
                sign: renamed.map_or(1.0, |renamed| renamed.sign),
            }));
        }
        let known = |at: usize| self.columns.iter().flatten().any(|column| column.at == at);
        let ignored: Vec<String> = (0..found.len())
            .filter(|at| !known(*at))
            .take(20)
            .map(|at| format!("`{}`", shorten(&found[at])))
            .collect();
        if !ignored.is_empty() {
            let (noun, verb) =
                if ignored.len() == 1 { ("column", "is") } else { ("columns", "are") };
            let table = file_name(&row.table);
            findings.note(format!("In {table} the {noun} {} {verb} ignored.", ignored.join(", ")));
        }
        (findings.errors() == before).then_some(())
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
        let mut row = Row {
            table: header.table.clone(),
            delimiter: self.dialect.delimiter.byte(),
            ..Row::default()
        };
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

/// The last part of a path, for a note.
pub(super) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
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

fn part(source: SourceId, range: Range<usize>) -> Span {
    Span { source, start: range.start, end: range.end }
}

/// Reports that no column has the name `name`.
fn missing(name: &str, spec: &ColumnSpec, found: &[String], row: &Row, findings: &mut Findings) {
    let near = like(name, found);
    let other = near.map_or("…".to_owned(), |at| shorten(&found[at]));
    let entry = match spec.content {
        Content::Quantity(dimension) => {
            let unit = near.and_then(|at| unit_in(&found[at], dimension));
            let unit = unit.unwrap_or_else(|| dimension.si_unit());
            format!("{} = {{ name = \"{other}\", unit = \"{unit}\" }}", spec.key)
        }
        Content::Name | Content::Count => format!("{} = {{ name = \"{other}\" }}", spec.key),
    };
    let shown: Vec<String> = found.iter().take(20).map(|name| shorten(name)).collect();
    let span = findings.place(row, near);
    let label = if near.is_some() { "is it this one?" } else { "no column has this name" };
    findings.report(
        Diagnostic::error(format!("the column `{}` is missing", shorten(name)))
            .at(span, label)
            .help(format!(
                "found: {}\nwhere it has another name, say it below [columns]: {entry}",
                shown.join(", ")
            )),
    );
}

/// The column that is likely meant by `name`: spelt nearly so, or with a unit behind the name.
fn like(name: &str, found: &[String]) -> Option<usize> {
    let stem = |found: &String| found.split(BEFORE_UNIT).next().unwrap_or_default().to_lowercase();
    match nearest(name, found.iter().map(String::as_str)) {
        Some(near) => found.iter().position(|found| found == near),
        None => found.iter().position(|found| stem(found) == name.to_lowercase()),
    }
}

/// What stands between a name and its unit in `z_mm`, `z (mm)`, `z/mm`.
const BEFORE_UNIT: [char; 5] = ['_', ' ', '(', '[', '/'];

/// The unit that a column has in its name.
fn unit_in(name: &str, dimension: Dimension) -> Option<String> {
    let unit = name.rsplit(BEFORE_UNIT).next()?.trim_end_matches([')', ']']);
    units::parse(&format!("1 {unit}"), dimension).ok().map(|_| unit.to_owned())
}
