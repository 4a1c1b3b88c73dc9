//! Tables of tracking programs as measurement sets.
//!
//! [`import`] reads tables, spreadsheets and text of data loggers, finds the first contact of each run in its
//! frames, and gives a [`Set`], whose files [`Set::write`] leaves in a folder. What no table holds comes from
//! [`Options`]; these are in `import.toml` too, which makes the same set again.
//!
//! `text` and `spreadsheet` give the cells of a file as a `sheet`; each file below `layouts` knows one program and
//! turns a sheet into tracks, with `heading` and `grid`; `begun` makes runs of them, `motion` and `scales` bring their
//! paths to SI and find contacts; `axis`, `mixed` and `lost` refuse or cut a path that is not that of one body along its axis; `surface` finds the level of the
//! surface, `bodies`, `density`, `names`, `called` and `conditions` what was dropped and which runs belong together; `import` puts it together, and `written` holds the files of the set.

mod axis;
mod begun;
mod bodies;
mod called;
mod conditions;
mod days;
mod density;
mod even;
mod falls;
mod fault;
mod grid;
mod heading;
mod import;
mod import_file;
mod inputs;
mod layouts;
mod lost;
mod mixed;
mod motion;
mod names;
mod options;
mod run;
mod scales;
mod set;
mod settings;
mod shapes;
mod sheet;
mod spreadsheet;
mod surface;
mod text;
mod tilt;
mod track;
mod units;
mod written;

use std::path::Path;

pub use fault::{Fault, TrackingError};
pub use import::import;
pub use import_file::{IMPORT_FILE, ImportFile};
pub use options::Options;
pub use set::{Earlier, Set, Understood};

/// Whether a file in `folder` is called like a table.
pub fn has_tables(folder: &Path) -> bool {
    inputs::tables_in(folder, None).is_ok()
}
