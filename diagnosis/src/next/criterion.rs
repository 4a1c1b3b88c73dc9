//! How well a condition would separate rivals.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::foreseen::Foreseen;
use super::rival::Rival;
use crate::noise::Noise;
use crate::sensitivity::Sensitivity;
use crate::weights::Weight;

/// The least expected difference of χ² between two of `rivals`, and which two. One of them must explain
/// the measurements that there are: which of two that do not is no question. `None` if a model cannot be
/// integrated there.
pub(super) fn least(
    foreseen: &Foreseen,
    noise: &Noise,
    rivals: &[Rival],
) -> Option<(f64, [usize; 2])> {
    let forward = foreseen.forward();
    let leader = rivals.first()?.before(forward)?;
    let observed = foreseen.observed();
    let sensitivity = Sensitivity::at(&leader.point, forward, 0, observed.reach).ok()?;
    let own = forward.own_covariance(0, &leader.point.effects);
    let weight = Weight::new(observed, &sensitivity, noise, own)?;
    let predicted: Vec<(DVector<f64>, DMatrix<f64>)> = rivals
        .iter()
        .map(|rival| {
            let placed = rival.before(forward)?;
            let mean = weight.whiten(&placed.point.predict(forward, 0).ok()?);
            let spread = placed.spread(forward, 0, |column| weight.whiten(column)).ok()?;
            Some((mean, spread))
        })
        .collect::<Option<_>>()?;
    let mut least: Option<(f64, [usize; 2])> = None;
    for k in 0..rivals.len() {
        for l in k + 1..rivals.len() {
            if !rivals[k].explains && !rivals[l].explains {
                continue;
            }
            let delta = expected(&predicted[k], &predicted[l])?;
            if least.is_none_or(|(smallest, _)| delta < smallest) {
                least = Some((delta, [k, l]));
            }
        }
    }
    least
}

/// Expected difference of χ² between two whitened predictions, each with its covariance.
fn expected(
    (mean, spread): &(DVector<f64>, DMatrix<f64>),
    (other, other_spread): &(DVector<f64>, DMatrix<f64>),
) -> Option<f64> {
    let difference = mean - other;
    let mut covariance = DMatrix::identity(mean.len(), mean.len());
    for one in [spread, other_spread].into_iter().filter(|one| !one.is_empty()) {
        covariance += one;
    }
    let delta = difference.dot(&Cholesky::new(covariance)?.solve(&difference));
    delta.is_finite().then_some(delta)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_fits_leave_open_does_not_separate() {
        let at = |x: f64, variance: f64| {
            (DVector::from_element(1, x), DMatrix::from_element(1, 1, variance))
        };
        // 3² over 1 + 0 + 0, and over 1 + 5 + 3: exact but for rounding.
        let known = expected(&at(0.0, 0.0), &at(3.0, 0.0)).expect("it is positive definite");
        let open = expected(&at(0.0, 5.0), &at(3.0, 3.0)).expect("it is positive definite");
        assert!((known - 9.0).abs() < 1e-12 && (open - 1.0).abs() < 1e-12, "{known} {open}");
    }
}
