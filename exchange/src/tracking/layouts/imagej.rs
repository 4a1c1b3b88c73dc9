//! ImageJ: Manual Tracking (`Track n°`, `Slice n°`), MTrackJ (`TID`, `PID`), and tables of results with `Slice`.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::{Heading, Role};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::Sheet;
use crate::tracking::track::Track;
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    let first = first_row(sheet);
    let names: Vec<&str> = first.split('\t').collect();
    let has = |name: &str| names.contains(&name);
    let is_mtrackj = has("tid") && has("pid");
    let starts = |start: &str| names.iter().any(|name| name.starts_with(start));
    let is_manual = starts("track n") && starts("slice");
    let is_table =
        names[0].is_empty() && (starts("slice") || has("frame")) && (has("y") || has("ym"));
    is_mtrackj || is_manual || is_table
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let grid = Grid::below(sheet, 0, None);
    let find = |is_it: &dyn Fn(&Heading) -> bool| grid.headings.iter().position(is_it);
    let stem = |names: &'static [&'static str]| {
        names.iter().find_map(|name| find(&|one: &Heading| one.stem == *name))
    };
    let run = find(&|one| one.stem.starts_with("track n") || one.stem == "tid");
    let time = stem(&["t"]).filter(|at| matches!(grid.headings[*at].unit, Unit::Known(_)));
    let frame =
        find(&|one| one.stem.starts_with("slice") || matches!(one.stem.as_str(), "frame" | "pid"));
    let asked = columns.of(Role::Vertical).map(|name| grid.named(name)).transpose()?;
    let Some(z) = asked.or_else(|| stem(&["y", "ym", "by"])) else {
        let right = "measure the centroid or centre of mass, so that X and Y are in the table";
        return Err(sheet.fault("the table has no column Y", right).at(sheet.rows[0].line));
    };
    let places = Places { t: time.or(frame), z, x: stem(&["x", "xm", "bx"]).filter(|x| *x != z) };
    let name = |row: &crate::tracking::sheet::Row| run.map_or("", |run| row.cell(run)).to_owned();
    let mut names: Vec<String> = Vec::new();
    for row in grid.rows {
        if !names.contains(&name(row)) {
            names.push(name(row));
        }
    }
    let several = names.len() > 1;
    let one = |own: &String| {
        let rows = grid.all_rows().filter(|(_, row)| name(row) == *own);
        let mut track = grid.track("ImageJ", places, rows)?;
        if time.is_none() && frame.is_some() {
            track.time.unit = Unit::Frame;
        }
        if track.vertical.unit == Unit::Unstated {
            // Tables of results do not say it; an image that was not calibrated counts pixels.
            track.vertical.unit = Unit::Pixel;
        }
        Ok(Track { name: several.then(|| format!("track{own}")), ..track })
    };
    names.iter().map(one).collect()
}
