//! What a model leaves over, number by number, for plots and tables.

use serde::Serialize;

use crate::fit::problem::{FitError, FitProblem};
use crate::forward::observable::Observable;
use crate::forward::sensitivity::Point;
use crate::noise::Noise;

/// One number of a condition, measured and predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Index of the condition in the set.
    pub condition: usize,
    /// What it is.
    pub observable: Observable,
    /// When (s), for positions and accelerations along the path.
    pub time: Option<f64>,
    /// How deep (m), for forces along the path.
    pub depth: Option<f64>,
    /// Mean over the runs (in the unit of the observable).
    pub measured: f64,
    /// Of the mean run.
    pub predicted: f64,
    /// Standard error of the mean over the runs: two of them are the band of noise.
    pub standard_error: f64,
}

impl Residual {
    /// Where along the path it was read: when (s), or how deep (m); `None` for numbers of the whole impact.
    pub fn place(&self) -> Option<f64> {
        self.time.or(self.depth)
    }
}

/// A held-out condition that a model cannot predict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unpredicted {
    /// Which model: its place among those that were asked.
    #[serde(skip)]
    pub model: usize,
    /// Name of the condition in the set.
    pub condition: String,
    /// Why not.
    pub why: String,
}

/// The held-out conditions that all of several models predict, each at its point, and the others: errors of models are
/// compared over the same conditions.
pub(crate) fn predictable(models: &[(FitProblem<'_>, &Point)]) -> (Vec<usize>, Vec<Unpredicted>) {
    let Some((first, _)) = models.first() else { return (Vec::new(), Vec::new()) };
    let mut unpredicted = Vec::new();
    let mut is_predicted = |&condition: &usize| {
        let before = unpredicted.len();
        for (model, (problem, point)) in models.iter().enumerate() {
            if let Err(error) = point.predict(problem.forward, condition) {
                let condition = problem.observed.conditions[condition].id.clone();
                unpredicted.push(Unpredicted { model, condition, why: error.why });
            }
        }
        unpredicted.len() == before
    };
    let judged: Vec<usize> =
        first.observed.holdout.iter().copied().filter(|one| is_predicted(one)).collect();
    (judged, unpredicted)
}

/// All numbers of the conditions that were fitted to and of those of `holdout`, for the model at `point` under `noise`.
///
/// The differences between two points are what an effect does once the parameters have compensated.
pub fn residuals(
    problem: &FitProblem<'_>,
    point: &Point,
    noise: &Noise,
    holdout: &[usize],
) -> Result<Vec<Residual>, FitError> {
    let mut conditions: Vec<usize> = problem.observed.fit.iter().chain(holdout).copied().collect();
    conditions.sort_unstable();
    let weights = problem.weights(point, noise, &conditions)?;
    let mut all = Vec::new();
    for (&condition, weight) in conditions.iter().zip(&weights) {
        let observed = &problem.observed.conditions[condition];
        let predicted = weight.predict(point, problem.forward, condition)?;
        let errors = weight.standard_errors();
        for (at, (observable, place)) in observed.layout.places().into_iter().enumerate() {
            all.push(Residual {
                condition,
                observable,
                time: place.filter(|_| observable != Observable::Force),
                depth: place.filter(|_| observable == Observable::Force),
                measured: observed.mean[at],
                predicted: predicted[at],
                standard_error: errors[at],
            });
        }
    }
    Ok(all)
}
