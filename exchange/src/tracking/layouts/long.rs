//! Plain tables in long form: a column says which run a row is of, or several do together.

use super::Layout;
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Row, Sheet};
use crate::tracking::track::Track;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, columns: &Columns) -> bool {
    Grid::found(sheet).is_ok_and(|grid| !telling(&grid, columns).is_empty())
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::found(sheet)?;
    let telling = telling(&grid, columns);
    let places = super::single::places(&grid, columns)?;
    let told: Vec<String> = grid.rows.iter().map(|row| name(row, &telling)).collect();
    let mut names: Vec<&String> = Vec::new();
    for (row, name) in grid.rows.iter().zip(&told) {
        if let Some(at) = telling.iter().find(|at| row.cell(**at).is_empty()) {
            let what = format!("the column `{}` is empty", grid.headings[*at].name);
            return Err(sheet.fault(what, "every row needs the name of its run").at(row.line));
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let of = |name: &String| {
        let own = grid.all_rows().filter(|(at, _)| told[*at] == *name);
        let own: Vec<(usize, &Row)> = own.collect();
        let rows: Vec<&Row> = own.iter().map(|(_, row)| *row).collect();
        let layout = format!("long, {}", sheet.separated);
        let track = grid.track(&layout, places, own.into_iter())?;
        let mut used: Vec<usize> =
            [places.t, Some(places.z), places.x].into_iter().flatten().collect();
        if let [run] = telling[..] {
            used.push(run);
        }
        let labels = grid.labels(&used, &rows);
        Ok(Track { name: Some(name.clone()), labels, ..track })
    };
    names.into_iter().map(of).collect()
}

/// The columns that tell runs apart: that of runs, else all labels, where the times of several drops stand below each other.
fn telling(grid: &Grid<'_>, columns: &Columns) -> Vec<usize> {
    if let Ok(Some(run)) = grid.column(Role::Run, columns) {
        return vec![run];
    }
    let Ok(Places { t: Some(t), z, x }) = super::single::places(grid, columns) else {
        return Vec::new();
    };
    let is_other = |at: &usize| ![Some(t), Some(z), x].contains(&Some(*at));
    let labels = (0..grid.headings.len()).filter(is_other).filter(|at| grid.is_label(*at));
    let labels: Vec<usize> = labels.collect();
    let time = |row: &Row| match grid.sheet.number(row.cell(t)) {
        Number::Value(time) => Some(time),
        _ => None,
    };
    let starts_again =
        |pair: &[Row]| time(&pair[0]).zip(time(&pair[1])).is_some_and(|(a, b)| b < a);
    let is_told = |pair: &&[Row]| name(&pair[0], &labels) != name(&pair[1], &labels);
    let starts: Vec<&[Row]> = grid.rows.windows(2).filter(|pair| starts_again(pair)).collect();
    let all_are_told = !starts.is_empty() && starts.iter().all(is_told);
    if all_are_told { labels } else { Vec::new() }
}

/// What stands in the columns `telling` of a row.
fn name(row: &Row, telling: &[usize]) -> String {
    telling.iter().map(|&at| row.cell(at)).collect::<Vec<_>>().join("_")
}
