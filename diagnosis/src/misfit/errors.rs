//! Errors of a model by kind of number: what a person compares first.

use nalgebra::DVector;
use serde_json::{Map, Value};

use crate::fit::problem::{FitError, FitProblem};
use crate::forward::observable::Observable;
use crate::forward::sensitivity::Point;
use crate::observed::ObservedCondition;
use crate::rounding::rounded;

/// Root mean square of measured less predicted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// By kind, in its own unit; kinds that were not measured are absent.
    pub by_kind: Vec<(Observable, f64)>,
    /// Of the scalars, relative to what was measured (1 = 100 %), if there are any.
    pub relative: Option<f64>,
    /// Of all positions together (m), if there are any.
    pub position: Option<f64>,
}

impl Errors {
    /// Errors of `point` under `conditions` (indices in the set); `None` if there are none.
    pub fn at(
        problem: &FitProblem<'_>,
        point: &Point,
        conditions: &[usize],
    ) -> Result<Option<Self>, FitError> {
        let mut sums = Sums::default();
        for &condition in conditions {
            let observed = &problem.observed.conditions[condition];
            let predicted = point.predict(problem.forward, condition)?;
            if predicted.len() != observed.mean.len() {
                let (found, expected) = (predicted.len(), observed.mean.len());
                return Err(FitError::Layout { id: observed.id.clone(), found, expected });
            }
            sums.add(observed, &(&observed.mean - predicted));
        }
        Ok((!conditions.is_empty()).then(|| sums.errors()))
    }

    /// Of one kind, in its own unit.
    pub fn of(&self, kind: Observable) -> Option<f64> {
        self.by_kind.iter().find(|(other, _)| *other == kind).map(|(_, error)| *error)
    }

    /// As JSON, under the keys of the kinds.
    pub fn to_json(&self) -> Value {
        let mut map: Map<String, Value> = self
            .by_kind
            .iter()
            .map(|(kind, error)| (kind.key().to_owned(), rounded(*error)))
            .collect();
        if let Some(relative) = self.relative {
            map.insert("rms_relative".to_owned(), rounded(relative));
        }
        Value::Object(map)
    }
}

/// Standard deviations of one run by which a number has to differ from zero for an error relative to it.
const FROM_ZERO: f64 = 3.0;

/// A range below this share of the final depth counts as zero. The scatter of two repeats alone does not tell, since it can
/// be zero by chance.
const LEAST_RANGE: f64 = 0.05;

/// Sums of squares by kind.
#[derive(Default)]
pub(crate) struct Sums {
    by_kind: [(f64, usize); Observable::ALL.len()],
    relative: (f64, usize),
}

impl Sums {
    /// Adds the `errors` of the means of `observed`. A number that its scatter does not tell from zero, such as the range of a
    /// vertical impact, has no relative error.
    pub(crate) fn add(&mut self, observed: &ObservedCondition, errors: &DVector<f64>) {
        let kinds = observed.layout.kinds();
        let depth = kinds.iter().position(|kind| *kind == Observable::FinalDepth);
        let least_range = depth.map_or(0.0, |at| LEAST_RANGE * observed.mean[at].abs());
        for (at, (kind, error)) in kinds.into_iter().zip(errors.iter()).enumerate() {
            let slot = &mut self.by_kind[kind as usize];
            *slot = (slot.0 + error * error, slot.1 + 1);
            let value = observed.mean[at];
            let is_none = kind == Observable::FinalRange && value.abs() < least_range;
            if kind.is_scalar() && !is_none && value.abs() > FROM_ZERO * observed.scatter(at) {
                self.relative = (self.relative.0 + (error / value).powi(2), self.relative.1 + 1);
            }
        }
    }

    pub(crate) fn errors(&self) -> Errors {
        let rms = |(sum, n): (f64, usize)| (n > 0).then(|| (sum / n as f64).sqrt());
        let kinds = Observable::ALL.iter().zip(self.by_kind);
        let position = kinds
            .clone()
            .filter(|(kind, _)| kind.is_position())
            .fold((0.0, 0), |sum, (_, part)| (sum.0 + part.0, sum.1 + part.1));
        Errors {
            by_kind: kinds.filter_map(|(kind, sum)| Some((*kind, rms(sum)?))).collect(),
            relative: rms(self.relative),
            position: rms(position),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observed::Observed;
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::Kind;

    #[test]
    fn a_range_that_is_small_beside_the_depth_has_no_relative_error() {
        // Two repeats whose ranges agree by chance, and a prediction of no range.
        let relative = |range: f64| {
            let run = |range| scalar_run(0, [None, Some(0.02), Some(range)]);
            let runs = vec![run(range), run(1.01 * range)];
            let observed = Observed::of(&set(Kind::Scalar, vec![condition(1.0, 90.0)], runs));
            let one = &observed.conditions[0];
            let mut sums = Sums::default();
            sums.add(one, &DVector::from_vec(vec![0.001, one.mean[1]]));
            sums.errors().relative.expect("the depth has one")
        };
        assert!((relative(7e-5) - 0.05).abs() < 1e-9, "that of the depth alone");
        assert!((relative(0.01) - f64::sqrt(0.5 * (0.05 * 0.05 + 1.0))).abs() < 1e-9);
    }
}
