//! One signature per candidate, from runs in which half of the candidates are on.

use nalgebra::{Cholesky, DMatrix, DVector};
use runner::beds::Job;
use runner::beds::Record;

use super::baseline::Baseline;
use super::bed_candidate::BedCandidate;
use super::bed_model::{BedModel, BedModelError, Draw};
use super::clarity::lost;
use super::design::folded;
use super::emulator::Screened;
use super::observables::observables;
use super::response::Response;
use super::variation::Variation;
use crate::forward::observable::Layout;

/// Runs and their mirrors on one draw of a bed: so many pairs that the draw cancels from every main effect
/// without a bed of its own for each.
const PAIRS_PER_DRAW: usize = 3;

/// Which runs a screening is made of.
pub(super) struct Screening {
    pub(super) bed_candidates: Vec<&'static BedCandidate>,
    pub(super) conditions: Vec<usize>,
    /// One list per condition.
    draws: Vec<Vec<Draw>>,
    /// Which candidates are on, and the number of the draw, of every setting.
    settings: Vec<(Vec<bool>, usize)>,
}

impl Screening {
    /// Of `candidates` under `conditions`, the design `repeats` times, on `draws` in turn.
    pub(super) fn new(
        bed_candidates: Vec<&'static BedCandidate>,
        conditions: Vec<usize>,
        repeats: usize,
        draws: Vec<Vec<Draw>>,
    ) -> Self {
        let n_draws = draws.first().map_or(1, Vec::len);
        let rows = folded(bed_candidates.len());
        let all: Vec<Vec<bool>> = (0..repeats).flat_map(|_| rows.clone()).collect();
        let runs_per_draw = 2 * PAIRS_PER_DRAW;
        let settings = all.into_iter().enumerate();
        let draw = |at: usize| (at / runs_per_draw) % n_draws;
        let settings = settings.map(|(at, row)| (row, draw(at))).collect();
        Self { bed_candidates, conditions, draws, settings }
    }

    /// How many impacts that is.
    pub(super) fn n_runs(&self) -> usize {
        self.settings.len() * self.conditions.len()
    }

    /// The impacts, condition after condition.
    pub(super) fn jobs(&self, bed_model: &BedModel<'_>) -> Result<Vec<Job>, BedModelError> {
        let model = bed_model.grains();
        let mut jobs = Vec::with_capacity(self.n_runs());
        for (&condition, draws) in self.conditions.iter().zip(&self.draws) {
            for (row, draw) in &self.settings {
                let on = self.bed_candidates.iter().zip(row).filter(|(_, on)| **on);
                let variation = on.fold(Variation::default(), |all, (bed_candidate, _)| {
                    all.and(bed_candidate.change(model, bed_candidate.screen))
                });
                jobs.push(bed_model.job(condition, draws[*draw], &variation)?);
            }
        }
        Ok(jobs)
    }

    /// What the `records` of the impacts say of every candidate; `paired` is the correlation of runs on one
    /// draw, `baseline` the model as it stands.
    pub(super) fn signatures(
        &self,
        bed_model: &BedModel<'_>,
        layouts: &[Layout],
        records: &[Option<Record>],
        (paired, baseline): (f64, &Baseline),
    ) -> Vec<Screened> {
        let n = self.settings.len();
        let effects: Vec<Option<MainEffects>> = self
            .conditions
            .iter()
            .enumerate()
            .map(|(at, &condition)| {
                let records = &records[at * n..(at + 1) * n];
                self.main_effects(bed_model, (condition, &layouts[condition]), records)
            })
            .collect();
        let bed_candidates = self.bed_candidates.iter().enumerate();
        let screened = bed_candidates.map(|(column, &bed_candidate)| {
            let mut responses = vec![None; layouts.len()];
            for (&condition, effects) in self.conditions.iter().zip(&effects) {
                let Some(MainEffects { sizes, covariance }) = effects else { continue };
                let slope = sizes.row(column).transpose() / bed_candidate.screen;
                let own = (1.0 - paired) * covariance[(column, column)];
                let own = own / (bed_candidate.screen * bed_candidate.screen);
                let curvature = slope.map(|_| 0.0);
                let variance = [[own, 0.0], [0.0, 0.0]];
                let deviations = Vec::new();
                responses[condition] = Some(Response { slope, curvature, variance, deviations });
            }
            screened(bed_candidate, responses, (baseline, self.n_runs()))
        });
        screened.collect()
    }

    /// Main effects of the candidates at their amplitudes: least squares with a level of its own for every
    /// draw. None where too few runs ended.
    fn main_effects(
        &self,
        bed_model: &BedModel<'_>,
        (condition, layout): (usize, &Layout),
        records: &[Option<Record>],
    ) -> Option<MainEffects> {
        let draws = 1 + self.settings.iter().map(|(_, draw)| *draw).max()?;
        let columns = self.bed_candidates.len() + draws;
        let (mut rows, mut found) = (Vec::new(), Vec::new());
        for ((on, draw), record) in self.settings.iter().zip(records) {
            let Some(record) = record else { continue };
            let level = |other: usize| if other == *draw { 1.0 } else { 0.0 };
            let on = on.iter().map(|&on| if on { 1.0 } else { 0.0 });
            rows.push(DVector::from_iterator(columns, on.chain((0..draws).map(level))));
            let condition = &bed_model.set.conditions[condition];
            found.push(observables(record, layout, condition, bed_model.set));
        }
        if rows.len() <= columns {
            return None;
        }
        let (x, y) = (DMatrix::from_columns(&rows), DMatrix::from_columns(&found));
        let covariance = Cholesky::new(&x * x.transpose())?.inverse();
        Some(MainEffects { sizes: &covariance * (&x * y.transpose()), covariance })
    }
}

/// `bed_candidate` with its `responses`, found by so many `runs` beside `baseline`; it cannot be tested where all
/// conditions together do not show it, along the modes in which runs scatter: what an effect does that is worth
/// a look is as smooth as they are, and among all numbers it would be lost.
pub(super) fn screened(
    bed_candidate: &'static BedCandidate,
    responses: Vec<Option<Response>>,
    (baseline, runs): (&Baseline, usize),
) -> Screened {
    let lost = lost((&responses, bed_candidate.screen), baseline, runs);
    Screened::new(bed_candidate, responses, lost)
}

/// One row per candidate, then one per draw.
struct MainEffects {
    sizes: DMatrix<f64>,
    /// In units of the covariance of a run around the level of its draw.
    covariance: DMatrix<f64>,
}
