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
pub enum StepError {
    /// A position, velocity or energy is no longer a number.
    #[error("step {step}: {what} is not finite; a smaller time step than {dt:e} s may help")]
    NotFinite {
        /// The step.
        step: u64,
        /// Which quantity.
        what: &'static str,
        /// The time step (s).
        dt: f64,
    },
    /// A grain passed through another or through a wall.
    #[error(
        "step {step}: grain {grain} overlaps its neighbour by {overlap:.2e} m, more than a radius of \
         {radius:e} m; take a smaller time step than {dt:e} s or a stiffer contact"
    )]
    OverlapTooLarge {
        /// The step.
        step: u64,
        /// Identity of the grain.
        grain: u32,
        /// (m).
        overlap: f64,
        /// (m).
        radius: f64,
        /// The time step (s).
        dt: f64,
    },
    /// The intruder has gone through a wall.
    #[error(
        "step {step}: the intruder is {overlap:.2e} m inside of the {wall}, more than the radius of {radius:e} m \
         with which it touches; take a smaller time step than {dt:e} s or a stiffer contact"
    )]
    IntruderInWall {
        /// The step.
        step: u64,
        /// The floor or a side.
        wall: &'static str,
        /// (m).
        overlap: f64,
        /// (m).
        radius: f64,
        /// The time step (s).
        dt: f64,
    },
    /// The intruder may have gone past grains without touching them.
    #[error(
        "step {step}: the intruder moves at {speed:.3e} m/s, {way:.2e} m in a step of {dt:e} s, farther than \
         the radius {radius:e} m of the smallest grain, and would pass grains unseen; take a time step of \
         {suggested_dt:.1e} s"
    )]
    IntruderTooFast {
        /// The step.
        step: u64,
        /// Of its fastest point (m/s).
        speed: f64,
        /// In the step (m).
        way: f64,
        /// Of the smallest grain (m).
        radius: f64,
        /// The time step (s).
        dt: f64,
        /// One that would do (s).
        suggested_dt: f64,
    },
    /// The energy budget no longer closes.
    #[error(
        "step {step}: {unaccounted:.2e} J of {scale:.2e} J are unaccounted for, a closure of \
         {closure:.1e} where {limit} is allowed; try a time step of {suggested_dt:e} s \
         (the largest overlap is {overlap:.2e} m at grain {grain})"
    )]
    OpenBudget {
        /// The step.
        step: u64,
        /// Energy unaccounted for (J).
        unaccounted: f64,
        /// What it is compared with: the initial energy of the intruder (J).
        scale: f64,
        /// Their ratio.
        closure: f64,
        /// What the run allows.
        limit: f64,
        /// Half the present step (s).
        suggested_dt: f64,
        /// Largest overlap in the bed (m).
        overlap: f64,
        /// Identity of the grain that has it.
        grain: u32,
    },
}
