//! Tables of tracking programs as measurement sets.
//!
//! [`import`] reads tables, spreadsheets and text of data loggers, finds the first contact of each run in its
//! frames, and gives a [`Set`], whose files [`Set::write`] leaves in a folder. What no table holds comes from
//! [`Options`]; these are in `import.toml` too, which makes the same set again.
//!
//! `text` and `spreadsheet` give the cells of a file as a `sheet`; each file below `layouts` knows one program and
//! turns a sheet into tracks, with `heading` and `grid`; `motion` brings a track to SI and finds its contact,
//! `surface` the level of the surface, `bodies`, `names` and `conditions` what was dropped and which runs belong
//! together; `written` holds the files of the set.

mod bodies;
mod conditions;
mod fault;
mod grid;
mod heading;
mod import_file;
mod inputs;
mod layouts;
mod motion;
mod names;
mod options;
mod run;
mod set;
mod settings;
mod sheet;
mod spreadsheet;
mod surface;
mod text;
mod track;
mod units;
mod written;

use std::path::Path;

pub use fault::{Fault, TrackingError};
pub use import_file::{IMPORT_FILE, ImportFile};
pub use options::Options;
pub use run::{Set, Understood};
pub use set::import;

/// Whether a file in `folder` is called like a table.
#[must_use]
pub fn has_tables(folder: &Path) -> bool {
    inputs::tables_in(folder).is_ok()
}
