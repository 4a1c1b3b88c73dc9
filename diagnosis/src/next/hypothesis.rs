//! One of the models that an experiment should tell apart.

use nalgebra::{DMatrix, DVector, RowDVector, SymmetricEigen};

use crate::fit::problem::FitProblem;
use crate::fit::value_mut;
use crate::forward::sensitivity::Point;
use crate::forward::{Form, Forward, PredictError, SEPARATE};
use crate::noise::weights::Weight;

/// Share of its standard error by which an unknown is moved for a derivative.
const STEP: f64 = 0.1;

/// The name of the model without an effect.
const AS_IT_IS: &str = "no effect";

/// The model with one effect or as it is, fitted, in the terms of the model that it was fitted with.
pub(super) struct Hypothesis {
    /// The effect and its form; none for the model as it is.
    effect: Option<(String, Form)>,
    /// By how much its χ² exceeds that of the best.
    behind: f64,
    /// Parameters with their names and values.
    parameters: Vec<(String, f64)>,
    amplitude: Option<f64>,
    /// Its product with its transpose is the covariance of the parameters, then of an amplitude.
    root: DMatrix<f64>,
}

/// A hypothesis in the terms of a model before other conditions.
pub(super) struct Placed {
    pub(super) point: Point,
    /// By what each unknown of the model may be off, in the terms of the fit.
    shared: Vec<RowDVector<f64>>,
    /// Standard deviation of what nothing in the set depended on; zero for the rest.
    own: Vec<f64>,
    unknowns: usize,
}

/// What one hypothesis expects of one condition, in units of the noise of its mean, freed of correlation.
#[derive(Clone, Debug)]
pub(super) struct Expectation {
    /// The mean.
    pub(super) mean: DVector<f64>,
    /// What the fit leaves open, a column for each unknown of the fit.
    pub(super) shared: DMatrix<f64>,
    /// The same for unknowns that the fit has not.
    pub(super) own: DMatrix<f64>,
}

impl Hypothesis {
    /// The model with at most one effect, refitted from `point` under `weights`; its χ² was `behind` that of the best.
    pub(super) fn fitted(
        problem: &FitProblem<'_>,
        weights: &[Weight],
        (point, behind): (&Point, f64),
    ) -> Result<Self, PredictError> {
        let fit = problem.data(weights).fit_as_listed_within_forms(point)?;
        let added = fit.point.effects.last();
        let name = |&(index, _): &(usize, f64)| {
            let candidate = &problem.forward.candidates()[index];
            (candidate.id.clone(), candidate.form.clone())
        };
        let names = problem.forward.parameters().iter().map(|parameter| parameter.name.clone());
        Ok(Self {
            effect: added.map(name),
            behind,
            parameters: names.zip(fit.point.parameters.iter().copied()).collect(),
            amplitude: added.map(|(_, q)| *q),
            root: root(&fit.covariance),
        })
    }

    /// The id of the effect, or that there is none.
    pub(super) fn name(&self) -> &str {
        self.effect.as_ref().map_or(AS_IT_IS, |(id, _)| id)
    }

    /// Whether it explains about as much as the best.
    pub(super) fn explains(&self) -> bool {
        self.behind < SEPARATE
    }

    /// Its likelihood over that of the best.
    pub(super) fn likelihood(&self) -> f64 {
        libm::exp(-0.5 * self.behind)
    }

    /// The same before `forward`, a model that may have other free parameters: what nothing in the set
    /// depended on is known no better than to its own size. `None` if it has no such effect.
    pub(super) fn before(&self, forward: &dyn Forward) -> Option<Placed> {
        let mut candidates = forward.candidates().iter();
        let effects = match (&self.effect, self.amplitude) {
            (Some((id, form)), Some(amplitude)) => {
                let index = candidates.position(|one| one.id == *id && one.form == *form)?;
                vec![(index, amplitude)]
            }
            _ => Vec::new(),
        };
        let unknowns = self.root.nrows();
        let (mut parameters, mut shared, mut own) = (Vec::new(), Vec::new(), Vec::new());
        for parameter in forward.parameters() {
            match self.parameters.iter().position(|(name, _)| *name == parameter.name) {
                Some(at) => {
                    parameters.push(self.parameters[at].1);
                    shared.push(self.root.row(at).into_owned());
                    own.push(0.0);
                }
                None => {
                    let usual = if parameter.start == 0.0 { 1.0 } else { parameter.start.abs() };
                    parameters.push(parameter.start);
                    shared.push(RowDVector::zeros(unknowns));
                    own.push(parameter.prior.map_or(usual, |prior| prior.sigma));
                }
            }
        }
        if !effects.is_empty() {
            shared.push(self.root.row(unknowns - 1).into_owned());
            own.push(0.0);
        }
        let point = Point { parameters, effects };
        Some(Placed { point, shared, own, unknowns })
    }
}

impl Placed {
    /// What it expects of condition `condition` under `weight`.
    pub(super) fn expects(
        &self,
        forward: &dyn Forward,
        condition: usize,
        weight: &Weight,
    ) -> Result<Expectation, PredictError> {
        let mean = weight.whiten(&weight.predict(&self.point, forward, condition)?);
        let mut shared = DMatrix::zeros(mean.len(), self.unknowns);
        let mut own = Vec::new();
        for (at, (row, &alone)) in self.shared.iter().zip(&self.own).enumerate() {
            let error = libm::hypot(row.norm(), alone);
            if error == 0.0 {
                continue;
            }
            let step = self.step(at, error);
            let moved = |by: f64| {
                let mut point = self.point.clone();
                *value_mut(&mut point, at) += by;
                point.predict(forward, condition)
            };
            let slope = weight.whiten(&((moved(step)? - moved(-step)?) / (2.0 * step)));
            if alone > 0.0 {
                own.push(slope * alone);
            } else {
                shared += slope * row;
            }
        }
        let own = match own.is_empty() {
            true => DMatrix::zeros(mean.len(), 0),
            false => DMatrix::from_columns(&own),
        };
        Ok(Expectation { mean, shared, own })
    }

    /// A share of the standard error, and never more than that of the value itself, which may be
    /// unable to change its sign.
    fn step(&self, at: usize, error: f64) -> f64 {
        let mut point = self.point.clone();
        let size = value_mut(&mut point, at).abs();
        STEP * if size > 0.0 { error.min(size) } else { error }
    }
}

/// A matrix whose product with its transpose is `covariance`, whose rows of zeros stay zero.
fn root(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    // Units differ by many decades: the eigenvalues are those of the correlations.
    let sigma: DVector<f64> = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
    let known = |at: usize| if sigma[at] > 0.0 { 1.0 / sigma[at] } else { 0.0 };
    let n = sigma.len();
    let correlation = DMatrix::from_fn(n, n, |i, j| covariance[(i, j)] * known(i) * known(j));
    let eigen = SymmetricEigen::new(correlation);
    let lengths = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    DMatrix::from_diagonal(&sigma) * eigen.eigenvectors * DMatrix::from_diagonal(&lengths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_of_a_covariance_gives_it_back_whatever_the_units() {
        let covariance =
            DMatrix::from_row_slice(3, 3, &[4e12, 1e-1, 0.0, 1e-1, 9e-14, 0.0, 0.0, 0.0, 0.0]);
        let root = root(&covariance);
        let back = &root * root.transpose();
        for (found, meant) in back.iter().zip(&covariance) {
            assert!((found - meant).abs() <= 1e-9 * meant.abs(), "{found} {meant}");
        }
    }
}
