//! Predictions of conditions that were not fitted to.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use serde::Serialize;

use crate::fit::Data;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::noise::log_determinant;
use crate::observed::Observed;

/// A condition that was left out and that a model cannot predict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotPredicted {
    /// Its name in the set.
    pub condition: String,
    /// Which model cannot.
    pub by: Fails,
    /// Why not.
    pub why: String,
    /// Whether the other conditions leave the prediction open: that speaks against no model.
    #[serde(skip)]
    pub(crate) is_open: bool,
}

/// Which of two models fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fails {
    /// The model as it is.
    Before,
    /// The model with what is proposed.
    After,
    /// Either.
    Both,
}

/// Share of the information on a combination of parameters that has to be left without a condition.
const ALONE: f64 = 1e-8;

/// A Gauss-Newton step that leaves so many times more of a condition than the fit to all is taken for one too far.
const FAR: f64 = 2.0;

/// Largest standard error of a prediction, in units of the noise. The error of a less certain prediction says nothing.
const OPEN: f64 = 5.0;

/// A condition with both predictions of it.
pub(super) type Pair = (usize, Predicted, Predicted);

/// A condition as a model predicts it, or why it does not.
pub(super) type Attempt = Result<Predicted, Unpredicted>;

/// Why a model does not predict a condition.
pub(super) enum Unpredicted {
    /// It cannot be integrated.
    Fails(String),
    /// The conditions that are left say too little of it.
    Open(&'static str),
}

impl Unpredicted {
    fn is_open(&self) -> bool {
        matches!(self, Self::Open(_))
    }

    fn why(self) -> String {
        match self {
            Self::Fails(why) => why,
            Self::Open(why) => why.to_owned(),
        }
    }
}

/// Those of `conditions` that were predicted both before and after, with both predictions; and the others.
pub(super) fn in_both(
    observed: &Observed,
    conditions: &[usize],
    before: Vec<Attempt>,
    after: Vec<Attempt>,
) -> (Vec<Pair>, Vec<NotPredicted>) {
    let (mut both, mut others) = (Vec::new(), Vec::new());
    for (&condition, pair) in conditions.iter().zip(before.into_iter().zip(after)) {
        let (by, why) = match pair {
            (Ok(before), Ok(after)) => {
                both.push((condition, before, after));
                continue;
            }
            (Err(why), Ok(_)) => (Fails::Before, why),
            (Ok(_), Err(why)) => (Fails::After, why),
            (Err(why), Err(_)) => (Fails::Both, why),
        };
        let condition = observed.conditions[condition].id.clone();
        let is_open = why.is_open();
        others.push(NotPredicted { condition, by, why: why.why(), is_open });
    }
    (both, others)
}

/// A condition predicted by a fit that has not seen it.
pub(super) struct Predicted {
    /// Measured less predicted, each number in its own unit.
    pub(super) error: DVector<f64>,
    /// Logarithm of the predictive density, up to a constant of the measurements.
    pub(super) log_density: f64,
    /// Square of the error in units of what is expected: the noise and the uncertainty of the prediction.
    pub(super) weighed_square: f64,
    /// Mean variance of the prediction due to the uncertainty of the parameters, in units of the variance of the noise.
    pub(super) open: f64,
}

impl Predicted {
    /// With an `error`, the whitened `residual` of it, and a prediction that has the covariance `predicted` beside the noise.
    fn new(error: DVector<f64>, residual: &DVector<f64>, predicted: &DMatrix<f64>) -> Self {
        let expected = DMatrix::identity(residual.len(), residual.len()) + predicted;
        // One plus a square is always positive definite; if not finite, nothing is known.
        let (weighed_square, log_density) =
            Cholesky::new(expected).map_or((f64::INFINITY, f64::NEG_INFINITY), |factor| {
                let square = residual.dot(&factor.solve(residual));
                (square, -0.5 * (square + log_determinant(&factor)))
            });
        Self { error, log_density, weighed_square, open: mean_variance(predicted) }
    }

    /// `conditions` that were held out, by `fitted`, under the noise of `noisy`.
    pub(super) fn unseen(
        problem: &FitProblem<'_>,
        noisy: &Fitted,
        fitted: &Fitted,
        conditions: &[usize],
    ) -> Result<Vec<Attempt>, FitError> {
        let parameters = fitted.fit.free_covariance();
        let one = |condition: usize| -> Result<Self, FitError> {
            let conditions = [condition];
            let weights = problem.weights(&noisy.fit.point, &noisy.noise, &conditions)?;
            let data = Data { conditions: &conditions, ..problem.data(&weights) };
            let rows = data.measured();
            let residual = data.residual(&fitted.fit.point)?.rows(0, rows).into_owned();
            let jacobian = data.jacobian(&fitted.fit)?.rows(0, rows).into_owned();
            let covariance = &jacobian * &parameters * jacobian.transpose();
            let error = weights[0].colour_without_angle(&residual);
            Ok(Self::new(error, &residual, &covariance))
        };
        let attempt = |&condition: &usize| match one(condition) {
            Ok(predicted) => Ok(Ok(predicted)),
            Err(FitError::Predict(error)) => Ok(Err(Unpredicted::Fails(error.why))),
            Err(other) => Err(other),
        };
        conditions.iter().map(attempt).collect()
    }

