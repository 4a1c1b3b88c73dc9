//! Normal equations of factors on the force, condition by condition.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::sensitivity::{Direction, force_response};

/// Depths per condition.
pub(super) const NODES: usize = 6;

/// Fewest numbers of a condition from which all depths are told apart.
const ENOUGH: usize = 2 * NODES;

/// Information below this share of the largest counts as none.
const RIDGE: f64 = 1e-10;

/// Normal equations for the force factors of one condition.
pub(super) struct Normal {
    /// Index of the condition in the set.
    pub(super) condition: usize,
    /// Depth of the last node (m).
    pub(super) reach: f64,
    /// Whether there are enough numbers to tell the depths apart.
    pub(super) resolved: bool,
    /// Whitened change of the observables by a force that is larger by its own size everywhere.
    pub(super) whole: DVector<f64>,
    information: DMatrix<f64>,
    score: DVector<f64>,
}

impl Normal {
    /// Of every condition that `fitted` was fitted to.
    pub(super) fn all(problem: &FitProblem<'_>, fitted: &Fitted) -> Result<Vec<Self>, FitError> {
        let mut normals = Vec::with_capacity(fitted.weights.len());
        let mut start = 0;
        for (&condition, weight) in problem.observed.fit.iter().zip(&fitted.weights) {
            let observed = &problem.observed.conditions[condition];
            let rows = observed.mean.len();
            let path = (NODES, observed.reach);
            let point = &fitted.fit.point;
            let response =
                force_response(point, problem.forward, condition, Direction::Along, path)?;
            let response = weight.whiten_columns(&response);
            let residual = fitted.fit.residual.rows(start, rows);
            start += rows;
            normals.push(Self {
                condition,
                reach: observed.reach,
                resolved: rows >= ENOUGH,
                whole: response.column_sum(),
                information: response.tr_mul(&response),
                score: response.tr_mul(&residual),
            });
        }
        Ok(normals)
    }

    /// Depth of node `index` (m).
    pub(super) fn depth(&self, index: usize) -> f64 {
        self.reach * index as f64 / (NODES - 1) as f64
    }
}

/// Factors with their covariance.
pub(super) struct Solved {
    estimate: DVector<f64>,
    covariance: DMatrix<f64>,
    known: Vec<bool>,
}

impl Solved {
    /// Factor `index` and its standard error; `None` if the data say nothing of it.
    pub(super) fn get(&self, index: usize) -> Option<(f64, f64)> {
        let se = self.covariance[(index, index)].sqrt();
        self.known[index].then_some((self.estimate[index], se))
    }
}

/// Generalised least squares of `unknowns`, of which the force error at a node of a condition is a
/// sum with the coefficients that `coefficient` gives.
pub(super) fn solve(
    normals: &[Normal],
    unknowns: usize,
    coefficient: impl Fn(&Normal, usize, usize) -> f64,
) -> Option<Solved> {
    let mut information = DMatrix::<f64>::zeros(unknowns, unknowns);
    let mut score = DVector::<f64>::zeros(unknowns);
    for normal in normals {
        let basis =
            DMatrix::from_fn(NODES, unknowns, |node, unknown| coefficient(normal, node, unknown));
        information += basis.tr_mul(&(&normal.information * &basis));
        score += basis.tr_mul(&normal.score);
    }
    let ridge = RIDGE * information.diagonal().max();
    let known = information.diagonal().iter().map(|own| *own > ridge).collect();
    let factor = Cholesky::new(information + DMatrix::identity(unknowns, unknowns) * ridge)?;
    let covariance = factor.inverse();
    Some(Solved { estimate: &covariance * score, covariance, known })
}
