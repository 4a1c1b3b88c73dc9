//! What the means of runs miss the truth by.

use nalgebra::DVector;

use crate::fit::problem::Fitted;
use crate::misfit::errors::{Errors, Sums};
use crate::observed::{Observed, ObservedCondition};

/// Standard error of the means of runs, from their scatter; of readings, where there is one run.
pub(crate) fn noise_floor(observed: &Observed, conditions: &[usize]) -> Errors {
    let mut sums = Sums::default();
    for &condition in conditions {
        let observed = &observed.conditions[condition];
        sums.add(observed, &standard_errors(observed));
    }
    sums.errors()
}

/// Standard error of the differences between means of measurements and means of impacts, by the weights of `fitted`, over those
/// of `conditions` that it is fitted to.
pub(crate) fn floor_of_both(observed: &Observed, fitted: &Fitted, conditions: &[usize]) -> Errors {
    let mut sums = Sums::default();
    for (condition, weight) in observed.fit.iter().zip(&fitted.weights) {
        if conditions.contains(condition) {
            let of = &observed.conditions[*condition];
            sums.add(of, &weight.standard_errors());
        }
    }
    sums.errors()
}

/// Standard error of each number of the mean of the runs of a condition, from their scatter; of a reading, where there is one
/// run.
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
