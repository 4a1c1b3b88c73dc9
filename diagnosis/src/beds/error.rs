//! Why a set cannot be compared with a model of grains, or the model not be diagnosed.

use runner::CampaignError;
use thiserror::Error;

use super::baseline::BaselineError;
use super::bed_model::BedModelError;
use crate::fit::problem::FitError;

/// Why there is no comparison or diagnosis.
#[derive(Debug, Error)]
pub enum BedError {
    /// The model and the set do not fit each other.
    #[error(transparent)]
    BedModel(#[from] BedModelError),
    /// The impacts were not run to the end.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// They say nothing.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// The statistics fail.
    #[error(transparent)]
    FitProblem(#[from] FitError),
    /// The bed of the set is many times heavier or lighter than that of the model.
    #[error(
        "the set states a bulk density of {stated} {unit}, and the bed of the model has {own:.4} {unit}: the stated number \
         may be in another unit"
    )]
    Density {
        /// Of the set (in `unit`).
        stated: f64,
        /// Of the model (in `unit`).
        own: f64,
        /// That of a planar bed is per area.
        unit: &'static str,
    },
    /// The name is not a candidate of the model.
    #[error("there is no candidate `{id}` for this model; there are: {}", known.join(", "))]
    UnknownCandidate {
        /// What was asked for.
        id: String,
        /// What there is.
        known: Vec<&'static str>,
    },
}
