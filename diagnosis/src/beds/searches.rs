//! Impacts of candidates alone: of those that lead, and of those that screening loses in the scatter and that would lead.

use super::baseline::Baseline;
use super::bed_candidate::BedCandidate;
use super::bed_model::Draw;
use super::emulator::{BedForward, Screened};
use super::error::BedError;
use super::leaders::{is_settled, leaders};
use super::line_search::{Against, LineSearch};
use super::plan::SEARCHES;
use super::response::Response;
use super::screening::screened;
use super::work::{Standing, Work};
use crate::verdict::Diagnosis;

impl Work<'_> {
    /// Searches the leading candidates, except those `searched` before, until one is ahead of the others.
    pub(super) fn settle(
        &mut self,
        forward: &mut BedForward,
        searched: &mut Vec<usize>,
        standing: Standing<'_>,
    ) -> Result<Diagnosis, BedError> {
        let mut diagnosis = self.judge(forward)?;
        for _ in 0..SEARCHES {
            let leaders = leaders(&diagnosis, forward, searched);
            if leaders.is_empty() {
                break;
            }
            for one in leaders {
                searched.push(one.0);
                self.refine(forward, one, standing)?;
            }
            let before = std::mem::replace(&mut diagnosis, self.judge(forward)?);
            // Ahead of all others by the odds twice in a row: more impacts would not change that.
            if is_settled(&before) && is_settled(&diagnosis) && before.leaders == diagnosis.leaders
            {
                break;
            }
        }
        Ok(diagnosis)
    }

    /// Searches the candidates that screening loses in the scatter and that would lead with what it found of them. At their
    /// best-fitting amplitudes they may be clear. Says whether there are any.
    pub(super) fn search_lost(
        &mut self,
        forward: &mut BedForward,
        searched: &mut Vec<usize>,
        standing: Standing<'_>,
    ) -> Result<bool, BedError> {
        let lost = forward.take_at_face_value();
        let is_lost = |at: usize| lost.iter().any(|(other, _)| *other == at);
        let others = (0..forward.screened().len()).filter(|at| !is_lost(*at));
        let others: Vec<usize> = others.chain(searched.iter().copied()).collect();
        let promising = match lost.is_empty() {
            true => Vec::new(),
            false => leaders(&self.judge(forward)?, forward, &others),
        };
        forward.give_up(lost);
        for &(at, guess) in &promising {
            // Screening does not show it at its amplitude, so a smaller one would not show it either.
            let least = forward.screened()[at].bed_candidate.screen;
            let guess = guess.abs().max(least).copysign(guess);
            searched.push(at);
            self.refine(forward, (at, guess), standing)?;
        }
        Ok(!promising.is_empty())
    }

    /// Puts what a search around the amplitude `guess` finds of the candidate `at` in place of what is known of it.
    fn refine(
        &mut self,
        forward: &mut BedForward,
        (at, guess): (usize, f64),
        standing: Standing<'_>,
    ) -> Result<(), BedError> {
        let (draws, fit) = (self.searched(standing.draws), self.plan.fit.clone());
        let search = LineSearch::around(forward.screened()[at].bed_candidate, guess, &fit, &draws);
        let Some(responses) = self.search(&search, forward.baseline(), standing)? else {
            return Ok(());
        };
        let tried = search.tried();
        forward.refine(at, responses, tried);
        Ok(())
    }

    /// Those of `draws` that a candidate alone is tried on.
    fn searched(&self, draws: &[Vec<Draw>]) -> Vec<Vec<Draw>> {
        let most = self.plan.size.line_draws;
        draws.iter().map(|draws| draws[..most.min(draws.len())].to_vec()).collect()
    }

    /// What every candidate does alone, at the amplitude that is screened.
    pub(super) fn one_at_a_time(
        &mut self,
        bed_candidates: &[&'static BedCandidate],
        baseline: &Baseline,
        standing: Standing<'_>,
    ) -> Result<Vec<Screened>, BedError> {
        let (draws, fit) = (self.searched(standing.draws), self.plan.fit.clone());
        let mut all = Vec::with_capacity(bed_candidates.len());
        let runs_of_all = bed_candidates.len() * draws.iter().map(Vec::len).sum::<usize>();
        for &bed_candidate in bed_candidates {
            let search = LineSearch::once(bed_candidate, &fit, &draws);
            let found = self.search(&search, baseline, standing)?;
            let responses = found.unwrap_or_else(|| vec![None; self.layouts.len()]);
            all.push(screened(bed_candidate, responses, (baseline, runs_of_all)));
        }
        Ok(all)
    }

    /// The responses that `search` finds; none where the step of the model is too long for an amplitude:
    /// then what screening found has to do.
    fn search(
        &mut self,
        search: &LineSearch<'_>,
        baseline: &Baseline,
        Standing { runs, correlation, .. }: Standing<'_>,
    ) -> Result<Option<Vec<Option<Response>>>, BedError> {
        let Ok(jobs) = search.jobs(self.bed_model) else { return Ok(None) };
        let records = self.run(&jobs)?;
        let n = search.draws.first().map_or(0, Vec::len);
        let against = Against {
            layouts: &self.layouts,
            baseline: runs
                .iter()
                .map(|runs| runs[..n].iter().map(Option::as_ref).collect())
                .collect(),
            means: baseline.observed.conditions.iter().map(|one| &one.mean).collect(),
            spread: &baseline.spread,
            correlation,
        };
        Ok(Some(search.responses(self.bed_model, &records, &against)))
    }
}
