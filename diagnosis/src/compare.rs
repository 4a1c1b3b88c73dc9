//! One or more revisions of a model against a measurement set: how wrong, and where.

use measurements::MeasurementSet;
use serde::Serialize;
use serde_json::{Map, Value};
use thiserror::Error;

use crate::fit::fitted_parameters::parameters;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::Forward;
use crate::forward::sensitivity::Point;
use crate::misfit::errors::Errors;
use crate::misfit::force_error::ForceError;
use crate::misfit::lack_of_fit::lack_of_fit;
use crate::misfit::residual::{Unpredicted, predictable};
use crate::noise::{Noise, NoiseSource};
use crate::observed::Observed;
use crate::rounding::{six_digits, six_digits_or_null};
use crate::verdict::ApparatusError;
use crate::where_it_fails::{Failing, WhereItFails};

/// A model under the name that a report gives it.
#[derive(Clone, Copy)]
pub struct Revision<'a> {
    /// Name or path.
    pub name: &'a str,
    /// The model.
    pub forward: &'a dyn Forward,
}

impl<'a> Revision<'a> {
    fn problem(&self, set: &'a MeasurementSet, observed: &'a Observed) -> FitProblem<'a> {
        FitProblem { set, observed, forward: self.forward }
    }
}

/// Every model of a comparison, in the order asked for.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the set.
    pub set: String,
    /// One per revision, so that the fall of the error is a column.
    pub models: Vec<ModelComparison>,
    /// Noise under the model that fits best.
    pub noise: Value,
    /// Held-out conditions that all models predict: errors held out are over these.
    pub conditions_judged: usize,
    /// The others, with the models that cannot.
    pub not_predicted: Vec<Unpredicted>,
    /// What was left aside or assumed, in sentences.
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl Comparison {
    /// How every revision fails, where this is of `set` and its `observed`.
    pub fn where_it_fails<'a>(
        &self,
        set: &'a MeasurementSet,
        observed: &'a Observed,
    ) -> WhereItFails<'a> {
        let models = self.models.iter().map(|model| model.failing.clone()).collect();
        WhereItFails { set, observed, models, signatures: Vec::new() }
    }
}

/// One model against the set.
#[derive(Clone, Debug, Serialize)]
pub struct ModelComparison {
    /// Name or path.
    pub model: String,
    /// Refitted: value, standard error and unit of each.
    pub parameters: Map<String, Value>,
    /// Weighted sum of squares per number that was fitted to; about 1 for a model that is right.
    #[serde(serialize_with = "six_digits")]
    pub chi2_per_n: f64,
    /// Probability of a lack of fit as large, if the model were right; none where no error is
    /// known, or as much is free as was measured.
    #[serde(serialize_with = "six_digits_or_null")]
    pub p_lof: Option<f64>,
    /// Root mean square errors by kind of number.
    pub rms: Rms,
    /// Errors of the apparatus that the set states, as this model has them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub apparatus: Vec<ApparatusError>,
    /// Where the force is wrong.
    pub fails: Vec<ForceError>,
    /// All that is known of where it fails.
    #[serde(skip)]
    pub failing: Failing,
    /// The fit behind it.
    #[serde(skip)]
    pub fitted: Fitted,
}

/// Root mean square errors.
#[derive(Clone, Debug, Serialize)]
pub struct Rms {
    /// Where the model was fitted to.
    pub fit: Value,
    /// Where it was not; null if the set holds out nothing.
    pub holdout: Value,
}

/// A model that cannot be compared.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{model}: {error}")]
pub struct CompareError {
    /// Name of the model.
    pub model: String,
    /// Why not.
    #[source]
    pub error: FitError,
}

