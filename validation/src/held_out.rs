//! Errors on conditions that were not fitted to.

use measurements::Kind;
use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

use crate::bench::{Bench, BenchError, Fitted};
use crate::errors::{Errors, Sums};
use crate::fit::Data;
use crate::noise::log_determinant;
use crate::observed::{Observed, ObservedCondition};
use crate::rounding::six_digits;

/// Errors on held-out conditions without and with what is proposed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeldOut {
    /// Of the model as it is.
    #[serde(serialize_with = "six_digits")]
    pub before: f64,
    /// With what is proposed; as before, if nothing is.
    #[serde(serialize_with = "six_digits")]
    pub after: f64,
    /// What means of so many runs would miss the truth by.
    #[serde(serialize_with = "six_digits")]
    pub noise_floor: f64,
    /// What the three are root mean squares of.
    pub unit: Unit,
    /// Which conditions were left out.
    pub conditions: LeftOut,
    /// How much the logarithm of the predictive density rises by what is proposed, over the
    /// conditions that can be predicted both with and without it.
    #[serde(serialize_with = "six_digits")]
    pub log_density_gain: f64,
}

/// Unit of an error over several kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Unit {
    /// Positions (m).
    #[serde(rename = "m")]
    Position,
    /// Scalars, relative (1 = 100 %).
    #[serde(rename = "1")]
    Relative,
}

/// Which conditions were left out of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LeftOut {
    /// Those that the set holds out.
    Holdout,
    /// Each in turn, since the set holds out none.
    OneAtATime,
}

/// A loss of predictive density beyond this (odds 20 to 1) refutes what is proposed; smaller ones are
/// within what few held-out conditions say by chance.
const REFUTED: f64 = 3.0;

impl HeldOut {
    /// Of `before` and `after`.
    ///
    /// # Errors
    /// If the model fails.
    pub fn of(bench: &Bench<'_>, before: &Fitted, after: &Fitted) -> Result<Self, BenchError> {
        let unit = match bench.set.kind {
            Kind::Trajectory => Unit::Position,
            Kind::Scalar => Unit::Relative,
        };
        let pick = |errors: &Errors| match unit {
            Unit::Position => errors.position,
            Unit::Relative => errors.relative,
        };
        let (conditions, judged) = match bench.observed.holdout.is_empty() {
            true => (LeftOut::OneAtATime, &bench.observed.fit),
            false => (LeftOut::Holdout, &bench.observed.holdout),
        };
        let predict = |fitted: &Fitted| match conditions {
            LeftOut::Holdout => Predicted::unseen(bench, after, fitted, judged),
            LeftOut::OneAtATime => Predicted::left_out(bench, after, fitted),
        };
        let both = in_both(judged, predict(before)?, predict(after)?);
        let error = |which: fn(&(usize, Predicted, Predicted)) -> (usize, &Predicted)| {
            let mut sums = Sums::default();
            for (condition, predicted) in both.iter().map(which) {
                let observed = &bench.observed.conditions[condition];
                sums.add(&observed.layout.kinds(), &observed.mean, &predicted.error);
            }
            pick(&sums.errors()).unwrap_or(0.0)
        };
        let compared: Vec<usize> = both.iter().map(|(condition, ..)| *condition).collect();
        Ok(Self {
            before: error(|(condition, before, _)| (*condition, before)),
            after: error(|(condition, _, after)| (*condition, after)),
            noise_floor: pick(&noise_floor(bench.observed, &compared)).unwrap_or(0.0),
            unit,
            conditions,
            log_density_gain: both.iter().map(|(_, b, a)| a.log_density - b.log_density).sum(),
        })
    }

    /// Whether what is proposed predicts better what it has not seen, errors weighed by their noise.
    #[must_use]
    pub fn confirms(&self) -> bool {
        self.log_density_gain > 0.0
    }

    /// Whether it predicts that worse, by more than chance excuses: means of few runs under few
    /// conditions have errors that hang together, so the density alone refutes some true effects.
    #[must_use]
    pub fn refutes(&self) -> bool {
        self.log_density_gain < -REFUTED && self.after >= self.before
    }
}

/// Those of `conditions` that were predicted both before and after, with both predictions.
fn in_both(
    conditions: &[usize],
    before: Vec<Option<Predicted>>,
    after: Vec<Option<Predicted>>,
) -> Vec<(usize, Predicted, Predicted)> {
    let pairs = conditions.iter().zip(before.into_iter().zip(after));
    pairs.filter_map(|(&condition, (before, after))| Some((condition, before?, after?))).collect()
}

/// A condition predicted by a fit that has not seen it.
struct Predicted {
    /// Measured less predicted, each number in its own unit.
    error: DVector<f64>,
    /// Logarithm of the predictive density, up to a constant of the measurements.
    log_density: f64,
}

