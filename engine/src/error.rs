//! What can go wrong in a run.

use thiserror::Error;

/// The system did not give the threads that were asked for.
#[derive(Debug, Error)]
#[error("cannot start {threads} threads: {source}")]
pub struct ThreadsError {
    /// How many were asked for.
    pub threads: usize,
    /// Why not.
    pub source: rayon::ThreadPoolBuildError,
}

/// A step that cannot be trusted.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum StepError {
    #[error("step {step}: {what} is not finite; a smaller time step than {dt:e} s may help")]
    NotFinite { step: u64, what: &'static str, dt: f64 },
    #[error(
        "step {step}: grain {grain} overlaps its neighbour by {overlap:.2e} m, more than a radius of \
         {radius:e} m; take a smaller time step than {dt:e} s or a stiffer contact"
    )]
    OverlapTooLarge {
        step: u64,
        grain: u32,
        /// (m).
        overlap: f64,
        /// (m).
        radius: f64,
        dt: f64,
    },
    #[error(
        "step {step}: the intruder is {overlap:.2e} m inside of the {wall}, more than the radius of {radius:e} m \
         with which it touches; take a smaller time step than {dt:e} s or a stiffer contact"
    )]
    IntruderInWall {
        step: u64,
        wall: &'static str,
        /// (m).
        overlap: f64,
        /// (m).
        radius: f64,
        dt: f64,
    },
    #[error(
        "step {step}: the intruder moves at {speed:.3e} m/s, {way:.2e} m in a step of {dt:e} s, farther than \
         the radius {radius:e} m of the smallest grain, and would pass grains unseen; take a time step of \
         {suggested_dt:.1e} s"
    )]
    IntruderTooFast {
        step: u64,
        /// Of its fastest point (m/s).
        speed: f64,
        /// In the step (m).
        way: f64,
        /// Of the smallest grain (m).
        radius: f64,
        dt: f64,
        suggested_dt: f64,
    },
    #[error(
        "step {step}: {unaccounted:.2e} J of {scale:.2e} J are unaccounted for, a closure of \
         {closure:.1e} where {limit} is allowed; try a time step of {suggested_dt:e} s \
         (the largest overlap is {overlap:.2e} m at grain {grain})"
    )]
    OpenBudget {
        step: u64,
        unaccounted: f64,
        scale: f64,
        closure: f64,
        limit: f64,
        suggested_dt: f64,
        /// Largest overlap in the bed (m).
        overlap: f64,
        grain: u32,
    },
}