    /// Every condition that was fitted to, by one Gauss-Newton step without it from the fit of
    /// `fitted`, under the noise of `noisy`, or by a fit where that step goes far. A condition that the others do not determine is not predicted.
    pub(super) fn left_out(
        problem: &FitProblem<'_>,
        noisy: &Fitted,
        fitted: &Fitted,
    ) -> Result<Vec<Attempt>, FitError> {
        let data = problem.data(&noisy.weights);
        let residual = data.residual(&fitted.fit.point)?;
        let jacobian = data.jacobian(&fitted.fit)?;
        let (all, pull) = (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&residual));
        let mut predicted = Vec::with_capacity(noisy.weights.len());
        let mut start = 0;
        for (&condition, weight) in problem.observed.fit.iter().zip(&noisy.weights) {
            let rows = problem.observed.conditions[condition].mean.len();
            let own = residual.rows(start, rows).into_owned();
            let slope = jacobian.rows(start, rows).into_owned();
            start += rows;
            if noisy.weights.len() == 1 {
                predicted.push(Err(Unpredicted::Open("no other condition is fitted to")));
                continue;
            }
            let Some(others) = told_apart(&all - slope.tr_mul(&slope), &all) else {
                predicted.push(Err(Unpredicted::Open("it alone fixes a parameter")));
                continue;
            };
            let covariance = &slope * others.solve(&slope.transpose());
            if mean_variance(&covariance) > OPEN * OPEN {
                predicted.push(Err(Unpredicted::Open("the other conditions say too little of it")));
                continue;
            }
            let step = others.solve(&(&pull - slope.tr_mul(&own)));
            let stepped = &own - &slope * step;
            let residual = match stepped.norm() > FAR * own.norm() {
                true => refitted_without(problem, noisy, fitted, condition).unwrap_or(stepped),
                false => stepped,
            };
            predicted.push(Ok(Self::new(
                weight.colour_without_angle(&residual),
                &residual,
                &covariance,
            )));
        }
        Ok(predicted)
    }
}

/// What is left of `condition`, whitened, by a fit to all others from that of `fitted`.
fn refitted_without(
    problem: &FitProblem<'_>,
    noisy: &Fitted,
    fitted: &Fitted,
    condition: usize,
) -> Option<DVector<f64>> {
    let (mut conditions, mut weights) = (Vec::new(), Vec::new());
    let mut own = None;
    for (&other, weight) in problem.observed.fit.iter().zip(&noisy.weights) {
        if other == condition {
            own = Some(weight);
        } else {
            conditions.push(other);
            weights.push(weight.clone());
        }
    }
    let others =
        Data { conditions: &conditions, weights: &weights, ..problem.data(&noisy.weights) };
    let point = others.fit(&fitted.fit.point).ok()?.point;
    let weight = own?;
    let predicted = weight.predict(&point, problem.forward, condition).ok()?;
    Some(weight.whiten(&(&problem.observed.conditions[condition].mean - predicted)))
}

/// The factor of the information `others` on the parameters, if it fixes every combination that `all` fixes: differences
/// of rounding fix nothing.
fn told_apart(others: DMatrix<f64>, all: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let scale = all.diagonal().map(f64::sqrt);
    let n = others.nrows();
    let share = DMatrix::from_fn(n, n, |i, j| others[(i, j)] / (scale[i] * scale[j]));
    let pivots = Cholesky::new(share)?.l_dirty().diagonal();
    let is_fixed = pivots.iter().all(|pivot| pivot * pivot > ALONE);
    is_fixed.then(|| Cholesky::new(others)).flatten()
}

/// Mean variance of a prediction with this `covariance`.
fn mean_variance(covariance: &DMatrix<f64>) -> f64 {
    covariance.trace() / covariance.nrows().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::Kind;

    #[test]
    fn a_condition_that_only_one_model_predicts_is_left_out_of_both_and_reported() {
        let speeds = [1.0, 1.5, 2.0];
        let runs = (0..3).map(|at| scalar_run(at, [Some(0.1), None, None])).collect();
        let conditions = speeds.map(|speed| condition(speed, 90.0)).into();
        let observed = Observed::of(&set(Kind::Scalar, conditions, runs));
        let predicted = |log_density| {
            let error = DVector::zeros(1);
            Ok(Predicted { error, log_density, weighed_square: 0.0, open: 0.0 })
        };
        let fails = || Err(Unpredicted::Fails("it never stops".to_owned()));
        let before = vec![predicted(-1.0), predicted(-20.0), fails()];
        let after = vec![predicted(-2.0), fails(), fails()];
        let (both, others) = in_both(&observed, &[0, 1, 2], before, after);
        let kept: Vec<_> =
            both.iter().map(|(c, b, a)| (*c, b.log_density, a.log_density)).collect();
        assert_eq!(kept, [(0, -1.0, -2.0)]);
        let left: Vec<_> = others.iter().map(|one| (one.condition.as_str(), one.by)).collect();
        assert_eq!(left, [("1.5 m/s at 90", Fails::After), ("2 m/s at 90", Fails::Both)]);
    }

    #[test]
    fn what_is_left_by_rounding_fixes_no_parameter() {
        // The second column differs from the first in the last row alone.
        let rows = DMatrix::from_row_slice(3, 2, &[3.0, 3.0, 7.0, 7.0, 2.0, 1.0]);
        let all = rows.tr_mul(&rows);
        let without = |row: usize| {
            let slope = rows.rows(row, 1).into_owned();
            &all - slope.tr_mul(&slope)
        };
        assert!(told_apart(without(0), &all).is_some());
        let mut rounded = without(2);
        rounded[(1, 1)] *= 1.0 + 1e-13;
        assert!(told_apart(rounded, &all).is_none());
    }
}
