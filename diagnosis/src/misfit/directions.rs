//! In which directions a residual is looked at: what changes of the force would do to the observables.

use nalgebra::{DMatrix, DVector};

use crate::fit::problem::FitProblem;
use crate::misfit::covariate::OF_CONDITIONS;
use crate::projection::Basis;

/// What is looked at of each condition, as whitened columns: changes by forces around depths against the motion, likewise
/// normal to it, and the sizes of craters, which no force on the intruder tells.
pub(crate) type Looked = [DMatrix<f64>; 3];

/// Every column instead of modes.
const ALL: usize = usize::MAX;

/// A change of the whole force, or of the size of a crater.
const WHOLE: [usize; 3] = [1, 0, ALL];

/// Modes of a smooth change over depth against the motion, and normal to it.
const MODES: [usize; 3] = [4, 2, ALL];

/// Modes over depth of a change that one condition has for itself.
const OWN_MODES: [usize; 3] = [2, 1, ALL];

/// Directions over all conditions and within each; what the parameters of the model can do is no
/// lack of fit, and is left out of all of them.
pub(crate) struct Directions {
    conditions: Vec<Within>,
    /// How many of the coherent directions are changes of the whole force with what was varied.
    plain: usize,
    /// How many of them are smooth, those included.
    smooth: usize,
}

/// The part of the directions that lies in one condition.
pub(crate) struct Within {
    /// Its first row, and how many.
    rows: (usize, usize),
    /// What the model can do, over all conditions.
    parameters: DMatrix<f64>,
    /// What forces can do that change in all conditions together, smooth ones first.
    coherent: DMatrix<f64>,
    /// What its own forces can do, smooth ones first.
    own: DMatrix<f64>,
    /// How many of those are smooth.
    smooth: usize,
    /// What the parameters do of it.
    shared: DMatrix<f64>,
}

/// What of residuals of one condition, as columns, lies along the directions.
pub(crate) struct Along {
    pub(crate) parameters: DMatrix<f64>,
    pub(crate) coherent: DMatrix<f64>,
    pub(crate) own: DMatrix<f64>,
}

impl Directions {
    /// Beside the columns of `imitated`, which the model can do; `looked` has what is looked at of every condition.
    pub(crate) fn new(
        problem: &FitProblem<'_>,
        imitated: &DMatrix<f64>,
        looked: &[Looked],
    ) -> Self {
        let rows = imitated.nrows();
        let parameters = Basis::of(imitated);
        let mut coherent =
            Basis::beside(&stacked(looked, rows, &varied(problem), WHOLE), &parameters);
        let plain = coherent.len();
        coherent.extend(&stacked(looked, rows, &factors(problem), MODES), &parameters);
        let n_smooth = coherent.len();
        coherent.extend(&stacked(looked, rows, &factors(problem), [ALL; 3]), &parameters);
        let (coherent, parameters) = (coherent.to_matrix(rows), parameters.to_matrix(rows));
        let mut start = 0;
        let conditions = looked.iter().map(|looked| {
            let rows = (start, looked[0].nrows());
            start += rows.1;
            let mut own = Basis::of(&modes(looked, OWN_MODES));
            let smooth = own.len();
            own.extend(&modes(looked, [ALL; 3]), &Basis::none());
            let own = own.to_matrix(rows.1);
            let parameters = parameters.rows(rows.0, rows.1).into_owned();
            let coherent = coherent.rows(rows.0, rows.1).into_owned();
            Within { rows, smooth, shared: own.tr_mul(&parameters), parameters, coherent, own }
        });
        Self { conditions: conditions.collect(), plain, smooth: n_smooth }
    }

    /// One per condition that was fitted to.
    pub(crate) fn conditions(&self) -> &[Within] {
        &self.conditions
    }

    /// A residual of all conditions along the directions.
    pub(crate) fn of(&self, residual: &DVector<f64>) -> Vec<Along> {
        let each = self.conditions.iter();
        each.map(|within| {
            let (start, rows) = within.rows;
            within.of(&DMatrix::from_columns(&[residual.rows(start, rows)]))
        })
        .collect()
    }

