//! Spreadsheets as sheets.

use std::io::Cursor;

use calamine::{Data, Reader, open_workbook_auto_from_rs};

use super::fault::Fault;
use super::sheet::{Number, Row, Sheet, number};

/// Endings of the names of spreadsheets.
pub(super) const ENDINGS: [&str; 4] = ["xlsx", "xlsm", "xls", "ods"];

/// Whether the content is text; the name of the file does not matter.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    /// First bytes of archives and of compound documents.
    const BOOKS: [&[u8]; 2] = [b"PK", &[0xd0, 0xcf, 0x11, 0xe0]];
    !BOOKS.iter().any(|first| bytes.starts_with(first)) && !bytes.contains(&0)
}

/// The sheets with numbers of the file that messages call `file`.
///
/// # Errors
/// If it is not a spreadsheet, or holds no table.
pub(super) fn read(file: &str, stem: &str, bytes: &[u8]) -> Result<Vec<Sheet>, Fault> {
    let refused = |error: calamine::Error| {
        let what = format!("this cannot be read as a spreadsheet: {error}");
        Fault::new(file, what, "save it again, or save its sheet as CSV")
    };
    let mut book = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(refused)?;
    let mut sheets = Vec::new();
    for (name, range) in book.worksheets() {
        let first = range.start().map_or(0, |start| start.0);
        let rows = (u64::from(first) + 1..).zip(range.rows());
        let rows = rows.map(|(line, cells)| Row { line, cells: cells.iter().map(text).collect() });
        let rows: Vec<Row> = rows.filter(|row| !row.is_blank()).collect();
        let numbers = |row: &Row| {
            row.cells.iter().any(|cell| matches!(number(cell, false), Number::Value(_)))
        };
        if rows.iter().filter(|row| numbers(row)).count() < 2 {
            continue;
        }
        sheets.push(Sheet {
            file: format!("{file}[{name}]"),
            stem: name,
            separated: "cells",
            decimal_comma: false,
            rows,
            notes: Vec::new(),
        });
    }
    match &mut sheets[..] {
        [] => Err(Fault::new(
            file,
            "no sheet of it holds numbers",
            "a line of names, then rows of numbers",
        )),
        [only] => {
            // A file of one sheet is called by its own name, not `Sheet1`.
            stem.clone_into(&mut only.stem);
            Ok(sheets)
        }
        _ => Ok(sheets),
    }
}

/// A cell as text that reads back to the same number.
fn text(cell: &Data) -> String {
    match cell {
        Data::Empty | Data::Error(_) => String::new(),
        Data::Float(value) => format!("{value:?}"),
        Data::Int(value) => value.to_string(),
        Data::Bool(value) => value.to_string(),
        Data::DateTime(value) => format!("{:?}", value.as_f64()),
        Data::DateTimeIso(text) | Data::DurationIso(text) => text.clone(),
        Data::String(text) => {
            let text = text.trim();
            // A number that was typed as text keeps the comma of its country.
            match number(text, true) {
                Number::Value(_) => text.replace(',', "."),
                _ => text.to_owned(),
            }
        }
    }
}
