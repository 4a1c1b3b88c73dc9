//! A leading candidate alone, at several amplitudes, from the model as it stands.

use measurements::Condition;
use nalgebra::{DMatrix, DVector};
use runner::beds::Job;
use runner::beds::Record;

use super::bed_candidate::BedCandidate;
use super::bed_model::{BedModel, BedModelError, Draw};
use super::observables::observables;
use super::response::{BetweenDraws, Line, Response, deviations};
use crate::forward::observable::Layout;

/// Amplitudes in that of the guess.
const SHARES: [f64; 3] = [0.5, 1.0, 1.5];

/// A guess below this share of the amplitude that was screened is searched around that share.
const LEAST: f64 = 0.2;

/// How many impacts a search takes per draw and condition.
pub(super) const AMPLITUDES: usize = SHARES.len();

/// One search.
pub(super) struct LineSearch<'a> {
    pub(super) bed_candidate: &'static BedCandidate,
    pub(super) amplitudes: Vec<f64>,
    pub(super) conditions: &'a [usize],
    /// One list per condition.
    pub(super) draws: &'a [Vec<Draw>],
}

/// What a line search holds its runs against.
pub(super) struct Against<'a> {
    pub(super) layouts: &'a [Layout],
    /// Baseline runs per condition and draw of the search, none where one did not end.
    pub(super) baseline: Vec<Vec<Option<&'a Record>>>,
    /// Means of the baseline per condition of the set.
    pub(super) means: Vec<&'a DVector<f64>>,
    /// Covariance of a run per condition of the set.
    pub(super) spread: &'a [DMatrix<f64>],
    /// Correlation of runs on one draw.
    pub(super) correlation: f64,
}

impl<'a> LineSearch<'a> {
    /// Around the amplitude `guess`.
    pub(super) fn around(
        bed_candidate: &'static BedCandidate,
        guess: f64,
        conditions: &'a [usize],
        draws: &'a [Vec<Draw>],
    ) -> Self {
        let size = guess.abs().max(LEAST * bed_candidate.screen);
        let guess = if guess < 0.0 { -size } else { size };
        let (min, max) = bed_candidate.range;
        let mut amplitudes: Vec<f64> =
            SHARES.iter().map(|share| (share * guess).clamp(min, max)).collect();
        amplitudes.dedup();
        Self { bed_candidate, amplitudes, conditions, draws }
    }

    /// At the amplitude that is screened, alone.
    pub(super) fn once(
        bed_candidate: &'static BedCandidate,
        conditions: &'a [usize],
        draws: &'a [Vec<Draw>],
    ) -> Self {
        Self { bed_candidate, amplitudes: vec![bed_candidate.screen], conditions, draws }
    }

    /// Largest amplitude of either sign, or zero.
    pub(super) fn tried(&self) -> (f64, f64) {
        let least = self.amplitudes.iter().fold(0.0_f64, |least, q| least.min(*q));
        let most = self.amplitudes.iter().fold(0.0_f64, |most, q| most.max(*q));
        (least, most)
    }

    /// The impacts: condition after condition, draw after draw, amplitude after amplitude.
    pub(super) fn jobs(&self, bed_model: &BedModel<'_>) -> Result<Vec<Job>, BedModelError> {
        let mut jobs = Vec::new();
        for (&condition, draws) in self.conditions.iter().zip(self.draws) {
            for &draw in draws {
                for &q in &self.amplitudes {
                    let variation = self.bed_candidate.change(bed_model.grains(), q);
                    jobs.push(bed_model.job(condition, draw, &variation)?);
                }
            }
        }
        Ok(jobs)
    }

    /// The response of every condition of the set, by least squares in q and q²: held against the baseline on the
    /// same draw, or against its mean, whichever makes draws agree better. Another friction leaves a bed what
    /// it is; another preparation makes another one of the same seed.
    pub(super) fn responses(
        &self,
        bed_model: &BedModel<'_>,
        records: &[Option<Record>],
        against: &Against<'_>,
    ) -> Vec<Option<Response>> {
        let [on_draws, on_means] =
            [true, false].map(|paired| self.held_against(bed_model, records, (against, paired)));
        if on_draws.1 < on_means.1 { on_draws.0 } else { on_means.0 }
    }

