//! What plunge is checked against: cases with a known answer, and measurements.
//!
//! A [`Case`] is one file in `validation/cases` and one line in [`CASES`]; a [`published::Row`] is a
//! published result that is run again and judged, the cases among them. `cargo xtask validate`
//! runs them and prints what was measured beside what is right.
//!
//! A [`measurements::MeasurementSet`] is a folder in `validation/data`; a [`forward::Forward`] is a
//! model that predicts it. What the two have to do with each other is said in these steps:
//!
//! 1. [`observed`] makes vectors of the runs, one [`observable::Layout`] per condition;
//! 2. [`sensitivity`], [`noise`] and [`weights`] learn from repeats how much they scatter;
//! 3. [`mod@bench`] fits a model under that noise, by [`fit`];
//! 4. [`compare::compare`] says how wrong each revision of a model is and where
//!    ([`errors`], [`lack_of_fit`], [`force_error`], [`residual`]), and [`where_it_fails`] writes that
//!    as tables and [`mod@picture`]s;
//! 5. [`diagnose::diagnose`] says which effect is missing, as a [`verdict`];
//! 6. [`next::recommend`] says what to measure next where several effects remain.
//!
//! [`runs`] holds a run against a run; [`command`] is what the programs in `bin/` have in common.

pub mod beds;
pub mod bench;
pub mod benchmark;
pub mod case;
mod cases;
mod chord;
pub mod command;
pub mod compare;
pub mod covariate;
pub mod diagnose;
mod directions;
mod discovery;
pub mod encounter;
pub mod errors;
pub mod fit;
pub mod fixed;
pub mod force_error;
pub mod forward;
pub mod held_out;
pub mod lack_of_fit;
mod marginal;
pub mod next;
pub mod noise;
pub mod observable;
pub mod observed;
mod pair;
pub mod picture;
mod projection;
pub mod published;
mod random;
mod redraw;
mod resampling;
pub mod residual;
pub mod resistive;
pub mod rig;
mod rounding;
pub mod runs;
mod score;
pub mod sensitivity;
mod signature;
mod significance;
pub mod speed;
pub mod spheres;
mod strength;
pub mod suggestion;
#[cfg(test)]
mod test_sets;
pub mod three_shapes;
pub mod verdict;
pub mod weights;
pub mod where_it_fails;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
