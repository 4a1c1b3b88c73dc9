//! A model with one more effect, refitted with derivatives that are already known.
//!
//! Gauss–Newton steps whose derivatives are those of the model without the effect, corrected after
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

/// A fit with an effect, without its derivatives.
#[derive(Clone, Debug)]
pub(crate) struct Extended {
    /// Parameters and amplitudes, that of the effect last.
    pub(crate) point: Point,
    pub(crate) chi2: f64,
    /// Of the last amplitude; 0 at a bound.
    pub(crate) standard_error: f64,
}

/// Refits `fit` with the effect whose amplitude is the last of `start`, from there; `slope` is the
/// whitened derivative of the prediction by it. `None` if the search does not come to its end.
///
/// # Errors
/// If the model cannot be integrated at `start`.
pub(crate) fn extend(
    data: &Data<'_>,
    fit: &Fit,
    start: &Point,
    slope: &DVector<f64>,
) -> Result<Option<Extended>, PredictError> {
    let scales = data.scales(start);
    let mut search = Search::new(fit, start, slope, &scales);
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
    /// Which of the unknowns are searched; the amplitude last.
    free: Vec<usize>,
    /// Size of an unknown per unit of its column.
    units: Vec<f64>,
    jacobian: DMatrix<f64>,
    least: f64,
    greatest: f64,
}

struct Step {
    /// In the units of the columns.
    change: DVector<f64>,
    promise: f64,
    /// Whether the amplitude stays at its bound.
    held: bool,
}

impl Search {
    fn new(fit: &Fit, start: &Point, slope: &DVector<f64>, scales: &[Scale]) -> Self {
        let amplitude = scales.len() - 1;
        let free: Vec<usize> = fit.free().iter().copied().chain([amplitude]).collect();
        let columns = fit.jacobian.column_iter().map(|column| column.into_owned());
        let mut units = Vec::with_capacity(free.len());
        let columns: Vec<DVector<f64>> = free
            .iter()
            .zip(columns.chain([slope.clone()]))
            .map(|(&at, column)| {
                let column = column * scales[at].slope(value(start, at));
                let length = column.norm().max(f64::MIN_POSITIVE);
                units.push(1.0 / length);
                column / length
            })
            .collect();
        let bound = &scales[amplitude];
        Self {
            unknowns: unknowns(start, scales),
            free,
            units,
            jacobian: DMatrix::from_columns(&columns),
            least: bound.min,
            greatest: bound.max,
        }
    }

    /// The step that lowers χ² most, within the range of the amplitude.
    fn step(&self, residual: &DVector<f64>) -> Option<Step> {
        let all = self.solve(residual, self.free.len())?;
        let amplitude = self.unknowns.last()?;
        let there = amplitude + all[self.free.len() - 1] * self.units.last()?;
        let outward = |bound: f64, beyond: bool| *amplitude == bound && beyond;
        let held = outward(self.least, there < self.least)
            || outward(self.greatest, there > self.greatest);
        let change = match held {
            true => self.solve(residual, self.free.len() - 1)?.push(0.0),
            false => all,
        };
        let promise = (&self.jacobian * &change).norm_squared();
        Some(Step { change, promise, held })
    }

    fn solve(&self, residual: &DVector<f64>, columns: usize) -> Option<DVector<f64>> {
        let jacobian = self.jacobian.columns(0, columns);
        let factor = Cholesky::new(jacobian.tr_mul(&jacobian))?;
        Some(factor.solve(&jacobian.tr_mul(residual)))
    }

    fn moved(&self, change: &DVector<f64>) -> Vec<f64> {
        let mut unknowns = self.unknowns.clone();
        for ((&at, unit), change) in self.free.iter().zip(&self.units).zip(change.iter()) {
            unknowns[at] += unit * change;
        }
        if let Some(amplitude) = unknowns.last_mut() {
            *amplitude = amplitude.clamp(self.least, self.greatest);
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
