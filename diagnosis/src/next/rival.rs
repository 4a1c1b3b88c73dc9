//! One of the models that an experiment should separate.

use nalgebra::{DMatrix, DVector};

use crate::bench::Bench;
use crate::fit::value_mut;
use crate::forward::{Forward, PredictError, SEPARATE};
use crate::sensitivity::Point;
use crate::weights::Weight;

/// Share of its standard error by which an unknown is moved for a derivative.
const STEP: f64 = 0.1;

/// The model with one effect, fitted, in the terms of the model that it was fitted with.
pub(super) struct Rival {
    /// Of the effect.
    pub(super) id: String,
    /// Whether it explains about as much as the best.
    pub(super) explains: bool,
    /// Parameters with their names and values.
    parameters: Vec<(String, f64)>,
    amplitude: f64,
    /// Of the parameters, then of the amplitude.
    covariance: DMatrix<f64>,
}

/// A rival in the terms of a model before other conditions.
pub(super) struct Placed {
    pub(super) point: Point,
    covariance: DMatrix<f64>,
}

impl Rival {
    /// The model with the effect `id`, refitted from `point` under `weights`; its χ² was `behind` that
    /// of the best.
    pub(super) fn fitted(
        bench: &Bench<'_>,
        weights: &[Weight],
        (id, behind): (String, f64),
        point: &Point,
    ) -> Result<Self, PredictError> {
        let fit = bench.data(weights).fit(point)?;
        let names = bench.forward.parameters().iter().map(|parameter| parameter.name.clone());
        Ok(Self {
            id,
            explains: behind < SEPARATE,
            parameters: names.zip(fit.point.parameters.iter().copied()).collect(),
            amplitude: fit.point.effects.last().map_or(0.0, |(_, q)| *q),
            covariance: fit.covariance,
        })
    }

    /// The same before `forward`, a model that may have other free parameters: what nothing in the set
    /// depended on is known no better than to its own size. `None` if it has no such effect.
    pub(super) fn before(&self, forward: &dyn Forward) -> Option<Placed> {
        let candidate = forward.candidates().iter().position(|one| one.id == self.id)?;
        let known = |name: &str| self.parameters.iter().position(|(other, _)| other == name);
        let mut from: Vec<Option<usize>> =
            forward.parameters().iter().map(|parameter| known(&parameter.name)).collect();
        let parameters: Vec<f64> = forward
            .parameters()
            .iter()
            .zip(&from)
            .map(|(parameter, at)| at.map_or(parameter.start, |at| self.parameters[at].1))
            .collect();
        from.push(Some(self.parameters.len()));
        let variance = |at: usize| match forward.parameters()[at].start {
            0.0 => 1.0,
            start => start * start,
        };
        let covariance =
            DMatrix::from_fn(from.len(), from.len(), |i, j| match (from[i], from[j]) {
                (Some(i), Some(j)) => self.covariance[(i, j)],
                (None, None) if i == j => variance(i),
                _ => 0.0,
            });
        let point = Point { parameters, effects: vec![(candidate, self.amplitude)] };
        Some(Placed { point, covariance })
    }
}

impl Placed {
    /// A matrix whose product with its transpose is the covariance of the prediction of condition
    /// `condition`; `whiten` is applied to the derivatives.
    pub(super) fn spread(
        &self,
        forward: &dyn Forward,
        condition: usize,
        whiten: impl Fn(&DVector<f64>) -> DVector<f64>,
    ) -> Result<DMatrix<f64>, PredictError> {
        let n = self.covariance.nrows();
        let free: Vec<usize> = (0..n).filter(|&at| self.covariance[(at, at)] > 0.0).collect();
        let mut columns = Vec::with_capacity(free.len());
        for &at in &free {
            let step = self.step(at);
            let moved = |by: f64| {
                let mut point = self.point.clone();
                *value_mut(&mut point, at) += by;
                point.predict(forward, condition)
            };
            columns.push(whiten(&((moved(step)? - moved(-step)?) / (2.0 * step))));
        }
        if columns.is_empty() {
            return Ok(DMatrix::zeros(0, 0));
        }
        let jacobian = DMatrix::from_columns(&columns);
        let covariance = self.covariance.select_rows(&free).select_columns(&free);
        Ok(&jacobian * covariance * jacobian.transpose())
    }

    /// A share of the standard error, and never more than that of the value itself, which may be
    /// unable to change its sign.
    fn step(&self, at: usize) -> f64 {
        let mut point = self.point.clone();
        let size = value_mut(&mut point, at).abs();
        let error = self.covariance[(at, at)].sqrt();
        STEP * if size > 0.0 { error.min(size) } else { error }
    }
}
