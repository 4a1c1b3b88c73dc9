//! A model with more effects, refitted with derivatives that are already known.
//!
//! Gauss–Newton steps whose derivatives are those of the model without them, corrected after
//! every step by what it did (Broyden 1965, Math. Comp. 19, 577): each costs one prediction of the set,
//! where a search that takes its own derivatives costs one per unknown.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::fit::{Data, Fit, Scale, point_of, unknowns, value};
use crate::forward::PredictError;
use crate::sensitivity::Point;

/// A step that promises a smaller fall of χ² than this ends the search.
const PROMISE: f64 = 1e-3;

/// Steps after which a search with fresh derivatives is the better choice.
const STEPS: usize = 12;

/// How often a step that does not lower χ² is halved.
const HALVINGS: u32 = 4;

/// A fit with more effects, without its derivatives.
#[derive(Clone, Debug)]
pub(crate) struct Extended {
    /// Parameters and amplitudes, those of the effects last.
    pub(crate) point: Point,
    pub(crate) chi2: f64,
    /// Of the last amplitude; 0 at a bound.
    pub(crate) standard_error: f64,
}

/// Refits `fit` with the effects whose amplitudes are the last of `start`, from there; `slopes` are the
/// whitened derivatives of the prediction by them. `None` if the search does not come to its end.
///
/// # Errors
/// If the model cannot be integrated at `start`.
pub(crate) fn extend(
    data: &Data<'_>,
    fit: &Fit,
    start: &Point,
    slopes: &[&DVector<f64>],
) -> Result<Option<Extended>, PredictError> {
    let scales = data.scales(start);
    let mut search = Search::new(fit, start, slopes, &scales);
    let mut residual = data.residual(start)?;
    for _ in 0..STEPS {
        let Some(mut step) = search.step(&residual) else { return Ok(None) };
        if step.promise < PROMISE {
            let chi2 = residual.norm_squared();
            let point = point_of(&search.unknowns, &scales, start);
            return Ok(Some(Extended {
                point,
                chi2,
                standard_error: search.standard_error(&step),
            }));
        }
        let mut halvings = 0;
        let moved = loop {
            let unknowns = search.moved(&step.change);
            let there = data.residual(&point_of(&unknowns, &scales, start));
            let better = there.ok().filter(|there| there.norm_squared() <= residual.norm_squared());
            match better {
                Some(there) => break Some((unknowns, there)),
                None if halvings == HALVINGS => break None,
                None => step.change *= 0.5,
            }
            halvings += 1;
        };
        let Some((unknowns, there)) = moved else { return Ok(None) };
        search.learn(&unknowns, &(&residual - &there));
        search.unknowns = unknowns;
        residual = there;
    }
    Ok(None)
}

/// Unknowns in units in which each moves the prediction by one standard deviation.
struct Search {
    unknowns: Vec<f64>,
    /// Which of the unknowns are searched; the amplitudes last.
    free: Vec<usize>,
    /// Size of an unknown per unit of its column.
    units: Vec<f64>,
    jacobian: DMatrix<f64>,
    /// Least and greatest amplitudes.
    bounds: Vec<(f64, f64)>,
}

struct Step {
    /// In the units of the columns.
    change: DVector<f64>,
    promise: f64,
    /// Whether the last amplitude stays at its bound.
    held: bool,
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
        Self {
            unknowns: unknowns(start, scales),
            free,
            units,
            jacobian: DMatrix::from_columns(&columns),
            bounds: scales[first..].iter().map(|scale| (scale.min, scale.max)).collect(),
        }
    }

    /// The step that lowers χ² most, within the ranges of the amplitudes.
    fn step(&self, residual: &DVector<f64>) -> Option<Step> {
        let parameters = self.free.len() - self.bounds.len();
        let mut kept: Vec<usize> = (0..self.free.len()).collect();
        loop {
            let part = self.jacobian.select_columns(&kept);
            let factor = Cholesky::new(part.tr_mul(&part))?;
            let solved = factor.solve(&part.tr_mul(residual));
            let mut change = DVector::zeros(self.free.len());
            for (&column, solved) in kept.iter().zip(solved.iter()) {
                change[column] = *solved;
            }
            let outward = |column: usize| {
                let Some((least, greatest)) =
                    column.checked_sub(parameters).map(|k| self.bounds[k])
                else {
                    return false;
                };
                let here = self.unknowns[self.free[column]];
                here == least && change[column] < 0.0 || here == greatest && change[column] > 0.0
            };
            let before = kept.len();
            kept.retain(|&column| !outward(column));
            if kept.len() == before {
                let promise = (&self.jacobian * &change).norm_squared();
                let held = kept.last() != Some(&(self.free.len() - 1));
                return Some(Step { change, promise, held });
            }
        }
    }

    fn moved(&self, change: &DVector<f64>) -> Vec<f64> {
        let mut unknowns = self.unknowns.clone();
        for ((&at, unit), change) in self.free.iter().zip(&self.units).zip(change.iter()) {
            unknowns[at] += unit * change;
        }
        let first = unknowns.len() - self.bounds.len();
        for (amplitude, (least, greatest)) in unknowns[first..].iter_mut().zip(&self.bounds) {
            *amplitude = amplitude.clamp(*least, *greatest);
        }
        unknowns
    }

    /// The derivatives that predict what the way to `there` did.
    fn learn(&mut self, there: &[f64], did: &DVector<f64>) {
        let change = self.free.iter().zip(&self.units);
        let change = change.map(|(&at, unit)| (there[at] - self.unknowns[at]) / unit);
        let change = DVector::from_iterator(self.free.len(), change);
        let length = change.norm_squared();
        if length > 0.0 {
            let missed = did - &self.jacobian * &change;
            self.jacobian += missed * change.transpose() / length;
        }
    }

    fn standard_error(&self, last: &Step) -> f64 {
        if last.held {
            return 0.0;
        }
        let n = self.free.len() - 1;
        let inverse = Cholesky::new(self.jacobian.tr_mul(&self.jacobian)).map(|f| f.inverse());
        inverse.map_or(0.0, |inverse| inverse[(n, n)].sqrt() * self.units[n])
    }
}
