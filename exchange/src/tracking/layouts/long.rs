//! Plain tables in long form: a column says which run a row is of.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::Grid;
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, columns: &Columns) -> bool {
    Grid::found(sheet).is_ok_and(|grid| grid.column(Role::Run, columns).ok().flatten().is_some())
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    let Some(run) = grid.column(Role::Run, columns)? else { return Ok(Vec::new()) };
    let places = super::single::places(&grid, columns)?;
    let mut names: Vec<&str> = Vec::new();
    for row in grid.rows {
        let name = row.cell(run);
        if name.is_empty() {
            let what = format!("the column `{}` is empty", grid.headings[run].name);
            return Err(sheet.fault(what, "every row needs the name of its run").at(row.line));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of = |name: &str| {
        let own: Vec<(usize, &Row)> =
            grid.all_rows().filter(|(_, row)| row.cell(run) == name).collect();
        let rows: Vec<&Row> = own.iter().map(|(_, row)| *row).collect();
        let layout = format!("long, {}", sheet.separated);
        let track = grid.track(&layout, places, own.into_iter())?;
        let used: Vec<usize> =
            [Some(run), places.t, Some(places.z), places.x].into_iter().flatten().collect();
        let labels = grid.labels(&used, &rows);
        Ok(Track { name: Some(name.to_owned()), labels, ..track })
    };
    names.into_iter().map(of).collect()
}
