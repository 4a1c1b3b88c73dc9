//! LoggerPro (Vernier): text with rows of names, short names and units; or a table `Run 1: Time (s)`.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::Sheet;
use crate::tracking::track::Track;
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    let first = first_row(sheet);
    is_text(sheet) || first.contains(": time") || first.contains("latest: ")
}

fn is_text(sheet: &Sheet) -> bool {
    first_row(sheet).starts_with("vernier format")
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    match is_text(sheet) {
        true => text(sheet, columns),
        false => table(sheet),
    }
}

/// `Vernier Format 2`, the file, the data set, names, short names, units, numbers.
fn text(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let numbers = sheet.rows.iter().position(|row| sheet.is_numeric(row, 2));
    let named = |at: &usize| {
        let row = &sheet.rows[*at];
        row.cells.len() > 1
            && Grid::below(sheet, *at, None)
                .headings
                .iter()
                .any(|one| one.role() == Some(Role::Time))
    };
    let header = numbers.and_then(|numbers| (0..numbers).find(named));
    let (Some(numbers), Some(header)) = (numbers, header) else {
        let right =
            "below `Vernier Format 2` come the names Time and Position, their units, and numbers";
        return Err(sheet.fault("no column of times is found", right).at(1));
    };
    let is_units = |at: &usize| {
        let cells = || sheet.rows[*at].cells.iter().filter(|cell| !cell.is_empty());
        cells().any(|cell| Unit::maybe(cell).is_some()) && *at > header
    };
    let units = (header + 1..numbers).rev().find(is_units);
    let grid = Grid::below(sheet, header, units);
    let grid = Grid { rows: &sheet.rows[numbers..], ..grid };
    let Some(z) = grid.column(Role::Vertical, columns)? else {
        let names: Vec<&str> = grid.headings.iter().map(|one| one.name.as_str()).collect();
        let right = format!("say which it is: --column z=NAME; found: {}", names.join(", "));
        return Err(sheet
            .fault("no column of positions is found", right)
            .at(sheet.rows[header].line));
    };
    let places =
        Places { t: grid.column(Role::Time, columns)?, z, x: grid.column(Role::Forward, columns)? };
    Ok(vec![grid.track("LoggerPro", places, grid.all_rows())?])
}

/// Each run has its own columns: `Run 1: Time (s)`, `Run 1: Position (m)`.
fn table(sheet: &Sheet) -> Result<Vec<Track>, Fault> {
    let grid = Grid::below(sheet, 0, None);
    let run = |at: usize| grid.headings[at].name.split_once(": ").map_or("", |(run, _)| run);
    let mut runs: Vec<&str> = Vec::new();
    for at in 0..grid.headings.len() {
        if !runs.contains(&run(at)) {
            runs.push(run(at));
        }
    }
    let several = runs.len() > 1;
    let one = |name: &str| {
        let of = |role: Role| {
            (0..grid.headings.len())
                .find(|at| run(*at) == name && grid.headings[*at].role() == Some(role))
        };
        let Some(z) = of(Role::Vertical) else {
            let what = format!("the run `{name}` has no column of positions");
            let right = format!("export it with a column such as `{name}: Position (m)`");
            return Err(sheet.fault(what, right).at(sheet.rows[0].line));
        };
        let places = Places { t: of(Role::Time), z, x: of(Role::Forward) };
        let track = grid.track("LoggerPro", places, grid.all_rows())?;
        Ok(Track { name: several.then(|| name.replace(' ', "-").to_lowercase()), ..track })
    };
    runs.into_iter().filter(|name| !name.is_empty()).map(one).collect()
}