    /// Squared lengths of a residual along the directions: of the whole force, coherent smooth, coherent,
    /// smooth in each condition, any in each condition.
    pub(crate) fn sizes(&self, residual: &[Along]) -> Vec<f64> {
        let sum = |part: fn(&Along) -> &DMatrix<f64>| {
            let mut columns = residual.iter().map(|along| part(along).column(0).into_owned());
            let first = columns.next().unwrap_or_else(|| DVector::zeros(0));
            columns.fold(first, |total, one| total + one)
        };
        let parameters = sum(|along| &along.parameters);
        let coherent = sum(|along| &along.coherent);
        let coherent = [self.plain, self.smooth, coherent.len()]
            .map(|columns| coherent.rows(0, columns).norm_squared());
        let (mut smooth, mut any) = (0.0, 0.0);
        for (within, along) in self.conditions.iter().zip(residual) {
            let own = along.own.column(0) - &within.shared * &parameters;
            smooth += own.rows(0, within.smooth).norm_squared();
            any += own.norm_squared();
        }
        coherent.into_iter().chain([smooth, any]).collect()
    }
}

impl Within {
    /// Residuals of the condition, as columns, along the directions.
    pub(crate) fn of(&self, columns: &DMatrix<f64>) -> Along {
        Along {
            parameters: self.parameters.tr_mul(columns),
            coherent: self.coherent.tr_mul(columns),
            own: self.own.tr_mul(columns),
        }
    }
}

/// For every factor, a block of columns: the modes of every condition times its factor.
fn stacked(
    looked: &[Looked],
    rows: usize,
    factors: &[Vec<f64>],
    count: [usize; 3],
) -> DMatrix<f64> {
    let mut columns = Vec::new();
    for factor in factors {
        let blocks: Vec<DMatrix<f64>> = looked.iter().map(|one| modes(one, count)).collect();
        let mut all = DMatrix::zeros(rows, blocks.first().map_or(0, DMatrix::ncols));
        let mut start = 0;
        for (block, factor) in blocks.iter().zip(factor) {
            let mut part = all.view_mut((start, 0), block.shape());
            part.copy_from(&(block * *factor));
            start += block.nrows();
        }
        columns.extend(all.column_iter().map(|column| column.into_owned()));
    }
    match columns.is_empty() {
        true => DMatrix::zeros(rows, 0),
        false => DMatrix::from_columns(&columns),
    }
}

/// Changes of the force over depth as cosines, the smoothest `count` of each block; where all are asked for, the columns
/// themselves.
fn modes(looked: &Looked, count: [usize; 3]) -> DMatrix<f64> {
    let mut columns = Vec::new();
    for (response, count) in looked.iter().zip(count) {
        let nodes = response.ncols();
        if count >= nodes {
            columns.extend(response.column_iter().map(|column| column.into_owned()));
            continue;
        }
        let phase = std::f64::consts::PI / (nodes - 1) as f64;
        columns.extend((0..count).map(|mode| {
            response * DVector::from_fn(nodes, |node, _| libm::cos(phase * (mode * node) as f64))
        }));
    }
    DMatrix::from_columns(&columns)
}

/// By what a coherent change may differ between conditions: not at all, with the speed, with the angle.
fn factors(problem: &FitProblem<'_>) -> Vec<Vec<f64>> {
    let conditions = problem.observed.fit.iter().map(|&index| &problem.set.conditions[index]);
    let one = vec![1.0; problem.observed.fit.len()];
    let speed = standardised(conditions.clone().map(|condition| condition.speed).collect());
    let angle = standardised(conditions.map(|condition| condition.angle_deg).collect());
    vec![one, speed, angle]
}

/// Everything that was varied and the place in the campaign, one value per condition.
fn varied(problem: &FitProblem<'_>) -> Vec<Vec<f64>> {
    let fit = || problem.observed.fit.iter();
    let of_conditions = OF_CONDITIONS.iter().filter_map(|(_, value)| {
        fit().map(|&index| value(&problem.set.conditions[index])).collect::<Option<Vec<f64>>>()
    });
    let order: Option<Vec<f64>> = fit()
        .map(|&index| {
            let orders = problem.observed.conditions[index].order.iter().copied();
            let orders: Vec<i64> = orders.collect::<Option<_>>()?;
            let n = orders.len().max(1) as f64;
            Some(orders.iter().sum::<i64>() as f64 / n)
        })
        .collect();
    of_conditions.chain(order).map(standardised).collect()
}

/// Values less their mean, over their standard deviation; zero if they are all the same.
fn standardised(values: Vec<f64>) -> Vec<f64> {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
    values
        .iter()
        .map(|value| if sd > 1e-9 * mean.abs() { (value - mean) / sd } else { 0.0 })
        .collect()
}
