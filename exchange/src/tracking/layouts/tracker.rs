//! Tracker (Open Source Physics): the name of the track, then `t x y`; or several tracks below `#multi:`.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::{Heading, Role};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn filled(row: &Row) -> usize {
    row.cells.iter().filter(|cell| !cell.is_empty()).count()
}

fn is_multi(sheet: &Sheet) -> bool {
    sheet.rows.first().is_some_and(|row| row.cell(0).to_lowercase().starts_with("#multi"))
}

/// What Tracker calls its tracks, in its languages.
const TRACKS: [&str; 6] = ["mass", "masse", "massa", "masa", "cm", "particle"];

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    let [first, second, ..] = &sheet.rows[..] else { return false };
    let name = first.cell(0).to_lowercase();
    let word = name.split([' ', '_']).next().unwrap_or_default();
    let is_header = Heading::of(second.cell(0)).stem == "t" && filled(second) > 1;
    is_multi(sheet) || filled(first) == 1 && (TRACKS.contains(&word) || is_header)
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let header = if is_multi(sheet) { 2 } else { 1 };
    let is_named = sheet.rows.get(header).is_some_and(|row| !sheet.is_numeric(row, 1));
    if !is_named || sheet.rows.len() < header + 3 {
        let right = "below the name of the track stands a line t, x, y, then rows of numbers";
        let line = sheet.rows.get(header).or(sheet.rows.last()).map_or(1, |row| row.line);
        return Err(sheet.fault("the line of names `t x y` is missing", right).at(line));
    }
    let grid = Grid::below(sheet, header, None);
    if !is_multi(sheet) {
        let places = places(&grid, 0..grid.headings.len(), columns)?;
        let track = grid.track("Tracker", places, grid.all_rows())?;
        return Ok(vec![track]);
    }
    // A name stands above the first column of its track.
    let names = &sheet.rows[1];
    let starts: Vec<usize> =
        (1..grid.headings.len()).filter(|at| !names.cell(*at).is_empty()).collect();
    let mut tracks = Vec::new();
    for (index, start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(grid.headings.len());
        let places = places(&grid, *start..end, columns)?;
        let places = Places { t: Some(0), ..places };
        let track = grid.track("Tracker", places, grid.all_rows())?;
        tracks.push(Track { name: Some(names.cell(*start).to_owned()), ..track });
    }
    match tracks.is_empty() {
        true => Err(sheet
            .fault("no name of a track stands below `#multi:`", "export it again")
            .at(names.line)),
        false => Ok(tracks),
    }
}

/// The columns of a track within `range`.
fn places(
    grid: &Grid<'_>,
    range: std::ops::Range<usize>,
    columns: &Columns,
) -> Result<Places, Fault> {
    let of = |role: Role| range.clone().find(|at| grid.headings[*at].role() == Some(role));
    let asked = |role: Role| columns.of(role).map(|name| grid.named(name)).transpose();
    let Some(z) = asked(Role::Vertical)?.or_else(|| of(Role::Vertical)) else {
        let names: Vec<&str> = grid.headings.iter().map(|one| one.name.as_str()).collect();
        let what = "the table has no column y";
        let right =
            format!("tick x and y in the columns of Tracker's table; found: {}", names.join(", "));
        return Err(grid
            .sheet
            .fault(what, right)
            .at(grid.rows.first().map_or(1, |row| row.line - 1)));
    };
    Ok(Places { t: asked(Role::Time)?.or_else(|| of(Role::Time)), z, x: of(Role::Forward) })
}
