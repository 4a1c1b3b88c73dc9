//! DeepLabCut: three rows of names (scorer, bodyparts, coords), then a row for each frame.

use super::wide::refuse_together;
use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Sheet};
use crate::tracking::track::{Track, without_still};

pub(super) const LAYOUT: Layout = Layout { fits, read };

/// Likelihood below which the program itself takes a point as not seen.
const SEEN: f64 = 0.6;

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    first_row(sheet).starts_with("scorer\t")
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let row = |name: &str| sheet.rows.iter().take(4).position(|row| row.cell(0) == name);
    let (Some(parts), Some(coords)) = (row("bodyparts"), row("coords")) else {
        let right = "the first rows are scorer, bodyparts and coords";
        return Err(sheet.fault("the rows `bodyparts` and `coords` are missing", right).at(1));
    };
    let grid = Grid::below(sheet, coords, None);
    let width = sheet.rows[coords].cells.len();
    let at = |part: &str, coordinate: &str| {
        (1..width).find(|at| {
            sheet.rows[parts].cell(*at) == part && sheet.rows[coords].cell(*at) == coordinate
        })
    };
    let mut tracks: Vec<Track> = Vec::new();
    for column in 1..width {
        let part = sheet.rows[parts].cell(column);
        if sheet.rows[coords].cell(column) != "y" {
            continue;
        }
        let likelihood = at(part, "likelihood");
        let is_seen = |cell: &str| !matches!(sheet.number(cell), Number::Value(p) if p < SEEN);
        let seen = grid
            .all_rows()
            .filter(|(_, row)| likelihood.is_none_or(|likelihood| is_seen(row.cell(likelihood))));
        let places = Places { t: None, z: column, x: at(part, "x") };
        let mut track = grid.track("DeepLabCut", places, seen)?;
        let unseen = grid.rows.len() - track.samples.len() - track.holes;
        if unseen > 0 {
            track
                .notes
                .push(format!("{unseen} readings of a likelihood below {SEEN} are left out"));
        }
        track.vertical.name = format!("{part} y");
        tracks.push(Track { name: Some(part.to_owned()), ..track });
    }
    if tracks.is_empty() {
        let right = "export x, y and likelihood of each body part";
        return Err(sheet.fault("no column is called `y`", right).at(sheet.rows[coords].line));
    }
    let mut tracks = match columns.of(Role::Vertical) {
        Some(asked) => vec![called(asked, tracks, sheet)?],
        None => without_still(tracks),
    };
    refuse_together(&tracks.iter().collect::<Vec<_>>(), sheet)?;
    if let [only] = &mut tracks[..] {
        only.name = None;
    }
    Ok(tracks)
}

/// The track of the column, or body part, that the user names.
fn called(asked: &str, tracks: Vec<Track>, sheet: &Sheet) -> Result<Track, Fault> {
    let names: Vec<String> =
        tracks.iter().map(|track| format!("`{}`", track.vertical.name)).collect();
    let is_it = |track: &Track| {
        track.vertical.name == asked || track.name.as_deref().is_some_and(|name| name == asked)
    };
    tracks.into_iter().find(is_it).ok_or_else(|| {
        let right = format!("found: {}", names.join(", "));
        sheet.fault(format!("no column is called `{asked}`"), right)
    })
}
