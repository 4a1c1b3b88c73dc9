//! DLTdv: columns `pt1_cam1_X`, `pt1_cam1_Y`, or `pt1_X`, `pt1_Y`, `pt1_Z` in space; a row for each frame.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::Sheet;
use crate::tracking::track::{Track, without_still};

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    let first = first_row(sheet);
    let mut names = first.split('\t');
    names.any(|name| {
        name.strip_prefix("pt").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    })
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::below(sheet, 0, None);
    let point = |at: usize| grid.headings[at].stem.rsplit_once('_');
    let mut points: Vec<&str> = Vec::new();
    for at in 0..grid.headings.len() {
        if let Some((name, "x" | "y" | "z")) = point(at)
            && !points.contains(&name)
        {
            points.push(name);
        }
    }
    let column = |name: &str, axis: &str| {
        (0..grid.headings.len()).find(|at| point(*at) == Some((name, axis)))
    };
    let asked = columns.of(Role::Vertical).map(|name| grid.named(name)).transpose()?;
    let mut tracks = Vec::new();
    for name in points {
        // In space the third axis stands up; on a picture the second does.
        let Some(z) = column(name, "z").or_else(|| column(name, "y")) else {
            let right = format!("`{name}_X` needs a column `{name}_Y` beside it");
            return Err(sheet
                .fault(format!("the column `{name}_Y` is missing"), right)
                .at(sheet.rows[0].line));
        };
        if asked.is_some_and(|asked| asked != z) {
            continue;
        }
        let places = Places { t: None, z, x: column(name, "x") };
        let track = grid.track("DLTdv", places, grid.all_rows())?;
        if !track.samples.is_empty() {
            tracks.push(Track { name: Some(name.to_owned()), ..track });
        }
    }
    let mut tracks = without_still(tracks);
    if let [only] = &mut tracks[..] {
        only.name = None;
    }
    match tracks.is_empty() {
        true => Err(sheet.fault("no point was digitized", "every row of it is NaN or empty")),
        false => Ok(tracks),
    }
}