    /// The response of every condition, and how much the largest amplitude scatters, in the variance of a run.
    fn held_against(
        &self,
        bed_model: &BedModel<'_>,
        records: &[Option<Record>],
        (against, paired): (&Against<'_>, bool),
    ) -> (Vec<Option<Response>>, f64) {
        let n_draws = self.draws.first().map_or(0, Vec::len);
        let per_condition = n_draws * self.amplitudes.len();
        let mut found = Vec::with_capacity(self.conditions.len());
        let mut scatter = BetweenDraws::default();
        for (at, &condition) in self.conditions.iter().enumerate() {
            let records = &records[at * per_condition..(at + 1) * per_condition];
            let of_set = (&bed_model.set.conditions[condition], bed_model);
            let by_draw = self.differences((at, condition), of_set, records, (against, paired));
            let whole = by_draw.iter().filter(|found| found.len() == self.amplitudes.len());
            let each: Vec<Line> = whole.filter_map(|found| Line::through(found)).collect();
            let deviations = deviations(&each);
            scatter.learn(&deviations, &against.spread[condition]);
            found.push((at, by_draw.concat(), deviations));
        }
        let mut responses = vec![None; against.layouts.len()];
        let (least, most) = self.tried();
        let largest = if most > -least { most } else { least };
        let mut whole = 0.0;
        for (at, found, deviations) in found {
            responses[self.conditions[at]] = Line::through(&found).map(|line| {
                let expected = line.inverse * against.noise(at, paired);
                let variance = scatter.of_mean(expected, deviations.len());
                let [slope, curvature] = line.terms;
                let response = Response { slope, curvature, variance, deviations };
                whole += response.variance_at(largest);
                response
            });
        }
        (responses, whole)
    }

    /// Amplitudes and differences from the baseline, draw by draw.
    fn differences(
        &self,
        (at, condition): (usize, usize),
        (of_set, bed_model): (&Condition, &BedModel<'_>),
        records: &[Option<Record>],
        (against, paired): (&Against<'_>, bool),
    ) -> Vec<Vec<(f64, DVector<f64>)>> {
        let numbers = |record: &Record| {
            observables(record, &against.layouts[condition], of_set, bed_model.set)
        };
        let of_draw = |(draw, records): (usize, &[Option<Record>])| {
            let own = against.baseline[at].get(draw).copied().flatten().filter(|_| paired);
            let base = own.map_or_else(|| against.means[condition].clone(), numbers);
            let ended = self.amplitudes.iter().zip(records);
            ended.filter_map(|(&q, record)| Some((q, numbers(record.as_ref()?) - &base))).collect()
        };
        records.chunks(self.amplitudes.len()).enumerate().map(of_draw).collect()
    }
}

impl Against<'_> {
    /// Variance of a difference from the run on the same draw, or else from the mean of all, under the condition
    /// at place `at` of the search, in that of a run.
    fn noise(&self, at: usize, paired: bool) -> f64 {
        let runs = self.baseline[at].len().max(1) as f64;
        if paired { 2.0 * (1.0 - self.correlation) } else { 1.0 + 1.0 / runs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beds::BED_CANDIDATES;
    use crate::test_sets;
    use configs::{LoadOptions, Model, ModelSource, find_shipped};
    use measurements::{FinalDefinition, Geometry, Kind};

    /// Depths (mm) of the model as it stands, on four beds.
    const BEDS: [f64; 4] = [29.0, 31.0, 29.0, 31.0];

    fn record(depth_mm: f64) -> Record {
        Record {
            interval: 1e-3,
            contact_height: 0.0,
            depth: vec![0.0],
            range: vec![0.0],
            force: Vec::new(),
            stopping_time: None,
            slow_time: None,
            deepest: 1e-3 * depth_mm,
            reached: 0.0,
            end: 0.1,
            crater: None,
            impact_energy: 1.0,
            closure: 0.0,
            ledger: Vec::new(),
            grains: 1,
            steps: 1,
            wall: 0.0,
        }
    }

    /// The response at the amplitude that is screened (mm), and its variance in that of a run, where the candidate
    /// makes depths `with` (mm) of [`BEDS`].
    fn found(with: [f64; 4]) -> (f64, f64) {
        let shipped = ModelSource::Shipped(find_shipped("vertical-2d").unwrap());
        let model = Model::load(shipped, &LoadOptions::default()).unwrap().model;
        let one = test_sets::condition(1.0, 90.0);
        let mut set = test_sets::set(Kind::Scalar, vec![one], Vec::new());
        set.bed.geometry = Geometry::Planar;
        set.last = FinalDefinition::Deepest;
        let bed_model = BedModel::new(&model, &set).unwrap();
        let layouts =
            vec![Layout { final_z: true, ..Layout::default() }; bed_model.set.conditions.len()];
        let (conditions, draws) = ([0], bed_model.draws(0, BEDS.len(), 1));
        let search = LineSearch::once(&BED_CANDIDATES[0], &conditions, &draws);
        let (baseline, mean) = (BEDS.map(record), DVector::from_element(1, 0.030));
        let against = Against {
            layouts: &layouts,
            baseline: vec![baseline.iter().map(Some).collect()],
            means: vec![&mean; layouts.len()],
            spread: &vec![DMatrix::from_element(1, 1, 1e-6); layouts.len()],
            correlation: 0.8,
        };
        let responses =
            search.responses(&bed_model, &with.map(|depth| Some(record(depth))), &against);
        let response = responses[0].as_ref().unwrap();
        let q = BED_CANDIDATES[0].screen;
        (1e3 * response.at(q)[0], response.variance_at(q))
    }

    #[test]
    fn runs_on_the_same_beds_are_held_against_each_other_and_runs_on_others_against_the_mean() {
        let (size, variance) = found([34.0, 36.0, 34.0, 36.0]);
        assert!((size - 5.0).abs() < 1e-9 && variance < 1e-12, "{size} {variance}");
        // Depths of 36, 34, 34 and 36 mm: a variance of 4/3 mm², of the mean of four of 1/3. Differences from the
        // runs of the same number would have twice that.
        let (size, variance) = found([36.0, 34.0, 34.0, 36.0]);
        assert!((size - 5.0).abs() < 1e-9 && (variance - 1.0 / 3.0).abs() < 1e-9, "{variance}");
    }
}
