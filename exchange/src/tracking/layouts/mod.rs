//! Which programs write tables, and how: one file for each, one line here that registers it.

mod deeplabcut;
mod dltdv;
mod imagej;
mod kinovea;
mod labview;
mod loggerpro;
mod long;
mod pairs;
mod single;
mod stacked;
mod tracker;
mod trackmate;
mod wide;

use super::fault::Fault;
use super::grid::Grid;
use super::heading::{Heading, Role};
use super::settings::Columns;
use super::sheet::Sheet;
use super::track::Track;

/// A way to write tracks into a table.
pub(super) struct Layout {
    /// Whether a sheet is written so.
    fits: fn(&Sheet, &Columns) -> bool,
    /// Its tracks.
    read: fn(&Sheet, &Columns) -> Result<Vec<Track>, Fault>,
}

/// The layouts; the first that fits reads a sheet, and the last fits all.
const LAYOUTS: [&Layout; 13] = [
    &trackmate::LAYOUT,
    &deeplabcut::LAYOUT,
    &dltdv::LAYOUT,
    &labview::LAYOUT,
    &loggerpro::LAYOUT,
    &stacked::LAYOUT,
    &kinovea::LAYOUT,
    &tracker::LAYOUT,
    &imagej::LAYOUT,
    &long::LAYOUT,
    &pairs::LAYOUT,
    &wide::LAYOUT,
    &single::LAYOUT,
];

/// The tracks of a sheet.
///
/// # Errors
/// What is wrong with it.
pub(super) fn tracks(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    refuse_accelerations(sheet, columns)?;
    refuse_forces(sheet, columns)?;
    let layout = LAYOUTS.into_iter().find(|layout| (layout.fits)(sheet, columns));
    (layout.unwrap_or(&single::LAYOUT).read)(sheet, columns)
}

/// Refuses the table of an accelerometer, which has no positions.
fn refuse_accelerations(sheet: &Sheet, columns: &Columns) -> Result<(), Fault> {
    /// Names of accelerations and velocities, which have components as positions do.
    const OTHERS: [&str; 7] = ["a", "acc", "accel", "acceleration", "v", "vel", "velocity"];
    let Ok(grid) = Grid::found(sheet) else { return Ok(()) };
    let is_place = |heading: &Heading| {
        let is_named = heading.role() == Some(Role::Vertical)
            || matches!(heading.point(), Some((Role::Vertical, name)) if !OTHERS.contains(&name.as_str()));
        is_named && !heading.is_acceleration()
    };
    let of = grid.headings.iter().find(|heading| heading.is_acceleration());
    match of {
        Some(of) if columns.of(Role::Vertical).is_none() && !grid.headings.iter().any(is_place) => {
            let what = format!("`{}` is an acceleration, and no column is a position", of.name);
            let right = "import reads positions: name their column, --column z=NAME; a set of accelerations is written by hand, \
                         as `plunge new real-water-cones-acceleration` shows";
            Err(sheet.fault(what, right))
        }
        _ => Ok(()),
    }
}

/// Refuses the table of a testing machine or a penetrometer, which pushes a body.
fn refuse_forces(sheet: &Sheet, columns: &Columns) -> Result<(), Fault> {
    let Ok(grid) = Grid::found(sheet) else { return Ok(()) };
    // Of several runs beside each other, that without a position is named.
    let is_force = |heading: &&Heading| heading.is_force() && !heading.name.contains(": ");
    match grid.headings.iter().find(is_force) {
        Some(of) if columns.of(Role::Vertical).is_none() => {
            let what =
                format!("`{}` is a force or a pressure: the body is pushed, not dropped", of.name);
            let right = "a set of forces over depth is written by hand, as `plunge new real-plates-simulant` shows; \
                         --column z=NAME says that a column is the position of a body that falls";
            Err(sheet.fault(what, right))
        }
        _ => Ok(()),
    }
}

/// The text of the first row, in small letters.
fn first_row(sheet: &Sheet) -> String {
    sheet.rows.first().map_or(String::new(), |row| row.cells.join("\t").to_lowercase())
}
