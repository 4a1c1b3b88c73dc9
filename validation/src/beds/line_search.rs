//! A leading switch alone, at several amplitudes, from the model as it stands.

use nalgebra::{DVector, Matrix2, Vector2};

use super::emulator::Response;
use super::job::Job;
use super::record::Record;
use super::stand::{Draw, Stand, StandError};
use super::switches::Switch;
use crate::measurement::Condition;
use crate::observable::Layout;

/// Amplitudes in that of the guess.
const SHARES: [f64; 3] = [0.5, 1.0, 1.5];

/// A guess below this share of the amplitude that was screened is searched around that share.
const LEAST: f64 = 0.2;

/// How many impacts a search takes per draw and condition.
pub(super) const AMPLITUDES: usize = SHARES.len();

/// One search.
pub(super) struct LineSearch<'a> {
    pub(super) switch: &'static Switch,
    pub(super) amplitudes: Vec<f64>,
    pub(super) conditions: &'a [usize],
    pub(super) draws: &'a [Draw],
}

/// What a line search holds its runs against.
pub(super) struct Against<'a> {
    pub(super) layouts: &'a [Layout],
    /// Baseline runs per condition and draw of the search, none where one did not end.
    pub(super) baseline: Vec<Vec<Option<&'a Record>>>,
    /// Means of the baseline per condition of the set.
    pub(super) means: Vec<&'a DVector<f64>>,
    /// Correlation of runs on one draw.
    pub(super) correlation: f64,
    /// Whether runs are held against the baseline on their own draw.
    pub(super) paired: bool,
}

impl<'a> LineSearch<'a> {
    /// Around the amplitude `guess`.
    pub(super) fn around(
        switch: &'static Switch,
        guess: f64,
        conditions: &'a [usize],
        draws: &'a [Draw],
    ) -> Self {
        let size = guess.abs().max(LEAST * switch.screen);
        let guess = if guess < 0.0 { -size } else { size };
        let (min, max) = switch.range;
        let mut amplitudes: Vec<f64> =
            SHARES.iter().map(|share| (share * guess).clamp(min, max)).collect();
        amplitudes.dedup();
        Self { switch, amplitudes, conditions, draws }
    }

    /// At the amplitude that is screened, alone.
    pub(super) fn once(
        switch: &'static Switch,
        conditions: &'a [usize],
        draws: &'a [Draw],
    ) -> Self {
        Self { switch, amplitudes: vec![switch.screen], conditions, draws }
    }

    /// Largest amplitude of either sign, or zero.
    pub(super) fn tried(&self) -> (f64, f64) {
        let least = self.amplitudes.iter().fold(0.0_f64, |least, q| least.min(*q));
        let most = self.amplitudes.iter().fold(0.0_f64, |most, q| most.max(*q));
        (least, most)
    }

    /// The impacts: condition after condition, draw after draw, amplitude after amplitude.
    pub(super) fn jobs(&self, stand: &Stand<'_>) -> Result<Vec<Job>, StandError> {
        let mut jobs = Vec::new();
        for &condition in self.conditions {
            for &draw in self.draws {
                for &q in &self.amplitudes {
                    let variation = self.switch.change(stand.grains(), q);
                    jobs.push(stand.job(condition, draw, &variation)?);
                }
            }
        }
        Ok(jobs)
    }

    /// The response of every condition of the set, by least squares in q and q².
    pub(super) fn responses(
        &self,
        stand: &Stand<'_>,
        records: &[Option<Record>],
        against: &Against<'_>,
    ) -> Vec<Option<Response>> {
        let mut responses = vec![None; against.layouts.len()];
        let per_condition = self.draws.len() * self.amplitudes.len();
        for (at, &condition) in self.conditions.iter().enumerate() {
            let records = &records[at * per_condition..(at + 1) * per_condition];
            let of_set = (&stand.set.conditions[condition], stand);
            let found = self.differences((at, condition), of_set, records, against);
            let baseline = against.baseline[at].len().max(1) as f64;
            responses[condition] = quadratic(&found, against.noise(baseline));
        }
        responses
    }

    /// Amplitudes and differences from the baseline.
    fn differences(
        &self,
        (at, condition): (usize, usize),
        (of_set, stand): (&Condition, &Stand<'_>),
        records: &[Option<Record>],
        against: &Against<'_>,
    ) -> Vec<(f64, DVector<f64>)> {
        let numbers =
            |record: &Record| record.observables(&against.layouts[condition], of_set, stand.set);
        let mut found = Vec::new();
        let n = self.amplitudes.len();
        for (draw, records) in records.chunks(n).enumerate() {
            let own = against.baseline[at].get(draw).copied().flatten().filter(|_| against.paired);
            let base = own.map_or_else(|| against.means[condition].clone(), numbers);
            let ended = self.amplitudes.iter().zip(records);
            found.extend(
                ended.filter_map(|(&q, record)| Some((q, numbers(record.as_ref()?) - &base))),
            );
        }
        found
    }
}

impl Against<'_> {
    /// Variance of a difference, in that of a run, where the baseline has so many runs.
    fn noise(&self, baseline: f64) -> f64 {
        if self.paired { 2.0 * (1.0 - self.correlation) } else { 1.0 + 1.0 / baseline }
    }
}

/// slope q + curvature q² through `found`, whose differences scatter by `noise` times the covariance of a
/// run; a straight line where there is one amplitude, none where there is nothing.
fn quadratic(found: &[(f64, DVector<f64>)], noise: f64) -> Option<Response> {
    let first = &found.first()?.1;
    let mut gram = Matrix2::zeros();
    let (mut once, mut twice) = (DVector::zeros(first.len()), DVector::zeros(first.len()));
    for (q, difference) in found {
        let powers = Vector2::new(*q, q * q);
        gram += powers * powers.transpose();
        once += *q * difference;
        twice += (q * q) * difference;
    }
    let several = found.iter().any(|(q, _)| q.to_bits() != found[0].0.to_bits());
    let Some(inverse) = gram.try_inverse().filter(|_| several) else {
        let square = gram[(0, 0)];
        let variance = [[noise / square, 0.0], [0.0, 0.0]];
        return Some(Response { slope: once / square, curvature: first.map(|_| 0.0), variance });
    };
    let mix = |row: usize| inverse[(row, 0)] * &once + inverse[(row, 1)] * &twice;
    let entry = |i, j| noise * inverse[(i, j)];
    let variance = [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]];
    Some(Response { slope: mix(0), curvature: mix(1), variance })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_through_nothing_is_found_and_a_single_amplitude_gives_a_line() {
        let value = |q: f64| DVector::from_vec(vec![2.0 * q - q * q, -q]);
        let found: Vec<_> = [0.1, 0.2, 0.3, 0.1].iter().map(|&q| (q, value(q))).collect();
        let response = quadratic(&found, 1.0).unwrap();
        // The normal equations of three amplitudes of 0.1 lose four digits.
        assert!((response.slope - DVector::from_vec(vec![2.0, -1.0])).amax() < 1e-11);
        assert!((response.curvature - DVector::from_vec(vec![-1.0, 0.0])).amax() < 1e-10);
        let single = quadratic(&found[..1], 1.0).unwrap();
        assert!((single.slope[1] + 1.0).abs() < 1e-14 && single.curvature.amax() < 1e-300);
        assert!((single.variance[0][0] - 100.0).abs() < 1e-11);
        assert!(quadratic(&[], 1.0).is_none());
    }
}
