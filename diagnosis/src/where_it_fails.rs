//! Where models fail, as tables and pictures: what `plunge compare` and `plunge diagnose` write.
//!
//! A [`Failing`] is one model, [`WhereItFails`] all models of a report; its `files` are listed in
//! `docs/output-files.md`.

mod json;
mod signature;
mod tables;

use measurements::MeasurementSet;
use plots::PictureError;
use thiserror::Error;

pub use self::signature::Signature;

use crate::bench::{Bench, BenchError, Fitted};
use crate::compare::Comparison;
use crate::errors::Errors;
use crate::force_error::ForceErrors;
use crate::held_out::noise_floor;
use crate::observed::Observed;
use crate::picture;
use crate::residual::{Residual, predictable, residuals};
use crate::verdict::Diagnosis;

/// Names of all files that there may be.
pub const FILES: [&str; 12] = [
    "force_errors.csv",
    "residuals.csv",
    "signatures.csv",
    "where_it_fails.json",
    "map-speed-angle.svg",
    "map-depth.svg",
    "residuals.svg",
    "covariates.svg",
    "errors.svg",
    "revisions.svg",
    "trajectories.svg",
    "signatures.svg",
];

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

/// What keeps a table or picture from being written.
#[derive(Debug, Error)]
pub enum FilesError {
    /// A table.
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    /// The file of numbers.
    #[error("cannot write numbers: {0}")]
    Json(#[from] serde_json::Error),
    /// A picture.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

impl Failing {
    /// Of `fitted`, called `model`, with the held-out conditions `holdout`, which it can predict; orders of runs are drawn
    /// with `seed`.
    ///
    /// # Errors
    /// If the model fails.
    pub fn of(
        bench: &Bench<'_>,
        (model, fitted): (&str, &Fitted),
        holdout: &[usize],
        seed: u64,
    ) -> Result<Self, BenchError> {
        let point = &fitted.fit.point;
        Ok(Self {
            model: model.to_owned(),
            force_errors: ForceErrors::of(bench, fitted, seed)?,
            residuals: residuals(bench, point, &fitted.noise, holdout)?,
            fit: Errors::at(bench, point, &bench.observed.fit)?,
            holdout: Errors::at(bench, point, holdout)?,
        })
    }
}

impl<'a> WhereItFails<'a> {
    /// Of every revision of `comparison`, which is of `set` and its `observed`.
    #[must_use]
    pub fn of_comparison(
        set: &'a MeasurementSet,
        observed: &'a Observed,
        comparison: &Comparison,
    ) -> Self {
        let models = comparison.models.iter().map(|model| model.failing.clone()).collect();
        Self { set, observed, models, signatures: Vec::new() }
    }

    /// Of the model called `name` as it is and with what `diagnosis` names, and what the two best
    /// candidates would do; orders of runs are drawn with `seed`.
    ///
    /// # Errors
    /// If the model fails.
    pub fn of_diagnosis(
        bench: &Bench<'a>,
        name: &str,
        diagnosis: &Diagnosis,
        seed: u64,
    ) -> Result<Self, BenchError> {
        let Bench { set, observed, .. } = *bench;
        let Some(baseline) = &diagnosis.baseline else {
            return Ok(Self { set, observed, models: Vec::new(), signatures: Vec::new() });
        };
        let proposed = diagnosis.proposed.as_ref().filter(|_| !diagnosis.effects.is_empty());
        let points = [Some(baseline), proposed].into_iter().flatten();
        let asked: Vec<_> = points.map(|fitted| (*bench, &fitted.fit.point)).collect();
        // What is not predicted stands in the diagnosis.
        let (holdout, _) = predictable(&asked);
        let mut models = vec![Failing::of(bench, (name, baseline), &holdout, seed)?];
        if let Some(proposed) = proposed {
            let name = format!("{name} + {}", diagnosis.effects.join(" + "));
            models.push(Failing::of(bench, (&name, proposed), &holdout, seed)?);
        }
        let signatures =
            signature::best_two(bench, baseline, (&models[0].residuals, &holdout), diagnosis);
        Ok(Self { set, observed, models, signatures })
    }

    /// Names and texts of the files; without those that the set cannot have.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn files(&self) -> Result<Vec<(String, String)>, FilesError> {
        if self.models.is_empty() {
            return Ok(Vec::new());
        }
        let texts = [
            Some(tables::force_errors(self)?),
            Some(tables::residuals(self)?),
            tables::signatures(self)?,
            Some(json::text(self)?),
            picture::speed_angle(self)?,
            picture::depth(self)?,
            picture::residuals(self)?,
            picture::covariates(self)?,
            picture::errors(self)?,
            picture::revisions(self)?,
            picture::trajectories(self)?,
            picture::signatures(self)?,
        ];
        let named = FILES.iter().zip(texts);
        Ok(named.filter_map(|(name, text)| Some(((*name).to_owned(), text?))).collect())
    }

    /// What means of so many runs would miss the truth by, in the conditions that were fitted to and
    /// in those that were held out.
    pub(crate) fn noise_floors(&self) -> [Errors; 2] {
        [&self.observed.fit, &self.observed.holdout].map(|part| noise_floor(self.observed, part))
    }
}
