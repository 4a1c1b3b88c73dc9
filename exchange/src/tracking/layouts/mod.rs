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
    let layout = LAYOUTS.into_iter().find(|layout| (layout.fits)(sheet, columns));
    (layout.unwrap_or(&single::LAYOUT).read)(sheet, columns)
}

/// The text of the first row, in small letters.
fn first_row(sheet: &Sheet) -> String {
    sheet.rows.first().map_or(String::new(), |row| row.cells.join("\t").to_lowercase())
}
