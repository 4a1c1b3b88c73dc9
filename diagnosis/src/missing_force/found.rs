//! The force as a process, where answers are taken around the force that is there.

use measurements::median;
use std::sync::Arc;

use nalgebra::DVector;

use super::apart::Apart;
use super::process::Process;
use super::response::Response;
use super::with_field::WithField;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::fit::{Data, Fit};
use crate::forward::field::Field;
use crate::forward::{Moment, Passages, Request, Scatter};

/// Moments of each condition at which the force is given.
pub(super) const MOMENTS: usize = 40;

/// Most times that answers are taken around the force that they gave, each on the way that fits better, and the share of χ²
/// that is no gain.
const ROUNDS: usize = 12;
const HALVINGS: usize = 3;
const SETTLED: f64 = 0.02;

/// The force as a process, around itself: answers to a force depend on the force that is there.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) field: Field,
    pub(super) fit: Fit,
    pub(super) response: Response,
    pub(super) process: Process,
    /// Size of the model's force, in units of ρ g A D.
    unit: f64,
    /// What the bodies go through in the model with that force, by condition that is fitted to.
    pub(super) passages: Vec<Vec<Moment>>,
}

impl Found {
    /// From `fit`, which is of the model with the force of `field`; `None` where nothing stops the bodies, or nothing can
    /// be told.
    pub(super) fn from(
        problem: &FitProblem<'_>,
        by: &dyn Passages,
        (baseline, fit): (&Fitted, Fit),
        field: Field,
    ) -> Result<Option<Self>, FitError> {
        let found = Self::around(problem, by, (baseline, fit), field)?;
        found.map(|found| found.settled(problem, by, baseline)).transpose()
    }

    /// Repeats the search around the force that it finds until the fit no longer improves.
    pub(super) fn settled(
        mut self,
        problem: &FitProblem<'_>,
        by: &dyn Passages,
        baseline: &Fitted,
    ) -> Result<Self, FitError> {
        for _ in 0..ROUNDS {
            let Some(next) = self.nearer(problem, by, baseline)? else { break };
            let is_settled = self.fit.chi2 - next.fit.chi2 < SETTLED * next.fit.chi2;
            self = next;
            if is_settled {
                break;
            }
        }
        Ok(self)
    }

    /// Around the mean of the process, or around a part of the way to it, where the model fits better; `None` where it
    /// does so nowhere.
    fn nearer(
        &self,
        problem: &FitProblem<'_>,
        by: &dyn Passages,
        baseline: &Fitted,
    ) -> Result<Option<Self>, FitError> {
        let whole: DVector<f64> =
            &self.process.mean - DVector::from_column_slice(&self.field.values);
        let field = |share: f64| {
            let values = self.field.values.iter().zip(whole.iter());
            let values = values.map(|(at, by)| at + share * by).collect();
            Field { grid: self.field.grid.clone(), values }
        };
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let field = field(share);
            let with = WithField { forward: problem.forward, field: Arc::new(field.clone()) };
            let data = Data { forward: &with, ..problem.data(&baseline.weights) };
            // The parameters that fit best beside this force, to first order.
            let left = &self.fit.residual - self.response.change(&(&whole * share));
            let Some(point) = self.fit.moved(&left, &data.scales(&self.fit.point)) else {
                return Ok(None);
            };
            if data.residual(&point).is_ok_and(|left| left.norm_squared() < self.fit.chi2) {
                let fit = data.as_listed_at(point)?;
                return Self::around(problem, by, (baseline, fit), field);
            }
            share *= 0.5;
        }
        // Where none does, parameters are searched beside the smallest part.
        let field = field(share);
        let with = WithField { forward: problem.forward, field: Arc::new(field.clone()) };
        let data = Data { forward: &with, ..problem.data(&baseline.weights) };
        let fit = data.fit_as_listed(&self.fit.point).ok();
        match fit.filter(|fit| fit.chi2 < self.fit.chi2) {
            Some(fit) => Self::around(problem, by, (baseline, fit), field),
            None => Ok(None),
        }
    }

    /// How far the force on each condition lies from the one that all share.
    pub(super) fn apart(&self) -> Option<Apart> {
        Apart::of((&self.response, &self.fit, &self.process), &self.field.grid, self.unit)
    }

    /// Logarithm of the likelihood of what was measured, sizes and lengths averaged, under the noise of `under`.
    pub(super) fn evidence(&self, under: &Fitted) -> f64 {
        let chi2 = self.response.residual.norm_squared();
        let misfit = self.misfit().max(1.0);
        let wider = self.fit.residual.len() as f64 * libm::log(misfit);
        self.process.log_odds - 0.5 * (chi2 / misfit + wider + under.cost_of_noise())
    }

    /// What is left over in units of the noise.
    pub(super) fn misfit(&self) -> f64 {
        let rows = self.fit.residual.len();
        self.fit.chi2 / rows.saturating_sub(self.fit.n_free()).max(1) as f64
    }

    /// One step of the search, with the answers taken around the force of `field`.
    pub(super) fn around(
        problem: &FitProblem<'_>,
        by: &dyn Passages,
        (baseline, fit): (&Fitted, Fit),
        field: Field,
    ) -> Result<Option<Self>, FitError> {
        let scatter = Scatter {
            coefficients: vec![0.0; problem.forward.n_scattering_coefficients()],
            field: Some(Arc::new(field.clone())),
            ..Scatter::default()
        };
        let at = Request { parameters: &fit.point.parameters, effects: &[], scatter: &scatter };
        let passage = |&condition: &usize| by.passage(condition, &at, &[], MOMENTS);
        let passages: Vec<Vec<Moment>> =
            problem.observed.fit.iter().map(passage).collect::<Result<_, _>>()?;
        let relative = passages.iter().flatten().map(|one| one.force / one.unit);
        let Some(unit) = median(relative.filter(|force| *force > 0.0)) else { return Ok(None) };
        let response = Response::of(problem, (&fit, &baseline.weights), &field, &passages)?;
        if response.nodes.is_empty() {
            return Ok(None);
        }
        let rows = fit.residual.len();
        let misfit = fit.chi2 / rows.saturating_sub(fit.n_free()).max(1) as f64;
        let process = Process::of(&response, &field.grid, unit, misfit.max(1.0));
        Ok(process.map(|process| Self { field, fit, response, process, unit, passages }))
    }
}
