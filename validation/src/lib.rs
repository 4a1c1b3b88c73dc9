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
pub mod fit;
pub mod fixed;
pub mod forward;
pub mod measurement;
pub mod noise;
pub mod observable;
pub mod observed;
mod resampling;
pub mod rig;
pub mod sensitivity;
#[cfg(test)]
mod test_sets;
pub mod weights;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