/// Compares every one of `revisions` with `set`, whose observables are `observed`.
///
/// Without repeats and stated errors every number counts as known to 5 %, and no test is made.
///
/// # Errors
/// If there is too little to fit to, or a model fails.
pub fn compare(
    set: &MeasurementSet,
    observed: &Observed,
    revisions: &[Revision<'_>],
    seed: u64,
) -> Result<Comparison, CompareError> {
    let of = |revision: &Revision<'_>| {
        let model = revision.name.to_owned();
        move |error| CompareError { model, error }
    };
    let mut all_fitted = Vec::with_capacity(revisions.len());
    for revision in revisions {
        all_fitted.push(fitted(&revision.problem(set, observed), seed).map_err(of(revision))?);
    }
    let asked: Vec<_> = revisions
        .iter()
        .zip(&all_fitted)
        .map(|(revision, (fitted, _))| (revision.problem(set, observed), &fitted.fit.point))
        .collect();
    let (holdout, not_predicted) = predictable(&asked);
    let mut models = Vec::with_capacity(revisions.len());
    for (revision, fitted) in revisions.iter().zip(all_fitted) {
        let model =
            compare_one(&revision.problem(set, observed), revision.name, (fitted, &holdout), seed);
        models.push(model.map_err(of(revision))?);
    }
    let best =
        models.iter().zip(revisions).min_by(|(a, _), (b, _)| a.chi2_per_n.total_cmp(&b.chi2_per_n));
    let noise = best
        .map_or(Value::Null, |(best, revision)| best.fitted.noise.to_json(set, revision.forward));
    let unpredicted = not_predicted.iter().map(|one| {
        let Unpredicted { model, condition, why } = one;
        let name = revisions[*model].name;
        format!("{name} cannot predict the held-out condition `{condition}`, which no error counts: {why}")
    });
    let mut notes: Vec<String> = set.notes.iter().chain(&observed.notes).cloned().collect();
    notes.extend(unpredicted);
    if observed.holdout.is_empty() {
        notes.push("the set holds out no condition: nothing here was predicted unseen".to_owned());
    }
    if models.iter().any(|model| model.fitted.noise.source == NoiseSource::Assumed) {
        notes.push("neither repeats nor stated errors: 5 % of every number is assumed".to_owned());
    }
    let conditions_judged = holdout.len();
    Ok(Comparison { set: set.id.clone(), models, noise, conditions_judged, not_predicted, notes })
}

/// The model of `problem`, fitted, with its probability of a lack of fit.
fn fitted(problem: &FitProblem<'_>, seed: u64) -> Result<(Fitted, Option<f64>), FitError> {
    let start = Point::start(problem.forward);
    let fitted = match problem.fit(&start) {
        Err(FitError::NoErrors) => problem.fit_from(&start, &Noise::assumed()),
        other => other,
    }?;
    let p_lof = match fitted.noise.source {
        NoiseSource::Assumed => None,
        NoiseSource::Repeats | NoiseSource::Stated | NoiseSource::AssumedScatter => {
            lack_of_fit(problem, &fitted, seed)?
        }
    };
    Ok((fitted, p_lof))
}

fn compare_one(
    problem: &FitProblem<'_>,
    name: &str,
    ((fitted, p_lof), holdout): ((Fitted, Option<f64>), &[usize]),
    seed: u64,
) -> Result<ModelComparison, FitError> {
    let failing = Failing::of(problem, (name, &fitted), holdout, seed)?;
    let measured = fitted.fit.residual.rows(0, problem.data(&fitted.weights).measured());
    let json = |errors: &Option<Errors>| errors.as_ref().map_or(Value::Null, Errors::to_json);
    Ok(ModelComparison {
        model: name.to_owned(),
        parameters: parameters(problem.forward, &fitted.fit),
        chi2_per_n: measured.norm_squared() / measured.len() as f64,
        p_lof,
        apparatus: ApparatusError::all(problem.forward, &fitted),
        rms: Rms { fit: json(&failing.fit), holdout: json(&failing.holdout) },
        fails: failing.force_errors.fails(),
        failing,
        fitted,
    })
}
