//! Text files of Igor (`.itx`): a line of waves, and their numbers between BEGIN and END.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout =
    Layout { fits: |sheet, _| super::first_row(sheet).trim() == "igor", read };

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let is = |row: &Row, word: &str| row.cells.iter().any(|cell| cell.eq_ignore_ascii_case(word));
    let blocks = sheet.rows.iter().enumerate().filter_map(|(at, row)| {
        let names = names(row)?;
        let begin = at + sheet.rows[at..].iter().position(|row| is(row, "BEGIN"))?;
        let numbers = sheet.rows[begin + 1..].iter().take_while(|row| !is(row, "END"));
        // A tabulator stands before the first number.
        let bare = |row: &Row| {
            let cells = row.cells.iter().filter(|cell| !cell.is_empty()).cloned().collect();
            Row { cells, line: row.line }
        };
        let rows = std::iter::once(Row { line: row.line, cells: names }).chain(numbers.map(bare));
        Some(Sheet { rows: rows.collect(), notes: sheet.notes.clone(), ..sheet.without_rows() })
    });
    let blocks: Vec<Sheet> = blocks.collect();
    let mut tracks = Vec::new();
    for (block, nth) in blocks.iter().zip(1..) {
        for track in super::tracks(block, columns)? {
            let nth = (blocks.len() > 1).then(|| nth.to_string());
            tracks.push(Track { name: track.name.or(nth), layout: "Igor".to_owned(), ..track });
        }
    }
    match tracks.is_empty() {
        true => Err(sheet.fault("no waves are found", "a line WAVES/D t_s, z_mm, then BEGIN")),
        false => Ok(tracks),
    }
}

/// The names of the waves in a line `WAVES/D t_s, z_mm`.
fn names(row: &Row) -> Option<Vec<String>> {
    let line = row.cells.join("\t");
    let (word, names) = line.trim().split_once([' ', '\t'])?;
    let names = names.split([',', '\t', ' ']).filter(|name| !name.is_empty());
    word.to_uppercase()
        .starts_with("WAVES")
        .then(|| names.map(|name| name.trim_matches('\'').to_owned()).collect())
}
