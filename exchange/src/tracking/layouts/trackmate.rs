//! TrackMate (ImageJ, Fiji): the table of spots, with one to four rows of names and units above it.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Row, Sheet};
use crate::tracking::track::{Track, without_still};
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    let first = first_row(sheet);
    first.contains("track_id") && first.contains("position_")
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let headers = sheet.rows.iter().take(4).take_while(|row| !sheet.is_numeric(row, 2)).count();
    let is_units = |row: &Row| row.cells.iter().any(|cell| cell.starts_with('('));
    let units = (1..headers).find(|at| is_units(&sheet.rows[*at]));
    let grid = Grid::below(sheet, 0, units);
    let grid = Grid { rows: &sheet.rows[headers..], ..grid };
    let id = grid.named("track_id")?;
    let z = match columns.of(crate::tracking::heading::Role::Vertical) {
        Some(asked) => grid.named(asked)?,
        None => grid.named("position_y")?,
    };
    let x = grid.named("position_x").ok().filter(|x| *x != z);
    let mut names: Vec<&str> = grid.rows.iter().map(|row| row.cell(id)).collect();
    names.sort_unstable();
    names.dedup();
    names.retain(|name| !name.is_empty() && !name.eq_ignore_ascii_case("none"));
    if names.is_empty() {
        let right = "track the spots, then export all spots of the tracks";
        return Err(sheet.fault("no spot belongs to a track", right));
    }
    let time = [grid.named("position_t").ok(), grid.named("frame").ok()];
    let changes = |at: &usize| grid.rows.iter().any(|row| row.cell(*at) != grid.rows[0].cell(*at));
    let Some(t) = time.into_iter().flatten().find(changes) else {
        let right = "export POSITION_T or FRAME with the spots";
        return Err(sheet.fault("neither POSITION_T nor FRAME tells the times", right));
    };
    // A video without a frame interval has numbers of frames for times, whatever their unit is called.
    let number = |row: &Row, at: usize| sheet.number(row.cell(at));
    let counts_frames = grid
        .named("frame")
        .is_ok_and(|frame| grid.rows.iter().all(|row| number(row, frame) == number(row, t)));
    let one = |name: &str| {
        let own = grid.all_rows().filter(|(_, row)| row.cell(id) == name);
        let mut track = grid.track("TrackMate", Places { t: Some(t), z, x }, own)?;
        if counts_frames {
            track.time.unit = Unit::Frame;
        }
        // Spots stand in any order.
        track.samples.sort_by(|a, b| a.t.total_cmp(&b.t));
        let name = name.strip_suffix(".0").unwrap_or(name);
        Ok(Track { name: Some(format!("track{name}")), ..track })
    };
    let tracks: Result<Vec<Track>, Fault> = names.into_iter().map(one).collect();
    Ok(named_if_several(without_still(tracks?)))
}

/// A table of one track is called by its own name.
fn named_if_several(mut tracks: Vec<Track>) -> Vec<Track> {
    if let [only] = &mut tracks[..] {
        only.name = None;
    }
    tracks
}
