//! Which term of a force law measurements and model differ by, whatever it is by.

use nalgebra::{Cholesky, DMatrix, DVector};
use serde_json::{Map, Value, json};

use super::emulator::BedForward;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::Prior;
use crate::forward::sensitivity::Point;
use crate::noise::Noise;
use crate::ranking::marginal::between;
use crate::rounding::rounded;

/// A coefficient whose relative change is known to no better than this is not said.
const KNOWN: f64 = 0.5;

/// Relative changes of the coefficients of the force law nearest to the model that bring it to what was measured, with
/// their standard errors.
///
/// They are fitted beside what all runs share, under the scatter of measurements, of the means of the model and of
/// conditions beyond both: where nothing is missing, they are zero within their errors.
pub(super) struct Located {
    keys: Vec<&'static str>,
    change: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl Located {
    /// By `forward` on `problem`, where `fitted` is the model as it is; `None` where the measurements do not tell.
    pub(super) fn of(
        problem: &FitProblem<'_>,
        forward: &BedForward,
        fitted: &Fitted,
    ) -> Result<Option<Self>, FitError> {
        let noise = Noise { between: between(problem, fitted)?, ..fitted.noise };
        let point = Point::start(forward);
        let fit = &problem.observed.fit;
        let weights = problem.weights(&point, &noise, fit)?;
        let keys = forward.baseline().stand_in.scattering().to_vec();
        let priors: Vec<Option<Prior>> =
            forward.shared().parameters().iter().map(|one| one.prior).collect();
        let n = keys.len() + priors.len();
        let (mut inner, mut onto) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (at, prior) in priors.iter().enumerate() {
            let precision = prior.map_or(0.0, |prior| prior.sigma.powi(-2));
            inner[(keys.len() + at, keys.len() + at)] = precision;
        }
        for (&condition, weight) in fit.iter().zip(&weights) {
            let mut columns = forward.by_coefficients(condition)?;
            columns = columns.resize_horizontally(n, 0.0);
            columns
                .columns_mut(keys.len(), priors.len())
                .copy_from(forward.shared().columns(condition));
            let white = weight.whiten_columns(&columns);
            let mean = &problem.observed.conditions[condition].mean;
            let off = weight.whiten(&(mean - weight.predict(&point, forward, condition)?));
            inner += white.tr_mul(&white);
            onto += white.tr_mul(&off);
        }
        let Some(covariance) = Cholesky::new(inner).map(|factor| factor.inverse()) else {
            return Ok(None);
        };
        let change = (&covariance * onto).rows(0, keys.len()).into_owned();
        let covariance = covariance.view((0, 0), (keys.len(), keys.len())).into_owned();
        Ok(Some(Self { keys, change, covariance }))
    }

    /// `of_the_model`, changed.
    pub(super) fn to_json(&self, of_the_model: &Map<String, Value>) -> Value {
        let mut measured = of_the_model.clone();
        let mut changes = Map::new();
        for (at, key) in self.keys.iter().enumerate() {
            let (by, se) = (self.change[at], self.covariance[(at, at)].sqrt());
            let entry = json!({ "value": rounded(by), "se": rounded(se), "unit": "1" });
            changes.insert((*key).to_owned(), entry);
            let Some(entry) = measured.get_mut(&format!("resistance.{key}")) else { continue };
            if se > KNOWN {
                (entry["value"], entry["se"]) = (Value::Null, Value::Null);
            } else if let Some(value) = entry["value"].as_f64() {
                let value = value * libm::exp(by);
                entry["value"] = json!(rounded(value));
                entry["se"] = json!(rounded(value * se));
            }
        }
        json!({ "of_what_was_measured": measured, "relative_change": changes })
    }
}