impl Predicted {
    /// `conditions` that were held out, by `fitted`, under the noise of `noisy`.
    fn unseen(
        bench: &Bench<'_>,
        noisy: &Fitted,
        fitted: &Fitted,
        conditions: &[usize],
    ) -> Result<Vec<Option<Self>>, BenchError> {
        let weights = bench.weights(&noisy.fit.point, &noisy.noise, conditions)?;
        let data = Data { conditions, ..bench.data(&weights) };
        let residual = data.residual(&fitted.fit.point)?;
        let jacobian = data.jacobian(&fitted.fit)?;
        let parameters = fitted.fit.free_covariance();
        let mut predicted = Vec::with_capacity(conditions.len());
        let mut start = 0;
        for (&condition, weight) in conditions.iter().zip(&weights) {
            let observed = &bench.observed.conditions[condition];
            let rows = observed.mean.len();
            let residual = residual.rows(start, rows).into_owned();
            let jacobian = jacobian.rows(start, rows).into_owned();
            start += rows;
            let log_density = density(&residual, &(&jacobian * &parameters * jacobian.transpose()));
            predicted.push(Some(Self { error: weight.colour(&residual), log_density }));
        }
        Ok(predicted)
    }

    /// Every condition that was fitted to, by one Gauss-Newton step without it from the fit of
    /// `fitted`, under the noise of `noisy`; `None` where one alone fixes a parameter.
    fn left_out(
        bench: &Bench<'_>,
        noisy: &Fitted,
        fitted: &Fitted,
    ) -> Result<Vec<Option<Self>>, BenchError> {
        let fit = bench.data(&noisy.weights).fit(&fitted.fit.point)?;
        let all = fit.jacobian.tr_mul(&fit.jacobian);
        let mut predicted = Vec::with_capacity(noisy.weights.len());
        let mut start = 0;
        for (&condition, weight) in bench.observed.fit.iter().zip(&noisy.weights) {
            let observed = &bench.observed.conditions[condition];
            let rows = observed.mean.len();
            let residual = fit.residual.rows(start, rows).into_owned();
            let jacobian = fit.jacobian.rows(start, rows).into_owned();
            start += rows;
            let Some(others) = Cholesky::new(&all - jacobian.tr_mul(&jacobian)) else {
                predicted.push(None);
                continue;
            };
            let residual = &residual + &jacobian * others.solve(&jacobian.tr_mul(&residual));
            let log_density =
                density(&residual, &(&jacobian * others.solve(&jacobian.transpose())));
            predicted.push(Some(Self { error: weight.colour(&residual), log_density }));
        }
        Ok(predicted)
    }
}

/// Logarithm of the normal density of a whitened `residual`, whose prediction has covariance
/// `predicted` beside the noise, up to a constant.
fn density(residual: &DVector<f64>, predicted: &DMatrix<f64>) -> f64 {
    let covariance = DMatrix::identity(residual.len(), residual.len()) + predicted;
    // One plus a square is always positive definite; if not finite, nothing is known.
    Cholesky::new(covariance).map_or(f64::NEG_INFINITY, |factor| {
        -0.5 * (residual.dot(&factor.solve(residual)) + log_determinant(&factor))
    })
}

/// Standard error of the means of runs, from their scatter; of readings, where there is one run.
pub(crate) fn noise_floor(observed: &Observed, conditions: &[usize]) -> Errors {
    let mut sums = Sums::default();
    for &condition in conditions {
        let observed = &observed.conditions[condition];
        sums.add(&observed.layout.kinds(), &observed.mean, &standard_errors(observed));
    }
    sums.errors()
}

/// Standard error of each number of the mean of the runs of a condition, likewise.
pub(crate) fn standard_errors(observed: &ObservedCondition) -> DVector<f64> {
    let runs = observed.runs.len();
    if runs > 1 {
        let squares = (0..runs).map(|run| observed.deviation(run).map(|d| d * d));
        let total = squares.fold(observed.mean.clone() * 0.0, |sum, square| sum + square);
        return (total / (runs * (runs - 1)) as f64).map(f64::sqrt);
    }
    let stated = observed.stated.iter().zip(observed.mean.iter());
    let stated = stated.map(|(error, value)| error.unwrap_or(0.0) * value);
    let mut error = observed.reading.clone();
    let kinds = observed.layout.kinds();
    for ((error, stated), kind) in error.iter_mut().zip(stated).zip(kinds) {
        // A stated error of a scalar is the whole of it.
        let whole = kind.is_scalar() && stated != 0.0;
        *error = if whole { stated.abs() } else { libm::hypot(*error, stated) };
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_that_only_one_model_predicts_is_left_out_of_both() {
        let predicted = |log_density| Some(Predicted { error: DVector::zeros(1), log_density });
        let before = vec![predicted(-1.0), predicted(-20.0), None];
        let after = vec![predicted(-2.0), None, predicted(-30.0)];
        let both = in_both(&[4, 5, 6], before, after);
        let kept: Vec<_> =
            both.iter().map(|(c, b, a)| (*c, b.log_density, a.log_density)).collect();
        assert_eq!(kept, [(4, -1.0, -2.0)]);
    }
}
