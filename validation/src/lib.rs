//! What plunge is checked against: cases with a known answer, and measurements.
//!
//! A [`Case`] is one file in `validation/cases` and one line in [`CASES`]; a [`published::Row`] is a
//! published result that is run again and judged, the cases among them. `cargo xtask validate`
//! runs them and prints what was measured beside what is right.
//!
//! A folder in `validation/data` is a set of measurements; [`benchmark`] says how often a diagnosis is right,
//! [`speed`] how fast a bed is stepped, and [`three_shapes`] is a study of three intruders. Nothing imports this
//! crate: what users run is in `diagnosis` and below.
//!
//! [`command`] is what the programs in `bin/` have in common.

pub mod benchmark;
pub mod case;
mod cases;
pub mod command;
pub mod encounter;
pub mod fixed;
pub mod published;
pub mod rig;
pub mod speed;
pub mod spheres;
pub mod three_shapes;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
