//! What all runs of a set share, as linear columns beside a bed: errors of the apparatus, and how the bed was prepared.
//!
//! Each has a prior; the baseline and every candidate are fitted with all of them, so that no effect gets credit for what
//! a late clock, a light body or a looser bed explains.

use nalgebra::{DMatrix, DVector};

use measurements::MeasurementSet;

use super::baseline::StandIn;
use crate::forward::apparatus::Apparatus;
use crate::forward::observable::Layout;
use crate::forward::{Parameter, PredictError, Scatter};

/// Shared parameters and how the observables follow them.
#[derive(Clone, Debug, Default)]
pub(super) struct Shared {
    parameters: Vec<Parameter>,
    /// Per condition of the set, one column per parameter.
    columns: Vec<DMatrix<f64>>,
    /// Likewise, the variance of each of their numbers.
    variances: Vec<DMatrix<f64>>,
    /// Per condition: covariance of what is not known of the columns, at the size that is expected of the parameters.
    unknown: Vec<DMatrix<f64>>,
}

/// How the observables of one condition follow one parameter.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) slope: DVector<f64>,
    /// Covariance of the slope, where the condition is fitted to.
    pub(super) covariance: DMatrix<f64>,
    /// Variance of each of its numbers.
    pub(super) variance: DVector<f64>,
}

impl Column {
    /// From the numbers of runs on two `sides` whose parameters lie `between` apart, where runs scatter by `spread` (empty
    /// if that is not known); `None` for too few of them.
    pub(super) fn across(
        sides: &[Vec<DVector<f64>>; 2],
        between: f64,
        spread: &DMatrix<f64>,
    ) -> Option<Self> {
        let mean = |runs: &[DVector<f64>]| {
            let sum = runs.iter().cloned().reduce(|sum, one| sum + one)?;
            Some(sum / runs.len() as f64)
        };
        let [low, high] = sides;
        let means = [mean(low)?, mean(high)?];
        let squares = sides
            .iter()
            .zip(&means)
            .flat_map(|(runs, mean)| runs.iter().map(move |run| (run - mean).map(|off| off * off)));
        let squares = squares.reduce(|sum, one| sum + one)?;
        let [n, m] = [low.len() as f64, high.len() as f64];
        let slope = (&means[1] - &means[0]) / between;
        if n + m < 4.0 || slope.iter().any(|one| !one.is_finite()) {
            return None;
        }
        let share = (1.0 / n + 1.0 / m) / (between * between);
        let covariance = match spread.is_empty() {
            false => share * spread,
            true => DMatrix::zeros(slope.len(), slope.len()),
        };
        Some(Self { slope, covariance, variance: squares * (share / (n + m - 2.0)) })
    }
}

impl Shared {
    /// The errors of the apparatus of `set`, as the force law that stands in for the bed answers to them.
    pub(super) fn of_apparatus(
        set: &MeasurementSet,
        layouts: &[Layout],
        stand_in: &StandIn,
    ) -> Result<Self, PredictError> {
        let apparatus = Apparatus::of(set, stand_in.scattering(), layouts);
        let parameters = apparatus.parameters().to_vec();
        let still =
            Scatter { coefficients: vec![0.0; stand_in.n_scattering()], ..Scatter::default() };
        let mut columns = Vec::with_capacity(layouts.len());
        for (condition, layout) in layouts.iter().enumerate() {
            let mut slopes = DMatrix::zeros(layout.len(), parameters.len());
            for (at, parameter) in parameters.iter().enumerate().filter(|_| !layout.is_empty()) {
                let size = parameter.prior.map_or(0.0, |prior| prior.sigma);
                let values: Vec<f64> =
                    (0..parameters.len()).map(|k| if k == at { size } else { 0.0 }).collect();
                let scatter = apparatus.added_to(&still, condition, &values);
                if !scatter.is_still() && size > 0.0 {
                    let response = stand_in.response(condition, &[], &scatter)?;
                    slopes.set_column(at, &(response / size));
                }
            }
            columns.push(slopes);
        }
        let unknown = layouts.iter().map(|one| DMatrix::zeros(one.len(), one.len())).collect();
        let variances = columns.iter().map(|one| one.map(|_| 0.0)).collect();
        Ok(Self { parameters, columns, variances, unknown })
    }

    /// Adds a parameter that moves the observables of each condition by a column; a condition without a column stays.
    pub(super) fn add(&mut self, parameter: Parameter, columns: Vec<Option<Column>>) {
        let expected =
            parameter.prior.map_or(0.0, |prior| prior.mean.powi(2) + prior.sigma.powi(2));
        let wider = |matrix: &mut DMatrix<f64>| {
            let wide = matrix.ncols() + 1;
            matrix.resize_horizontally_mut(wide, 0.0);
            wide - 1
        };
        for (condition, column) in columns.into_iter().enumerate() {
            let at = wider(&mut self.columns[condition]);
            wider(&mut self.variances[condition]);
            if let Some(Column { slope, covariance, variance }) = column {
                self.columns[condition].set_column(at, &slope);
                self.variances[condition].set_column(at, &variance);
                self.unknown[condition] += expected * covariance;
            }
        }
        self.parameters.push(parameter);
    }

    pub(super) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// What `values` of the parameters change of the observables.
    pub(super) fn change(&self, condition: usize, values: &[f64]) -> DVector<f64> {
        &self.columns[condition] * DVector::from_column_slice(values)
    }

    /// Variance of each number of that, where `values` have this `covariance`.
    pub(super) fn variance(
        &self,
        condition: usize,
        values: &[f64],
        covariance: &DMatrix<f64>,
    ) -> DVector<f64> {
        let columns = &self.columns[condition];
        let of_values = (columns * covariance).component_mul(columns).column_sum();
        let squares = DVector::from_iterator(values.len(), values.iter().map(|one| one * one));
        of_values + &self.variances[condition] * squares
    }

    /// Covariance of what is not known of that.
    pub(super) fn unknown(&self, condition: usize) -> &DMatrix<f64> {
        &self.unknown[condition]
    }

    /// The columns of one condition.
    pub(super) fn columns(&self, condition: usize) -> &DMatrix<f64> {
        &self.columns[condition]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_the_difference_of_two_sides_and_as_uncertain_as_their_runs() {
        let runs = |of: [f64; 3]| of.map(|number| DVector::from_element(1, number)).to_vec();
        let sides = [runs([1.0, 2.0, 3.0]), runs([5.0, 6.0, 7.0])];
        let spread = DMatrix::from_element(1, 1, 4.0);
        let column = Column::across(&sides, 2.0, &spread).expect("six runs are enough");
        // Means of three runs of variance one, 4 apart over 2; the spread of the model is four times as much.
        assert!((column.slope[0] - 2.0).abs() < 1e-14);
        assert!((column.variance[0] - 2.0 / 3.0 / 4.0).abs() < 1e-14, "{column:?}");
        assert!((column.covariance[(0, 0)] - 4.0 * 2.0 / 3.0 / 4.0).abs() < 1e-14, "{column:?}");
        assert!(Column::across(&[runs([1.0; 3]), Vec::new()], 2.0, &spread).is_none());
        assert!(Column::across(&[runs([f64::NAN; 3]), runs([1.0; 3])], 2.0, &spread).is_none());
    }
}
