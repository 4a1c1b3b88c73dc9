//! Measurements and a model: fitted to measurements, under the noise that its own trajectories give.

use measurements::MeasurementSet;
use nalgebra::DMatrix;
use rayon::prelude::*;
use thiserror::Error;

use crate::fit::restricted_likelihood::between;
use crate::fit::{Data, Fit};
use crate::forward::apparatus::defaults;
use crate::forward::sensitivity::{Point, Sensitivity};
use crate::forward::{Forward, PredictError};
use crate::noise::between::Between;
use crate::noise::weights::{Weight, with_stop_error};
use crate::noise::{Noise, NoiseSource};
use crate::observed::Observed;

/// How often noise and fit are taken in turn: the scatter of trajectories is propagated along the
/// model, and the first guess of a model is wrong by construction.
const ROUNDS: usize = 3;

/// Fewest conditions from which their scatter is learned: that of fewer is hardly known, and hides any effect.
const CONDITIONS: usize = 6;

/// Largest scatter of coefficients between conditions, in standard deviations of what is known beforehand.
pub(crate) const MOST_BETWEEN: f64 = 4.0;

/// The same of angles: a launcher is set to a degree, and a force across the motion turns paths by several.
const MOST_OF_ANGLES: f64 = 2.0;

/// How often the scatter between conditions and the fit are taken in turn in each of these rounds,
const BETWEEN_ROUNDS: usize = 2;

/// and the share of it, and of what is known of it beforehand, that is no change.
const SETTLED: f64 = 0.1;

/// Seed of resampled and drawn noise, where none is asked for.
pub const DEFAULT_SEED: u64 = 1;

/// Measurements and the model that they are compared with.
#[derive(Clone, Copy)]
pub struct FitProblem<'a> {
    /// The set.
    pub set: &'a MeasurementSet,
    /// Its observables.
    pub observed: &'a Observed,
    /// The model.
    pub forward: &'a dyn Forward,
}

/// A model fitted under its own noise.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The fit.
    pub fit: Fit,
    /// One per condition that was fitted to.
    pub weights: Vec<Weight>,
    /// What the weights are from.
    pub noise: Noise,
}

impl Fitted {
    /// Twice the negative logarithm of the likelihood, with what priors and the scatter between conditions cost.
    pub(crate) fn deviance(&self) -> f64 {
        self.fit.chi2 + self.cost_of_noise()
    }

    /// The part of the deviance that is not the misfit.
    pub(crate) fn cost_of_noise(&self) -> f64 {
        let cost = |Between { sd, sigma, .. }: Between| match sigma > 0.0 {
            true => (sd / sigma).powi(2),
            false => 0.0,
        };
        let between = cost(self.noise.sessions) + cost(self.noise.angles);
        self.weights.iter().map(Weight::log_determinant).sum::<f64>() + between
    }
}

/// Why measurements cannot be compared with a model.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum FitError {
    #[error(transparent)]
    Predict(#[from] PredictError),
    #[error("condition `{id}`: the model predicts {found} numbers; {expected} were measured")]
    Layout { id: String, found: usize, expected: usize },
    #[error("a formula of the missing force cannot be read: {0}")]
    Formula(String),
    #[error(
        "there are neither repeats nor stated errors: repeat at least one condition, or state `[noise]`"
    )]
    NoErrors,
    #[error("{measured} numbers were measured to fit {free} unknowns to")]
    TooFew { measured: usize, free: usize },
    #[error(
        "condition `{id}`: the errors of its numbers are not finite, or so large or small that they have no inverse; \
         compare its numbers and their errors with those of the other conditions"
    )]
    Singular { id: String },
}

