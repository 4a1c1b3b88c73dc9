//! Why a set cannot be compared with a model of grains, or the model not be diagnosed.

use runner::CampaignError;
use thiserror::Error;

use super::baseline::BaselineError;
use super::bed_model::BedModelError;
use crate::fit::problem::FitError;

/// Why there is no comparison or diagnosis.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum BedError {
    #[error(transparent)]
    BedModel(#[from] BedModelError),
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    #[error(transparent)]
    FitProblem(#[from] FitError),
    #[error(
        "the set states a bulk density of {stated} {unit}, and the bed of the model has {own:.4} {unit}: the stated number \
         may be in another unit"
    )]
    Density { stated: f64, own: f64, unit: &'static str },
    #[error("there is no candidate `{id}` for this model; there are: {}", known.join(", "))]
    UnknownCandidate { id: String, known: Vec<&'static str> },
}
