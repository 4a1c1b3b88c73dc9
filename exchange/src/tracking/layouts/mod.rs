//! Which programs write tables, and how: one file for each, one line here that registers it.

mod deeplabcut;
mod dltdv;
mod igor;
mod imagej;
mod kinovea;
mod labview;
mod loggerpro;
mod long;
mod optitrack;
mod pairs;
mod single;
mod stacked;
mod tracker;
mod trackmate;
mod wide;

use engine::units::Dimension;
use measurements::{Fall, Frame};

use super::fault::Fault;
use super::grid::Grid;
use super::heading::{Heading, Role};
use super::settings::Columns;
use super::sheet::Sheet;
use super::track::{Sample, Track};

/// A way to write tracks into a table.
pub(super) struct Layout {
    /// Whether a sheet is written so.
    fits: fn(&Sheet, &Columns) -> bool,
    /// Its tracks.
    read: fn(&Sheet, &Columns) -> Result<Vec<Track>, Fault>,
}

/// The layouts; the first that fits reads a sheet, and the last fits all.
const LAYOUTS: [&Layout; 15] = [
    &igor::LAYOUT,
    &optitrack::LAYOUT,
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
pub(super) fn tracks(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    refuse_derivatives(sheet, columns)?;
    refuse_forces(sheet, columns)?;
    let layout = LAYOUTS.into_iter().find(|layout| (layout.fits)(sheet, columns));
    (layout.unwrap_or(&single::LAYOUT).read)(sheet, columns)
}

/// Refuses the table of an accelerometer or of a velocimeter, which has no positions.
fn refuse_derivatives(sheet: &Sheet, columns: &Columns) -> Result<(), Fault> {
    /// Names of accelerations and velocities, which have components as positions do.
    const OTHERS: [&str; 7] = ["a", "acc", "accel", "acceleration", "v", "vel", "velocity"];
    let Ok(grid) = Grid::found(sheet) else { return Ok(()) };
    let is_derivative = |heading: &Heading| heading.is_acceleration() || heading.is_velocity();
    let is_place = |heading: &Heading| {
        let is_named = heading.role() == Some(Role::Vertical)
            || matches!(heading.point(), Some((Role::Vertical, name)) if !OTHERS.contains(&name.as_str()));
        // Columns that have the names of drops say by their unit what they are.
        (is_named || heading.is_length()) && !is_derivative(heading)
    };
    let is_asked = columns.of(Role::Vertical).is_some();
    if is_asked || grid.headings.iter().any(is_place) {
        return Ok(());
    }
    let Some(of) = grid.headings.iter().find(|heading| is_derivative(heading)) else {
        return Ok(());
    };
    let (what, written) = match of.is_acceleration() {
        true => (
            "an acceleration",
            "accelerations is written by hand, as `plunge new real-water-cones-acceleration` shows",
        ),
        false => ("a velocity", "velocities is written by hand, with kind = \"velocity\""),
    };
    let what = format!("`{}` is {what}, and no column is a position", of.name);
    let right =
        format!("import reads positions: name their column, --column z=NAME; a set of {written}");
    Err(sheet.fault(what, right))
}

/// Refuses the table of a testing machine or a penetrometer, which pushes a body.
fn refuse_forces(sheet: &Sheet, columns: &Columns) -> Result<(), Fault> {
    let Ok(grid) = Grid::found(sheet) else { return Ok(()) };
    // Of several runs beside each other, that without a position is named.
    let is_force = |heading: &&Heading| heading.is_force() && !heading.name.contains(": ");
    match grid.headings.iter().find(is_force) {
        Some(of) if columns.of(Role::Vertical).is_none() && !falls(&grid, columns) => {
            let what =
                format!("`{}` is a force or a pressure: the body is pushed, not dropped", of.name);
            let right = "a set of forces over depth is written by hand, as `plunge new real-plates-simulant` shows; \
                         --column z=NAME says that a column is the position of a body that falls";
            Err(sheet.fault(what, right))
        }
        _ => Ok(()),
    }
}

/// Whether the positions of a table are those of a body that falls at about gravity, by its units.
fn falls(grid: &Grid<'_>, columns: &Columns) -> bool {
    /// Accelerations of a fall (m/s²), braked by a guide or not.
    const FALL: std::ops::Range<f64> = 5.0..15.0;
    let Ok(track) =
        single::places(grid, columns).and_then(|at| grid.track("", at, grid.all_rows()))
    else {
        return false;
    };
    let units = (track.time.unit.si(Dimension::TIME), track.vertical.unit.si(Dimension::LENGTH));
    let (Some(second), Some(metre)) = units else { return false };
    let along = |sign: f64| -> Vec<Frame> {
        let of = |one: &Sample| Frame {
            t: second * one.t,
            z: sign * metre * one.z,
            x: 0.0,
            sigma: None,
        };
        track.samples.iter().map(of).collect()
    };
    let fall = |sign: f64| Fall::of_frames(&along(sign));
    [1.0, -1.0].into_iter().filter_map(fall).any(|fall| FALL.contains(&fall.acceleration.value))
}

/// The text of the first row, in small letters.
fn first_row(sheet: &Sheet) -> String {
    sheet.rows.first().map_or(String::new(), |row| row.cells.join("\t").to_lowercase())
}