impl FitProblem<'_> {
    /// Fits the model with the effects of `start`, noise and fit in turn.
    ///
    /// # Errors
    /// If there is too little to fit to, or the model fails.
    pub fn fit(&self, start: &Point) -> Result<Fitted, FitError> {
        let measured =
            self.observed.fit.iter().map(|&c| self.observed.conditions[c].layout.len()).sum();
        let without_prior = self.forward.parameters().iter().filter(|one| one.prior.is_none());
        let free = without_prior.count() + start.effects.len();
        if measured <= free {
            return Err(FitError::TooFew { measured, free });
        }
        self.fit_from(start, &self.first_noise()?)
    }

    /// Likewise, with the noise searched from `noise`.
    pub(crate) fn fit_from(&self, start: &Point, noise: &Noise) -> Result<Fitted, FitError> {
        let mut fitted = self.fit_once(start, noise)?;
        for _ in 1..ROUNDS {
            fitted = match self.fit_once(&fitted.fit.point, &fitted.noise) {
                // The scatter has no derivatives around this fit: the weights stay those of where it began.
                Err(FitError::Predict(_)) => break,
                other => other?,
            };
        }
        Ok(fitted)
    }

    /// One round from `start`, with the noise searched from `noise`.
    pub(crate) fn fit_once(&self, start: &Point, noise: &Noise) -> Result<Fitted, FitError> {
        let (sensitivities, mut noise) = self.scatter(start, noise)?;
        let weigh = |noise: &Noise| -> Result<Vec<Weight>, FitError> {
            let each = self.observed.fit.iter().zip(&sensitivities);
            each.map(|(&c, sensitivity)| self.weight(start, c, sensitivity, noise)).collect()
        };
        let mut weights = weigh(&noise)?;
        let mut fit = self.data(&weights).fit(start)?;
        let of_coefficients: Vec<_> =
            sensitivities.iter().map(Sensitivity::by_coefficients).collect();
        let of_angles: Vec<_> = sensitivities.iter().map(Sensitivity::by_angle).collect();
        let sigmas = [self.between_sigma(&noise), self.angle_sigma(&noise, &of_angles)];
        for _ in 0..BETWEEN_ROUNDS {
            let held = [noise.sessions.sd, noise.angles.sd];
            if let Some(sigma) = sigmas[0] {
                noise.sessions = between(
                    &fit,
                    &weights,
                    &of_coefficients,
                    (held[0], sigma, MOST_BETWEEN * sigma),
                );
            }
            if let Some(sigma) = sigmas[1] {
                noise.angles =
                    between(&fit, &weights, &of_angles, (held[1], sigma, MOST_OF_ANGLES * sigma));
            }
            let is_settled = |(sd, (held, sigma)): (f64, (f64, Option<f64>))| {
                sigma.is_none_or(|sigma| (sd - held).abs() <= SETTLED * held.max(SETTLED * sigma))
            };
            let found = [noise.sessions.sd, noise.angles.sd];
            if found.into_iter().zip(held.into_iter().zip(sigmas)).all(is_settled) {
                break;
            }
            weights = weigh(&noise)?;
            fit = self.data(&weights).fit(&fit.point)?;
        }
        Ok(Fitted { fit, weights, noise })
    }

    /// `fitted` again, under its noise with a scatter between conditions of `sd`.
    pub(crate) fn with_scatter_between_conditions(
        &self,
        sd: f64,
        fitted: &Fitted,
    ) -> Result<Fitted, FitError> {
        let sessions = Between { sd, ..fitted.noise.sessions };
        self.under(Noise { sessions, ..fitted.noise }, fitted)
    }

    /// `fitted` again, with angles of single conditions that are off by `sd` (rad); `None` where they are off by no more.
    pub(crate) fn with_angles_within(
        &self,
        sd: f64,
        fitted: &Fitted,
    ) -> Result<Option<Fitted>, FitError> {
        let angles = Between { sd, ..fitted.noise.angles };
        let within = || self.under(Noise { angles, ..fitted.noise }, fitted);
        (fitted.noise.angles.sd > sd).then(within).transpose()
    }

    /// `fitted` again under `noise`.
    fn under(&self, noise: Noise, fitted: &Fitted) -> Result<Fitted, FitError> {
        let weights = self.weights(&fitted.fit.point, &noise, &self.observed.fit)?;
        let fit = self.data(&weights).fit(&fitted.fit.point)?;
        Ok(Fitted { fit, weights, noise })
    }

    /// How much coefficients scatter between conditions beforehand, relative; `None` where nothing is to be learned of
    /// it: without repeats, from few conditions, where the set says which run is of which session, and where all are one.
    fn between_sigma(&self, noise: &Noise) -> Option<f64> {
        let is_known = self.observed.fit.len() >= CONDITIONS;
        self.session_sigma(noise).filter(|_| is_known)
    }

    /// How much the angles (rad) of conditions are off beforehand, each by its own error; `None` where nothing is to be
    /// learned of it.
    fn angle_sigma(&self, noise: &Noise, slopes: &[DMatrix<f64>]) -> Option<f64> {
        let angle = self.set.instrument.angle_bias_sigma_deg.unwrap_or(defaults::ANGLE_DEG);
        let matters = slopes.iter().flat_map(DMatrix::iter).any(|slope| *slope != 0.0);
        let is_known =
            noise.source == NoiseSource::Repeats && self.observed.fit.len() >= CONDITIONS;
        (is_known && matters && angle > 0.0).then(|| angle.to_radians())
    }

    /// The same however many conditions there are.
    fn session_sigma(&self, noise: &Noise) -> Option<f64> {
        let is_said = self.set.runs.iter().any(|run| run.session.is_some());
        let sigma = self.set.instrument.session_sigma_rel.unwrap_or(defaults::SESSION);
        (noise.source == NoiseSource::Repeats && !is_said && sigma > 0.0).then_some(sigma)
    }

    /// `fitted` again with conditions of sessions of their own that differ as is known beforehand; `None` where the set
    /// says its sessions, and where their scatter was learned.
    pub(crate) fn with_sessions_of_their_own(
        &self,
        fitted: &Fitted,
    ) -> Result<Option<Fitted>, FitError> {
        match (self.between_sigma(&fitted.noise), self.session_sigma(&fitted.noise)) {
            (None, Some(sigma)) => self.with_scatter_between_conditions(sigma, fitted).map(Some),
            _ => Ok(None),
        }
    }

    /// The measurements under `weights`.
    pub fn data<'a>(&'a self, weights: &'a [Weight]) -> Data<'a> {
        let conditions = &self.observed.fit;
        Data { forward: self.forward, observed: self.observed, conditions, weights }
    }

    /// The sensitivity of `condition` at `point`.
    ///
    /// # Errors
    /// If the model fails, or predicts something else than was measured.
    pub fn sensitivity(&self, point: &Point, condition: usize) -> Result<Sensitivity, FitError> {
        let observed = &self.observed.conditions[condition];
        let sensitivity = Sensitivity::at(point, self.forward, condition, observed.reach)?;
        let (found, expected) = (sensitivity.mean.len(), observed.layout.len());
        match found == expected {
            true => Ok(sensitivity),
            false => Err(FitError::Layout { id: observed.id.clone(), found, expected }),
        }
    }

    /// The weights of `conditions` under `noise`, along the paths at `point`.
    pub fn weights(
        &self,
        point: &Point,
        noise: &Noise,
        conditions: &[usize],
    ) -> Result<Vec<Weight>, FitError> {
        let weight = |&condition: &usize| {
            let sensitivity = self.sensitivity(point, condition)?;
            self.weight(point, condition, &sensitivity, noise)
        };
        conditions.iter().map(weight).collect()
    }

    fn weight(
        &self,
        point: &Point,
        condition: usize,
        sensitivity: &Sensitivity,
        noise: &Noise,
    ) -> Result<Weight, FitError> {
        let observed = &self.observed.conditions[condition];
        let own = self.own_covariance(condition, &point.effects, noise);
        let own = with_stop_error(own, observed, self.forward.stop_error(condition));
        Weight::new(observed, sensitivity, noise, own)
            .ok_or_else(|| FitError::Singular { id: observed.id.clone() })
    }

    /// Covariance of what the model predicts with `effects`: of the means of its runs, and of what conditions differ by
    /// beyond them.
    pub(crate) fn own_covariance(
        &self,
        condition: usize,
        effects: &[(usize, f64)],
        noise: &Noise,
    ) -> Option<DMatrix<f64>> {
        let own = self.forward.own_covariance(condition, effects)?;
        Some(match self.forward.spread_of_runs(condition) {
            Some(spread) => own + noise.between * spread,
            None => own,
        })
    }

    /// The sensitivities of the conditions to fit along the paths at `point`, and the noise that repeats show with them.
    fn scatter(&self, point: &Point, noise: &Noise) -> Result<(Vec<Sensitivity>, Noise), FitError> {
        let fit = &self.observed.fit;
        let sensitivities = fit.par_iter().map(|&c| self.sensitivity(point, c)).collect::<Vec<_>>();
        let sensitivities = sensitivities.into_iter().collect::<Result<Vec<_>, _>>()?;
        let noise = noise.estimate(self.observed, &sensitivities, &self.set.instrument);
        Ok((sensitivities, noise))
    }

    fn first_noise(&self) -> Result<Noise, FitError> {
        if self.observed.has_repeats() {
            Ok(Noise::guess(&self.set.instrument))
        } else if self.set.kind.has_readings() && self.set.states_errors() {
            // What is stated of final depths says nothing of how paths scatter.
            Ok(Noise::assumed_scatter(&self.set.instrument))
        } else if self.observed.has_stated_errors() {
            Ok(Noise::stated())
        } else {
            Err(FitError::NoErrors)
        }
    }
}
