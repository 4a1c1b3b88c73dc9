//! What plunge is checked against: cases with a known answer, and measurements.
//!
//! A [`Case`] is one file in `validation/cases` and one line in [`CASES`]. `cargo xtask validate`
//! runs them and prints what was measured beside what is right.
//!
//! A [`measurement::MeasurementSet`] is a folder in `validation/data`; a [`forward::Forward`] is a
//! model that predicts it.

pub mod bench;
pub mod case;
mod cases;
pub mod compare;
pub mod diagnose;
mod discovery;
pub mod encounter;
pub mod errors;
pub mod fit;
pub mod fixed;
pub mod force_error;
pub mod forward;
pub mod held_out;
pub mod lack_of_fit;
pub mod measurement;
pub mod noise;
pub mod observable;
pub mod observed;
mod pair;
mod projection;
mod random;
mod resampling;
pub mod rig;
mod rounding;
mod score;
pub mod sensitivity;
mod signature;
mod significance;
#[cfg(test)]
mod test_sets;
pub mod verdict;
pub mod weights;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
