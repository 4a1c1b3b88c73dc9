//! How impacts on one kind of bed differ from run to run, learned from the runs of the model themselves.
//!
//! A force law with coefficients that scatter says too little of the first millimetres, where it matters on
//! which grains an intruder lands, and too much of the last ones. So every number scatters as it does in the
//! runs of its condition, and how numbers hang together is learned from all conditions: their deviations,
//! each in units of its scatter, are taken apart into principal modes; what is left beside the first few
//! scatters number by number.

use nalgebra::{DMatrix, DVector};

use crate::forward::observable::Observable;
use crate::observed::{Observed, ObservedCondition};

/// Modes at most: a handful of runs knows no more.
const MOST: usize = 6;

/// So many independent deviations for every mode.
const PER_MODE: usize = 3;

/// Least scatter that a number is credited with, in units of the depth of its condition: below it are the
/// steps of the integration.
const LEAST: f64 = 1e-3;

/// Least share of the scatter of a number that the others do not tell: correlations that come of some forty
/// deviations are known to a fifth, and what they seem to tell beyond that, they do not.
const OWN_SHARE: f64 = 0.2;

/// The scatter of runs, condition by condition; empty for those that were not run.
pub(super) struct Modes {
    /// One column per mode, of one standard deviation.
    pub(super) columns: Vec<DMatrix<f64>>,
    /// Standard deviations of what is left of every number.
    rest: Vec<DVector<f64>>,
}

impl Modes {
    /// Of the runs of `observed`: modes of all conditions together where they measure the same numbers,
    /// else of each by itself.
    pub(super) fn of(observed: &Observed) -> Self {
        let n = observed.conditions.len();
        let (mut columns, mut rest) = (vec![DMatrix::zeros(0, 0); n], vec![DVector::zeros(0); n]);
        let kinds = |at: usize| observed.conditions[at].layout.kinds();
        let alike = observed.fit.windows(2).all(|pair| kinds(pair[0]) == kinds(pair[1]));
        let groups: Vec<&[usize]> = match alike {
            true => vec![&observed.fit],
            false => observed.fit.chunks(1).collect(),
        };
        for group in groups {
            let each: Vec<Standardised> =
                group.iter().map(|&at| Standardised::of(&observed.conditions[at])).collect();
            let (modes, left) = principal(&each);
            for (&at, one) in group.iter().zip(&each) {
                let mut own = modes.clone();
                own.row_iter_mut().zip(one.unit.iter()).for_each(|(mut row, unit)| row *= *unit);
                columns[at] = own;
                rest[at] = left.component_mul(&one.unit);
            }
        }
        Self { columns, rest }
    }

    /// One column per independent way in which runs under `condition` differ, of one standard deviation: the
    /// modes, then what is left of every number.
    pub(super) fn ways(&self, condition: usize) -> DMatrix<f64> {
        let (columns, rest) = (&self.columns[condition], &self.rest[condition]);
        let modes = columns.ncols();
        let mut all = columns.clone().resize_horizontally(modes + rest.len(), 0.0);
        all.columns_mut(modes, rest.len()).set_diagonal(rest);
        all
    }

    /// Covariance of the numbers of one run under `condition`.
    pub(super) fn covariance(&self, condition: usize) -> DMatrix<f64> {
        let ways = self.ways(condition);
        &ways * ways.transpose()
    }
}

/// Deviations of the runs of one condition, in units of their scatter.
struct Standardised {
    unit: DVector<f64>,
    deviations: Vec<DVector<f64>>,
}

impl Standardised {
    fn of(condition: &ObservedCondition) -> Self {
        let deviations: Vec<DVector<f64>> =
            (0..condition.runs.len()).map(|run| condition.deviation(run)).collect();
        let freedom = (deviations.len() - 1) as f64;
        let kinds = condition.layout.kinds();
        let unit = DVector::from_fn(kinds.len(), |row, _| {
            let squares = deviations.iter().map(|one| one[row].powi(2)).sum::<f64>();
            let whole = match kinds[row] {
                Observable::StopTime => condition.mean[row].abs(),
                _ => condition.reach,
            };
            (squares / freedom).sqrt().max(LEAST * whole)
        });
        let deviations = deviations.into_iter().map(|one| one.component_div(&unit)).collect();
        Self { unit, deviations }
    }
}

