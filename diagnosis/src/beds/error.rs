//! Why a set cannot be compared with a model of grains, or the model not be diagnosed.

use runner::CampaignError;
use thiserror::Error;

use super::baseline::BaselineError;
use super::stand::StandError;
use crate::bench::BenchError;

/// Why there is no comparison or diagnosis.
#[derive(Debug, Error)]
pub enum BedError {
    /// The model and the set do not fit each other.
    #[error(transparent)]
    Stand(#[from] StandError),
    /// The impacts were not run to the end.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// They say nothing.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// The statistics fail.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// The name is not a candidate of the model.
    #[error("there is no candidate `{id}` for this model; there are: {}", known.join(", "))]
    UnknownCandidate {
        /// What was asked for.
        id: String,
        /// What there is.
        known: Vec<&'static str>,
    },
}
