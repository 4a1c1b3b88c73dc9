//! Why an impact could not be integrated.

use thiserror::Error;

/// Why an impact could not be integrated.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ImpactError {
    /// The solver found no step small enough.
    #[error(
        "the solver finds no step small enough after {time:e} s: a force is not finite or too stiff"
    )]
    Stalled {
        /// Where (s).
        time: f64,
    },
    /// A force has no value.
    #[error(
        "the force `{law}` is not finite, or a friction that pushes, {depth:e} m deep at {speed:e} m/s, \
         {time:e} s after the start"
    )]
    NotFinite {
        /// The law, by its first account in the ledger.
        law: String,
        /// Of the lowest point (m).
        depth: f64,
        /// (m/s).
        speed: f64,
        /// (s).
        time: f64,
    },
    /// The body chatters between two modes.
    #[error(
        "{time:.3e} s after the start the body sticks and slides in turn without getting on: a resistance is so large \
         that it stops the body within a step, or changes its sign where the body stops"
    )]
    Chatter {
        /// When (s).
        time: f64,
    },
    /// The integration costs more than it may.
    #[error(
        "after {steps} steps of the solver only {time:.3e} s are integrated: a force changes too fast to be followed"
    )]
    TooMuchWork {
        /// Steps that were tried.
        steps: usize,
        /// How far it has come (s).
        time: f64,
    },
}