/// Principal modes of the deviations of all runs, and the standard deviation of what is left of each number.
fn principal(each: &[Standardised]) -> (DMatrix<f64>, DVector<f64>) {
    let deviations: Vec<DVector<f64>> =
        each.iter().flat_map(|one| one.deviations.iter().cloned()).collect();
    let freedom = deviations.len() - each.len();
    let all = DMatrix::from_columns(&deviations) / (freedom as f64).sqrt();
    let n = all.nrows();
    let whole = DVector::from_fn(n, |row, _| all.row(row).norm_squared());
    let count = (freedom / PER_MODE).clamp(1, MOST).min(n);
    let svd = all.svd(true, false);
    let sizes = &svd.singular_values;
    let columns = svd.u.map_or_else(
        || DMatrix::zeros(n, 0),
        |u| DMatrix::from_fn(n, count.min(u.ncols()), |row, mode| u[(row, mode)] * sizes[mode]),
    );
    let left = DVector::from_fn(n, |row, _| {
        (whole[row] - columns.row(row).norm_squared()).max(0.0).sqrt().max(OWN_SHARE)
    });
    (columns, left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, normal, stream};
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::Kind;

    /// Depth and range go together, the time is for itself, under two conditions of other depths.
    fn observed(runs: usize) -> Observed {
        let mut random = stream(1, Purpose::Resampling, 0);
        let mut all = Vec::new();
        for (at, size) in [1.0, 3.0].into_iter().enumerate() {
            for _ in 0..runs {
                let [a, b] = [(); 2].map(|()| normal(&mut random));
                let time = 0.1 * (1.0 + 0.02 * b);
                let (depth, range) = (size * (0.03 + 0.001 * a), size * (0.02 - 0.002 * a));
                all.push(scalar_run(at, [Some(time), Some(depth), Some(range)]));
            }
        }
        Observed::of(&set(Kind::Scalar, vec![condition(1.0, 45.0), condition(2.0, 45.0)], all))
    }

    #[test]
    fn runs_scatter_as_they_were_seen_to() {
        let runs = 40;
        let observed = observed(runs);
        let modes = Modes::of(&observed);
        for (at, condition) in observed.conditions.iter().enumerate() {
            let covariance = modes.covariance(at);
            for row in 0..3 {
                let squares = (0..runs).map(|run| condition.deviation(run)[row].powi(2));
                let seen = squares.sum::<f64>() / (runs - 1) as f64;
                // Three modes of three numbers leave nothing but the least own share.
                let more = covariance[(row, row)] / seen - 1.0;
                assert!((more - OWN_SHARE * OWN_SHARE).abs() < 5e-3, "{row}: {covariance}");
            }
            let correlation = |a: usize, b: usize| {
                covariance[(a, b)] / (covariance[(a, a)] * covariance[(b, b)]).sqrt()
            };
            assert!(correlation(1, 2) < -1.0 + OWN_SHARE * OWN_SHARE, "{covariance}");
            // Of 80 pairs, a correlation of nothing scatters by 0.11.
            assert!(correlation(0, 1).abs() < 0.3, "{covariance}");
        }
    }

    #[test]
    fn a_number_that_never_differs_is_credited_with_the_steps_of_the_integration() {
        let runs = vec![scalar_run(0, [None, Some(0.03), None]); 3];
        let observed = Observed::of(&set(Kind::Scalar, vec![condition(1.0, 90.0)], runs));
        let own = Modes::of(&observed).covariance(0)[(0, 0)].sqrt();
        assert!((own - OWN_SHARE * LEAST * 0.03).abs() < 1e-12, "{own}");
    }
}
