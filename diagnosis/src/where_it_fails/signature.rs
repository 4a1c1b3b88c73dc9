//! What the best candidates would do to the predictions.

use crate::fit::problem::{FitProblem, Fitted};
use crate::misfit::residual::{Residual, residuals};
use crate::verdict::Diagnosis;

/// How many candidates are drawn.
const SHOWN: usize = 2;

/// What an effect would do once the parameters have compensated.
#[derive(Clone, Debug, PartialEq)]
pub struct Signature {
    /// The effect.
    pub effect: String,
    /// Change of each predicted number (in its own unit), in the order of the residuals.
    pub change: Vec<f64>,
}

/// Of the best of the ranking: predictions of the model refitted with the effect, less those of the
/// model as it is, which has left `found`. Effects around which the model cannot be integrated are passed
/// over.
pub(super) fn best_two(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    (found, holdout): (&[Residual], &[usize]),
    diagnosis: &Diagnosis,
) -> Vec<Signature> {
    let ranked =
        diagnosis.ranking.iter().filter_map(|effect| Some((effect, effect.point.as_ref()?)));
    ranked
        .filter_map(|(effect, point)| {
            let with = residuals(problem, point, &baseline.noise, holdout).ok()?;
            let pairs = with.iter().zip(found);
            let change = pairs.map(|(with, without)| with.predicted - without.predicted).collect();
            Some(Signature { effect: effect.id.clone(), change })
        })
        .take(SHOWN)
        .collect()
}
