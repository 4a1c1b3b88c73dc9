//! Plain tables of one drop: a column of times or frames, and one of positions.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, NAMED_ROWS, NO_TIMES, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits: |_, _| true, read };

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    let places = places(&grid, columns)?;
    grid.column(Role::Run, columns)?;
    let layout = format!("one drop, {}", sheet.separated);
    let track = grid.track(&layout, places, grid.all_rows())?;
    let used: Vec<usize> = [places.t, Some(places.z), places.x].into_iter().flatten().collect();
    let rows: Vec<&Row> = grid.rows.iter().collect();
    let labels = grid.labels(&used, &rows);
    let mut track = Track { labels, ..track };
    let is_other = |at: &usize| {
        grid.headings[*at].role() == Some(Role::Vertical) && *at != places.z && !grid.is_label(*at)
    };
    if let Some(other) = (0..grid.headings.len()).find(is_other)
        && columns.of(Role::Vertical).is_none()
    {
        let [other, own] = [other, places.z].map(|at| &grid.headings[at].name);
        track
            .notes
            .push(format!("`{other}` does not move, `{own}` is taken for the vertical position"));
    }
    if grid.is_without_names && columns.of(Role::Time).is_none() {
        track.notes.push("two columns without names are taken for times and positions".to_owned());
    }
    Ok(vec![track])
}

/// The columns of time and position.
///
/// # Errors
/// If one is not found.
pub(super) fn places(grid: &Grid<'_>, columns: &Columns) -> Result<Places, Fault> {
    let names: Vec<&str> = grid.headings.iter().map(|one| one.name.as_str()).collect();
    let missing = |what: &str, key: &str, example: &str| {
        let right = format!(
            "name it {example}, or say which it is: --column {key}=NAME; found: {}",
            names.join(", ")
        );
        let line = grid.rows.first().map_or(1, |row| row.line.saturating_sub(1).max(1));
        grid.sheet.fault(what, right).at(line)
    };
    let is_named = grid.rows.iter().all(|row| grid.sheet.has_words(row));
    let no_times = if is_named { NAMED_ROWS } else { NO_TIMES };
    let t = match grid.column(Role::Time, columns)? {
        Some(at) => at,
        None => grid
            .column(Role::Frame, columns)?
            .ok_or_else(|| missing(no_times, "t", "`t (ms)` or `frame`"))?,
    };
    let z = grid
        .column(Role::Vertical, columns)?
        .ok_or_else(|| missing("no column of vertical positions is found", "z", "`y (cm)`"))?;
    Ok(Places { t: Some(t), z, x: grid.column(Role::Forward, columns)?.filter(|x| *x != z) })
}
