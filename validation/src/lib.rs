//! What plunge is checked against: cases with a known answer, and measurements.
//!
//! A [`Case`] is one file in `validation/cases` and one line in [`CASES`]. `cargo xtask validate`
//! runs them and prints what was measured beside what is right.
//!
//! A [`measurement::MeasurementSet`] is a folder in `validation/data`; a [`forward::Forward`] is a
//! model that predicts it.

pub mod case;
mod cases;
pub mod encounter;
pub mod fixed;
pub mod forward;
pub mod measurement;
pub mod rig;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
