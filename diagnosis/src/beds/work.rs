//! A diagnosis of a bed under way: what it has, and how it runs impacts and judges.

use runner::beds::Impacts;
use runner::beds::Job;
use runner::beds::Record;

use super::bed_model::{BedModel, Draw};
use super::emulator::BedForward;
use super::error::BedError;
use super::plan::Plan;
use super::preparation::Preparation;
use crate::diagnose::diagnose;
use crate::fit::problem::FitProblem;
use crate::forward::observable::Layout;
use crate::observed::Observed;
use crate::verdict::Diagnosis;

/// Impacts of the model as it stands, which others are held against.
#[derive(Clone, Copy)]
pub(super) struct Standing<'a> {
    /// One list per condition.
    pub(super) draws: &'a [Vec<Draw>],
    /// Likewise; none where one did not end.
    pub(super) runs: &'a [Vec<Option<Record>>],
    /// Of two runs on one draw.
    pub(super) correlation: f64,
}

/// A diagnosis under way.
pub(super) struct Work<'a> {
    pub(super) bed_model: &'a BedModel<'a>,
    pub(super) place: &'a dyn Impacts,
    pub(super) plan: Plan,
    pub(super) layouts: Vec<Layout>,
    /// The set, with the conditions of the plan alone to fit to.
    pub(super) observed: Observed,
    pub(super) seed: u64,
    pub(super) impacts: usize,
    pub(super) preparation: Preparation,
}

impl Work<'_> {
    /// What the impacts `jobs` come to.
    pub(super) fn run(&mut self, jobs: &[Job]) -> Result<Vec<Option<Record>>, BedError> {
        self.impacts += jobs.len();
        Ok(self.place.run(jobs)?)
    }

    /// What the statistics say of the model and of what is known of its candidates.
    pub(super) fn judge(&self, forward: &BedForward) -> Result<Diagnosis, BedError> {
        Ok(diagnose(
            &FitProblem { set: self.bed_model.set, observed: &self.observed, forward },
            self.seed,
        )?)
    }
}
