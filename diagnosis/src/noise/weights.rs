//! What the means of runs are weighted with, and what they are compared to.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::forward::observable::Observable;
use crate::forward::sensitivity::{Point, Sensitivity};
use crate::forward::{Forward, PredictError};
use crate::noise::{Noise, log_determinant};
use crate::observed::ObservedCondition;

/// The weight of one condition, and the shift between its mean run and the run of the mean bed.
#[derive(Clone, Debug)]
pub struct Weight {
    /// Cholesky factor of the covariance of the mean.
    factor: Cholesky<f64, Dyn>,
    /// What is added to the run of the mean bed (in the units of the observables).
    pub shift: DVector<f64>,
    /// What conditions scatter by beyond their runs, a column for each coefficient; the factor holds it.
    between: Option<DMatrix<f64>>,
    /// Likewise of its angle.
    angle: Option<DVector<f64>>,
}

/// The covariance `own` of the predictions of `observed`, plus the variance of a stopping time with the `error` (s).
pub(crate) fn with_stop_error(
    own: Option<DMatrix<f64>>,
    observed: &ObservedCondition,
    error: Option<f64>,
) -> Option<DMatrix<f64>> {
    let stop = observed.layout.kinds().iter().position(|kind| *kind == Observable::StopTime);
    let Some((stop, error)) = stop.zip(error) else { return own };
    let n = observed.mean.len();
    let mut all = own.unwrap_or_else(|| DMatrix::zeros(n, n));
    all[(stop, stop)] += error * error;
    Some(all)
}

impl Weight {
    /// For the mean over the runs of `condition` under `noise`, held against a prediction whose covariance
    /// is `own`; `None` if the covariance of both is singular.
    pub fn new(
        condition: &ObservedCondition,
        sensitivity: &Sensitivity,
        noise: &Noise,
        own: Option<DMatrix<f64>>,
    ) -> Option<Self> {
        let runs = condition.runs.len().max(1) as f64;
        let mut covariance = noise.covariance(condition, sensitivity) / runs;
        if let Some(own) = own {
            covariance += own;
        }
        let between = noise.between_conditions(sensitivity);
        if let Some(columns) = &between {
            covariance += columns * columns.transpose();
        }
        let factor = Cholesky::new(covariance)?;
        let shift = sensitivity.shift_of_mean(&noise.spread);
        let angle = noise.angle_of_condition(sensitivity);
        Some(Self { factor, shift, between, angle })
    }

    /// What the mean scatters by together with all its runs, as `Noise::between_conditions` has it.
    pub fn between(&self) -> Option<&DMatrix<f64>> {
        self.between.as_ref()
    }

    /// `vector` in units of its standard deviation, freed of correlation.
    pub(crate) fn whiten(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut white = vector.clone();
        // The diagonal of a Cholesky factor is positive, so there is a solution.
        self.factor.l_dirty().solve_lower_triangular_mut(&mut white);
        white
    }

    /// Every column of `matrix` likewise.
    pub(crate) fn whiten_columns(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let mut white = matrix.clone();
        self.factor.l_dirty().solve_lower_triangular_mut(&mut white);
        white
    }

    /// The vector that `whiten` makes `white` of.
    pub fn colour(&self, white: &DVector<f64>) -> DVector<f64> {
        self.factor.l() * white
    }

    /// The same less what the condition's own angle is off by, as likely as `white` and the scatter of angles make it: the
    /// conditional mean of normal errors. No model predicts how well a launcher was set.
    pub(crate) fn colour_without_angle(&self, white: &DVector<f64>) -> DVector<f64> {
        match &self.angle {
            Some(angle) => self.colour(white) - angle * self.whiten(angle).dot(white),
            None => self.colour(white),
        }
    }

    /// Standard error of each number of the mean.
    pub(crate) fn standard_errors(&self) -> DVector<f64> {
        let factor = self.factor.l();
        DVector::from_iterator(factor.nrows(), factor.row_iter().map(|row| row.norm()))
    }

    /// Logarithm of the determinant of the covariance of the mean.
    pub(crate) fn log_determinant(&self) -> f64 {
        log_determinant(&self.factor)
    }

    /// What the mean of runs is expected to be at `point`.
    pub fn predict(
        &self,
        point: &Point,
        forward: &dyn Forward,
        condition: usize,
    ) -> Result<DVector<f64>, PredictError> {
        Ok(point.predict(forward, condition)? + &self.shift)
    }
}
