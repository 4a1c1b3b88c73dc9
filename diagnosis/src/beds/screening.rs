//! One signature per switch, from runs in which half of the switches are on.

use nalgebra::{Cholesky, DMatrix, DVector};
use runner::beds::Job;
use runner::beds::Record;

use super::baseline::Baseline;
use super::clarity::lost;
use super::design::folded;
use super::emulator::Screened;
use super::observables::observables;
use super::response::Response;
use super::stand::{Draw, Stand, StandError};
use super::switch::Switch;
use super::variation::Variation;
use crate::observable::Layout;

/// Runs and their mirrors on one draw of a bed: so many pairs that the draw cancels from every main effect
/// without a bed of its own for each.
const PAIRS_PER_DRAW: usize = 3;

/// Which runs a screening is made of.
pub(super) struct Screening {
    pub(super) switches: Vec<&'static Switch>,
    pub(super) conditions: Vec<usize>,
    /// One list per condition.
    draws: Vec<Vec<Draw>>,
    /// Which switches are on, and the number of the draw, of every setting.
    settings: Vec<(Vec<bool>, usize)>,
}

impl Screening {
    /// Of `switches` under `conditions`, the design `repeats` times, on `draws` in turn.
    pub(super) fn new(
        switches: Vec<&'static Switch>,
        conditions: Vec<usize>,
        repeats: usize,
        draws: Vec<Vec<Draw>>,
    ) -> Self {
        let n_draws = draws.first().map_or(1, Vec::len);
        let rows = folded(switches.len());
        let all: Vec<Vec<bool>> = (0..repeats).flat_map(|_| rows.clone()).collect();
        let runs_per_draw = 2 * PAIRS_PER_DRAW;
        let settings = all.into_iter().enumerate();
        let draw = |at: usize| (at / runs_per_draw) % n_draws;
        let settings = settings.map(|(at, row)| (row, draw(at))).collect();
        Self { switches, conditions, draws, settings }
    }

    /// How many impacts that is.
    pub(super) fn n_runs(&self) -> usize {
        self.settings.len() * self.conditions.len()
    }

    /// The impacts, condition after condition.
    pub(super) fn jobs(&self, stand: &Stand<'_>) -> Result<Vec<Job>, StandError> {
        let model = stand.grains();
        let mut jobs = Vec::with_capacity(self.n_runs());
        for (&condition, draws) in self.conditions.iter().zip(&self.draws) {
            for (row, draw) in &self.settings {
                let on = self.switches.iter().zip(row).filter(|(_, on)| **on);
                let variation = on.fold(Variation::default(), |all, (switch, _)| {
                    all.and(switch.change(model, switch.screen))
                });
                jobs.push(stand.job(condition, draws[*draw], &variation)?);
            }
        }
        Ok(jobs)
    }

    /// What the `records` of the impacts say of every switch; `paired` is the correlation of runs on one
    /// draw, `baseline` the model as it stands.
    pub(super) fn signatures(
        &self,
        stand: &Stand<'_>,
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
                self.main_effects(stand, (condition, &layouts[condition]), records)
            })
            .collect();
        let switches = self.switches.iter().enumerate();
        let screened = switches.map(|(column, &switch)| {
            let mut responses = vec![None; layouts.len()];
            for (&condition, effects) in self.conditions.iter().zip(&effects) {
                let Some(MainEffects { sizes, covariance }) = effects else { continue };
                let slope = sizes.row(column).transpose() / switch.screen;
                let own = (1.0 - paired) * covariance[(column, column)];
                let own = own / (switch.screen * switch.screen);
                let curvature = slope.map(|_| 0.0);
                let variance = [[own, 0.0], [0.0, 0.0]];
                let deviations = Vec::new();
                responses[condition] = Some(Response { slope, curvature, variance, deviations });
            }
            screened(switch, responses, (baseline, self.n_runs()))
        });
        screened.collect()
    }

    /// Main effects of the switches at their amplitudes: least squares with a level of its own for every
    /// draw. None where too few runs ended.
    fn main_effects(
        &self,
        stand: &Stand<'_>,
        (condition, layout): (usize, &Layout),
        records: &[Option<Record>],
    ) -> Option<MainEffects> {
        let draws = 1 + self.settings.iter().map(|(_, draw)| *draw).max()?;
        let columns = self.switches.len() + draws;
        let (mut rows, mut found) = (Vec::new(), Vec::new());
        for ((on, draw), record) in self.settings.iter().zip(records) {
            let Some(record) = record else { continue };
            let level = |other: usize| if other == *draw { 1.0 } else { 0.0 };
            let on = on.iter().map(|&on| if on { 1.0 } else { 0.0 });
            rows.push(DVector::from_iterator(columns, on.chain((0..draws).map(level))));
            let condition = &stand.set.conditions[condition];
            found.push(observables(record, layout, condition, stand.set));
        }
        if rows.len() <= columns {
            return None;
        }
        let (x, y) = (DMatrix::from_columns(&rows), DMatrix::from_columns(&found));
        let covariance = Cholesky::new(&x * x.transpose())?.inverse();
        Some(MainEffects { sizes: &covariance * (&x * y.transpose()), covariance })
    }
}

/// `switch` with its `responses`, found by so many `runs` beside `baseline`; it cannot be tested where all
/// conditions together do not show it, along the modes in which runs scatter: what an effect does that is worth
/// a look is as smooth as they are, and among all numbers it would be lost.
pub(super) fn screened(
    switch: &'static Switch,
    responses: Vec<Option<Response>>,
    (baseline, runs): (&Baseline, usize),
) -> Screened {
    let lost = lost((&responses, switch.screen), baseline, runs);
    Screened::new(switch, responses, lost)
}

/// One row per switch, then one per draw.
struct MainEffects {
    sizes: DMatrix<f64>,
    /// In units of the covariance of a run around the level of its draw.
    covariance: DMatrix<f64>,
}
