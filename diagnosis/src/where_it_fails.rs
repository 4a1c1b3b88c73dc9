//! Where models fail, as tables and pictures: what `plunge compare` and `plunge diagnose` write.
//!
//! A [`Failing`] is one model, [`WhereItFails`] all models of a report; its `files` are listed in
//! `docs/output-files.md`.

mod files;
mod json;
mod signature;
mod tables;

use measurements::MeasurementSet;

pub use self::files::{FILES, FilesError, MISSING_FORCE, files_of};
pub use self::signature::Signature;

use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::misfit::errors::Errors;
use crate::misfit::force_error::ForceErrors;
use crate::misfit::noise_floor::noise_floor;
use crate::misfit::residual::{Residual, predictable, residuals};
use crate::observed::Observed;
use crate::verdict::Diagnosis;

/// How one model fails.
#[derive(Clone, Debug)]
pub struct Failing {
    /// Name of the model.
    pub model: String,
    /// By which its force is wrong.
    pub force_errors: ForceErrors,
    /// Every number beside its prediction, held-out ones included.
    pub residuals: Vec<Residual>,
    /// Errors where it was fitted to.
    pub fit: Option<Errors>,
    /// Errors where it was not; none if the set holds out nothing.
    pub holdout: Option<Errors>,
}

/// How all models of a report fail.
#[derive(Clone, Debug)]
pub struct WhereItFails<'a> {
    /// What was measured.
    pub set: &'a MeasurementSet,
    /// Its observables.
    pub observed: &'a Observed,
    /// In the order of the report.
    pub models: Vec<Failing>,
    /// What the best candidates would do to the first model, best first; at most two.
    pub signatures: Vec<Signature>,
}

impl Failing {
    /// Of `fitted`, called `model`, with the held-out conditions `holdout`, which it can predict; orders of runs are drawn
    /// with `seed`.
    pub fn of(
        problem: &FitProblem<'_>,
        (model, fitted): (&str, &Fitted),
        holdout: &[usize],
        seed: u64,
    ) -> Result<Self, FitError> {
        let point = &fitted.fit.point;
        Ok(Self {
            model: model.to_owned(),
            force_errors: ForceErrors::of(problem, fitted, seed)?,
            residuals: residuals(problem, point, &fitted.noise, holdout)?,
            fit: Errors::at(problem, point, &problem.observed.fit)?,
            holdout: Errors::at(problem, point, holdout)?,
        })
    }
}

impl<'a> WhereItFails<'a> {
    /// Of the model called `name` as it is and with what `diagnosis` names, and what the two best
    /// candidates would do; orders of runs are drawn with `seed`.
    pub fn of_diagnosis(
        problem: &FitProblem<'a>,
        name: &str,
        diagnosis: &Diagnosis,
        seed: u64,
    ) -> Result<Self, FitError> {
        let FitProblem { set, observed, .. } = *problem;
        let Some(baseline) = &diagnosis.baseline else {
            return Ok(Self { set, observed, models: Vec::new(), signatures: Vec::new() });
        };
        let proposed = diagnosis.proposed.as_ref().filter(|_| !diagnosis.effects.is_empty());
        let points = [Some(baseline), proposed].into_iter().flatten();
        let asked: Vec<_> = points.map(|fitted| (*problem, &fitted.fit.point)).collect();
        // What is not predicted stands in the diagnosis.
        let (holdout, _) = predictable(&asked);
        let mut models = vec![Failing::of(problem, (name, baseline), &holdout, seed)?];
        if let Some(proposed) = proposed {
            let name = format!("{name} + {}", diagnosis.effects.join(" + "));
            models.push(Failing::of(problem, (&name, proposed), &holdout, seed)?);
        }
        let signatures =
            signature::best_two(problem, baseline, (&models[0].residuals, &holdout), diagnosis);
        Ok(Self { set, observed, models, signatures })
    }

    /// What means of so many runs would miss the truth by, in the conditions that were fitted to and
    /// in those that were held out.
    pub(crate) fn noise_floors(&self) -> [Errors; 2] {
        [&self.observed.fit, &self.observed.holdout].map(|part| noise_floor(self.observed, part))
    }
}
