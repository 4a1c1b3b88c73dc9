//! Why an impact could not be integrated.

use thiserror::Error;

/// Why an impact could not be integrated.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ImpactError {
    #[error(
        "the solver finds no step small enough after {time:e} s: a force is not finite or too stiff"
    )]
    Stalled { time: f64 },
    #[error(
        "the force `{law}` is not finite, or a friction that pushes, {depth:e} m deep at {speed:e} m/s, \
         {time:e} s after the start"
    )]
    NotFinite {
        law: String,
        /// Of the lowest point (m).
        depth: f64,
        /// (m/s).
        speed: f64,
        time: f64,
    },
    #[error(
        "{time:.3e} s after the start the body sticks and slides in turn without getting on: a resistance is so large \
         that it stops the body within a step, or changes its sign where the body stops"
    )]
    Chatter { time: f64 },
    #[error(
        "after {steps} steps of the solver only {time:.3e} s are integrated: a force changes too fast to be followed"
    )]
    TooMuchWork { steps: usize, time: f64 },
}
