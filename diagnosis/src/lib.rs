//! What is missing in a model of impacts: measurements held against it, and the effect that would explain them.
//!
//! A [`measurements::MeasurementSet`] is what was measured; a [`forward::Forward`] is a model that predicts it: a force
//! law ([`mod@resistive`]) or a bed of grains ([`beds`]). What the two have to do with each other is said in these
//! steps:
//!
//! 1. [`observed`] makes vectors of the runs, one [`observable::Layout`] per condition;
//! 2. [`sensitivity`], [`noise`] and [`weights`] learn from repeats how much they scatter;
//! 3. [`mod@fit_problem`] fits a model under that noise, by [`fit`];
//! 4. [`compare::compare`] says how wrong each revision of a model is and where
//!    ([`errors`], [`lack_of_fit`], [`force_error`], [`residual`]), and [`where_it_fails`] writes that
//!    as tables and [`mod@picture`]s;
//! 5. [`diagnose::diagnose`] says which effect is missing, as a [`verdict`], with the force of the effect
//!    ([`added_force`]) and how often benchmark sets with this verdict are named rightly;
//! 6. [`mod@missing_force`] says, where no listed effect explains the data, what force is missing;
//! 7. [`mod@calibrate`] says how often such verdicts come true before sets of the same design;
//! 8. [`next::recommend`] says what to measure next where several effects remain.
//!
//! [`runs`] holds a run against a run.

pub mod added_force;
pub mod apparatus;
pub mod beds;
pub mod between;
mod broyden;
pub mod calibrate;
pub mod compare;
pub mod covariate;
mod curves;
pub mod diagnose;
mod directions;
mod discovery;
mod doubts;
pub mod error_columns;
pub mod error_unit;
pub mod errors;
pub mod field;
pub mod fit;
pub mod fit_problem;
pub mod fitted_parameters;
pub mod force_error;
pub mod forward;
mod frequency;
pub mod held_out;
mod judge;
pub mod lack_of_fit;
mod marginal;
pub mod missing_force;
pub mod next;
pub mod noise;
mod noise_floor;
pub mod observable;
pub mod observed;
pub mod pair;
pub mod picture;
mod projection;
mod random;
mod ranked;
mod reading_error;
mod redraw;
mod resampling;
pub mod residual;
pub mod resistive;
mod restricted_likelihood;
mod rounding;
pub mod runs;
mod score;
pub mod sensitivity;
mod series;
mod signature;
mod significance;
mod strength;
#[cfg(test)]
mod test_sets;
pub mod verdict;
pub mod weights;
pub mod where_it_fails;
