//! What is missing in a model of impacts: measurements held against it, and the effect that would explain them.
//!
//! A [`measurements::MeasurementSet`] is what was measured; a [`forward::Forward`] is a model that predicts it: a force
//! law ([`mod@resistive`]) or a bed of grains ([`beds`]). What the two have to do with each other is said in these
//! steps:
//!
//! 1. [`observed`] makes vectors of the runs, one [`forward::observable::Layout`] per condition;
//! 2. [`forward::sensitivity`] and [`mod@noise`] learn from repeats how much they scatter;
//! 3. [`mod@fit`] fits a model under that noise;
//! 4. [`mod@misfit`] says how wrong a fitted model is, where, and whether by more than noise;
//! 5. [`mod@ranking`] weighs effects, alone and in pairs, by what they explain;
//! 6. [`mod@missing_force`] says, where no listed effect explains the data, what force is missing;
//! 7. [`mod@verdict`] is the answer, with the reasons against it;
//! 8. [`next::recommend`] says what to measure next where several effects remain.
//!
//! The entrances: [`compare::compare`] holds each revision of a model against the runs, and [`where_it_fails`] writes
//! that as tables and [`mod@picture`]s; [`diagnose::diagnose`] says which effect is missing; [`mod@calibrate`] says how
//! often such verdicts come true before sets of the same design; [`runs`] holds a run against a run.

pub mod beds;
pub mod calibrate;
pub mod compare;
pub mod diagnose;
pub mod fit;
pub mod forward;
pub mod misfit;
pub mod missing_force;
pub mod next;
pub mod noise;
pub mod observed;
pub mod picture;
mod projection;
mod random;
pub mod ranking;
pub mod resistive;
mod rounding;
pub mod runs;
mod strength;
#[cfg(test)]
mod test_sets;
pub mod verdict;
pub mod where_it_fails;
