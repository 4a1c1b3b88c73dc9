//! Reasons of a fit for which its verdict is no more than suggested, and what its noise is known from.

use crate::fit::problem::{FitProblem, Fitted};
use crate::misfit::held_out::HeldOut;
use crate::noise::NoiseSource;
use crate::verdict::{Amplitude, Evidence, StrengthReason};

/// Fewest deviations of repeats from their means that make more than a suggestion: a standard deviation
/// from eight is known to a quarter.
const CONTRASTS: usize = 8;

/// Relative scatter of the coefficients of repeats from which they are none, where nothing else is found.
const NO_REPEATS: f64 = 0.5;

/// Why a verdict that names `amplitudes`, in the fit `proposed`, is only suggested; nothing where it is confirmed.
///
/// A verdict is confirmed if the repeats give at least [`CONTRASTS`] independent deviations. One that names an effect needs
/// more: each amplitude is at most two standard errors outside of its usual range; no error of the apparatus is far beyond
/// its stated size; held-out conditions are predicted better; none becomes unpredictable.
pub(crate) fn doubts(
    problem: &FitProblem<'_>,
    proposed: &Fitted,
    amplitudes: &[Amplitude],
    held_out: &HeldOut,
) -> Vec<StrengthReason> {
    let few = problem.observed.contrasts() < CONTRASTS;
    let mut doubts: Vec<StrengthReason> = match proposed.noise.source {
        NoiseSource::Repeats => few.then_some(StrengthReason::FewRepeats).into_iter().collect(),
        NoiseSource::Stated => vec![StrengthReason::StatedErrors],
        NoiseSource::AssumedScatter | NoiseSource::Assumed => vec![StrengthReason::AssumedScatter],
    };
    if amplitudes.is_empty() {
        return doubts;
    }
    if amplitudes.iter().any(|amplitude| amplitude.unusual) {
        doubts.push(StrengthReason::AmplitudeOutsideUsualRange);
    }
    if problem.data(&proposed.weights).is_strained(&proposed.fit.point) {
        doubts.push(StrengthReason::ApparatusFarFromStated);
    }
    doubts.extend(held_out.doubt());
    doubts
}

/// What the noise of `fitted` is known from.
pub(crate) fn evidence(problem: &FitProblem<'_>, fitted: &Fitted) -> Evidence {
    match fitted.noise.source {
        NoiseSource::Repeats if problem.observed.contrasts() < CONTRASTS => Evidence::FewRepeats,
        NoiseSource::Repeats => Evidence::Repeats,
        NoiseSource::Stated | NoiseSource::AssumedScatter | NoiseSource::Assumed => {
            Evidence::StatedErrors
        }
    }
}

/// Why the scatter between repeats in this fit of the model as it is hides every effect; `None` if the scatter is plausible.
pub(crate) fn no_repeats(fitted: &Fitted) -> Option<String> {
    let scatter = fitted.noise.spread.coefficient;
    (scatter >= NO_REPEATS).then(|| {
        format!(
            "runs of one condition differ by {:.0} % of their resistance, as repeats do not: compare their bodies, masses \
             and speeds, and what `runs.csv` says of their conditions",
            100.0 * scatter
        )
    })
}
