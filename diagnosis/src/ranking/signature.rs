//! What an effect would do to the observables once the parameters of the model have compensated.

use nalgebra::{DMatrix, DVector};

use crate::fit::problem::{FitProblem, Fitted};
use crate::forward::sensitivity::Point;
use crate::forward::{Candidate, PredictError};
use crate::projection::Basis;

/// Least share of an effect that the parameters of the model must leave over; less is rounding.
const LEFT_OVER: f64 = 1e-3;

/// Amplitudes are detected at this many standard errors.
const DETECTION: f64 = 4.0;

/// The signature of one effect, whitened and beside the parameters.
#[derive(Clone, Debug)]
pub(crate) struct Signature {
    /// Index of the candidate.
    pub(crate) candidate: usize,
    /// Direction.
    pub(crate) unit: DVector<f64>,
    /// Length per unit amplitude.
    pub(crate) norm: f64,
    /// Score: the residual along the direction, in standard errors.
    pub(crate) score: f64,
    /// Whitened derivative of the prediction by the amplitude, parameters as they are.
    pub(crate) slope: DVector<f64>,
}

impl Signature {
    /// The smallest amplitude that would be seen.
    pub(crate) fn detection_limit(&self) -> f64 {
        DETECTION / self.norm
    }
}

/// The signature of `candidate` around `fitted`; `None` if the model can imitate it entirely.
pub(crate) fn signature(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    candidate: usize,
) -> Result<Option<Signature>, PredictError> {
    let raw = derivative(problem, fitted, candidate)?;
    let parameters = Basis::of(&fitted.fit.jacobian);
    let rest = parameters.rest(&raw);
    let norm = rest.norm();
    if !norm.is_finite() || norm <= LEFT_OVER * raw.norm() {
        return Ok(None);
    }
    let unit = rest / norm;
    let score = unit.dot(&fitted.fit.residual);
    Ok(Some(Signature { candidate, unit, norm, score, slope: raw }))
}

/// Whitened derivative of the observables by the amplitude of `candidate` at zero; to one side, of
/// second order, where the amplitude has one sign.
fn derivative(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    candidate: usize,
) -> Result<DVector<f64>, PredictError> {
    let &Candidate { min, max, step, .. } = &problem.forward.candidates()[candidate];
    let data = problem.data(&fitted.weights);
    let residual = |q: f64| {
        let mut point: Point = fitted.fit.point.clone();
        point.effects.push((candidate, q));
        data.residual(&point)
    };
    if min <= -step && step <= max {
        return Ok((residual(-step)? - residual(step)?) / (2.0 * step));
    }
    let step = if max >= 2.0 * step { step } else { -step };
    let (once, twice) = (residual(step)?, residual(2.0 * step)?);
    Ok((3.0 * &fitted.fit.residual - 4.0 * once + twice) / (2.0 * step))
}

/// Cosines between signatures.
pub(crate) fn collinearity(signatures: &[&Signature]) -> DMatrix<f64> {
    let n = signatures.len();
    DMatrix::from_fn(
        n,
        n,
        |i, j| {
            if i == j { 1.0 } else { signatures[i].unit.dot(&signatures[j].unit) }
        },
    )
}

/// Variance of the residual along `unit` as the repeats themselves show it, whatever the noise model
/// says, and with the error of the prediction itself; a condition without repeats counts as the noise
/// model has it.
pub(crate) fn variance_along(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    unit: &DVector<f64>,
) -> f64 {
    let mut start = 0;
    let mut variance = 0.0;
    for (&condition, weight) in problem.observed.fit.iter().zip(&fitted.weights) {
        let observed = &problem.observed.conditions[condition];
        let part = unit.rows(start, observed.mean.len());
        start += observed.mean.len();
        let runs = observed.runs.len() as f64;
        variance += if observed.runs.len() > 1 {
            let along = |run| part.dot(&weight.whiten(&observed.deviation(run))).powi(2);
            let effects = &fitted.fit.point.effects;
            let own = problem.own_covariance(condition, effects, &fitted.noise);
            let own = own.map_or(0.0, |own| {
                let half = weight.whiten_columns(&own).transpose();
                part.dot(&weight.whiten_columns(&half).tr_mul(&part))
            });
            let between = weight
                .between()
                .map_or(0.0, |columns| weight.whiten_columns(columns).tr_mul(&part).norm_squared());
            own + between + (0..observed.runs.len()).map(along).sum::<f64>() / (runs * (runs - 1.0))
        } else {
            part.norm_squared()
        };
    }
    // What remains are priors, of one standard deviation each.
    variance + unit.rows(start, unit.len() - start).norm_squared()
}
