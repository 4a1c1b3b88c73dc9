//! What the best candidates would do to the predictions.

use crate::bench::{Bench, BenchError, Fitted};
use crate::residual::{Residual, residuals};
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
/// model as it is, which has left `found`.
pub(super) fn best_two(
    bench: &Bench<'_>,
    baseline: &Fitted,
    found: &[Residual],
    diagnosis: &Diagnosis,
) -> Result<Vec<Signature>, BenchError> {
    let ranked =
        diagnosis.ranking.iter().filter_map(|effect| Some((effect, effect.point.as_ref()?)));
    ranked
        .take(SHOWN)
        .map(|(effect, point)| {
            let with = residuals(bench, point, &baseline.noise)?;
            let pairs = with.iter().zip(found);
            let change = pairs.map(|(with, without)| with.predicted - without.predicted).collect();
            Ok(Signature { effect: effect.id.clone(), change })
        })
        .collect()
}
