//! A model with more effects, refitted with derivatives that are already known.
//!
//! Gauss–Newton steps whose derivatives are those of the model without them, corrected after
//! every step by what it did (Broyden 1965, Math. Comp. 19, 577): each costs one prediction of the set,
//! where a search that takes its own derivatives costs one per unknown.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::fit::{Data, Fit, Scale, correct, point_of, unknowns, value};
use crate::forward::sensitivity::Point;

/// A step that promises a smaller share of the fall of χ² so far, and of one, ends the search.
const PROMISE: f64 = 1e-3;

/// Steps after which the search ends anyway.
const STEPS: usize = 12;

/// How often a step that does not lower χ² is halved.
const HALVINGS: u32 = 6;

/// A fit with more effects, without its derivatives.
#[derive(Clone, Debug)]
pub(crate) struct Extended {
    /// Parameters and amplitudes, those of the effects last.
    pub(crate) point: Point,
    pub(crate) chi2: f64,
    /// Of the last amplitude; none at a bound.
    pub(crate) standard_error: Option<f64>,
}

/// Refits `fit` with the effects `added`, as (index of the candidate, whitened derivative of the
/// prediction by its amplitude), from where they are absent; no worse than `fit`.
pub(crate) fn extend(data: &Data<'_>, fit: &Fit, added: &[(usize, &DVector<f64>)]) -> Extended {
    let mut start = fit.point.clone();
    start.effects.extend(added.iter().map(|&(candidate, _)| (candidate, 0.0)));
    let slopes: Vec<&DVector<f64>> = added.iter().map(|&(_, slope)| slope).collect();
    descend(data, fit, (start, fit.residual.clone()), &slopes, fit.chi2)
}

/// Refits `fit`, whose effects are among its unknowns, with its derivatives; a fall of χ² is one below `before`.
/// Parameters may leave their ranges.
pub(crate) fn improve(data: &Data<'_>, fit: &Fit, before: f64) -> Extended {
    descend(data, fit, (fit.point.clone(), fit.residual.clone()), &[], before)
}

fn descend(
    data: &Data<'_>,
    fit: &Fit,
    (start, mut residual): (Point, DVector<f64>),
    slopes: &[&DVector<f64>],
    before: f64,
) -> Extended {
    let scales = data.scales(&start);
    let mut search = Search::new(fit, &start, slopes, &scales);
    for _ in 0..STEPS {
        let Some(mut change) = search.step(&residual) else { break };
        let fall = (before - residual.norm_squared()).max(0.0);
        if (&search.jacobian * &change).norm_squared() < PROMISE * (1.0 + fall) {
            break;
        }
        let mut halvings = 0;
        let moved = loop {
            let unknowns = search.moved(&change);
            let there = data.residual(&point_of(&unknowns, &scales, &start));
            let better = there.ok().filter(|there| there.norm_squared() <= residual.norm_squared());
            match better {
                Some(there) => break Some((unknowns, there)),
                None if halvings == HALVINGS => break None,
                None => change *= 0.5,
            }
            halvings += 1;
        };
        let Some((unknowns, there)) = moved else { break };
        search.learn(&unknowns, &(&residual - &there));
        search.unknowns = unknowns;
        residual = there;
    }
    Extended {
        point: point_of(&search.unknowns, &scales, &start),
        chi2: residual.norm_squared(),
        standard_error: search.standard_error(),
    }
}

/// Unknowns in units in which each moves the prediction by one standard deviation.
struct Search {
    unknowns: Vec<f64>,
    /// Which of the unknowns are searched; the amplitudes last.
    free: Vec<usize>,
    /// Least and greatest value of each; infinite for parameters.
    bounds: Vec<(f64, f64)>,
    /// Size of an unknown per unit of its column.
    units: Vec<f64>,
    jacobian: DMatrix<f64>,
}

impl Search {
    fn new(fit: &Fit, start: &Point, slopes: &[&DVector<f64>], scales: &[Scale]) -> Self {
        let first = scales.len() - slopes.len();
        let free: Vec<usize> = fit.free().iter().copied().chain(first..scales.len()).collect();
        let columns = fit.jacobian.column_iter().map(|column| column.into_owned());
        let slopes = slopes.iter().map(|&slope| slope.clone());
        let mut units = Vec::with_capacity(free.len());
        let columns: Vec<DVector<f64>> = free
            .iter()
            .zip(columns.chain(slopes))
            .map(|(&at, column)| {
                let column = column * scales[at].slope(value(start, at));
                let length = column.norm().max(f64::MIN_POSITIVE);
                units.push(1.0 / length);
                column / length
            })
            .collect();
        let range = |&at: &usize| match at < start.parameters.len() {
            true => (f64::NEG_INFINITY, f64::INFINITY),
            false => (scales[at].min, scales[at].max),
        };
        Self {
            unknowns: unknowns(start, scales),
            bounds: free.iter().map(range).collect(),
            free,
            units,
            jacobian: DMatrix::from_columns(&columns),
        }
    }

    /// The step that lowers χ² most, within the ranges of the amplitudes, in the units of the columns.
    fn step(&self, residual: &DVector<f64>) -> Option<DVector<f64>> {
        let mut kept: Vec<usize> = (0..self.free.len()).collect();
        loop {
            let part = self.jacobian.select_columns(&kept);
            let factor = Cholesky::new(part.tr_mul(&part))?;
            let solved = factor.solve(&part.tr_mul(residual));
            let mut change = DVector::zeros(self.free.len());
            for (&column, solved) in kept.iter().zip(solved.iter()) {
                change[column] = *solved;
            }
            let before = kept.len();
            kept.retain(|&column| !self.leaves(column, change[column]));
            if kept.len() == before {
                return Some(change);
            }
        }
    }

    /// Whether `change` would take an amplitude out of its range at once.
    fn leaves(&self, column: usize, change: f64) -> bool {
        let (least, greatest) = self.bounds[column];
        let here = self.unknowns[self.free[column]];
        here <= least && change < 0.0 || here >= greatest && change > 0.0
    }

    fn moved(&self, change: &DVector<f64>) -> Vec<f64> {
        let mut unknowns = self.unknowns.clone();
        for (column, (&at, change)) in self.free.iter().zip(change.iter()).enumerate() {
            let (least, greatest) = self.bounds[column];
            unknowns[at] = (unknowns[at] + self.units[column] * change).clamp(least, greatest);
        }
        unknowns
    }

    /// The derivatives that predict what the way to `there` did.
    fn learn(&mut self, there: &[f64], did: &DVector<f64>) {
        let change = self.free.iter().zip(&self.units);
        let change = change.map(|(&at, unit)| (there[at] - self.unknowns[at]) / unit);
        let change = DVector::from_iterator(self.free.len(), change);
        let missed = did - &self.jacobian * &change;
        correct(&mut self.jacobian, &missed, (&change, &change));
    }

    fn standard_error(&self) -> Option<f64> {
        let last = self.free.len().checked_sub(1)?;
        let (least, greatest) = self.bounds[last];
        let amplitude = self.unknowns[self.free[last]];
        let is_held = self.free[last] + 1 < self.unknowns.len();
        if is_held || amplitude <= least || amplitude >= greatest {
            return None;
        }
        let inverse = Cholesky::new(self.jacobian.tr_mul(&self.jacobian))?.inverse();
        Some(inverse[(last, last)].sqrt() * self.units[last]).filter(|se| se.is_finite())
    }
}
