//! Curves of several runs at common places: forces over depth.

use measurements::{Curve, MeasurementSet, Run, Sample};

/// Most places that are compared; neighbours tell the same.
pub(crate) const PLACES: usize = 24;

/// Error that a reading is credited with where the set states none, over the greatest of the set.
const UNSTATED: f64 = 1e-3;

/// Readings at the same place to this share of the greatest are one, their mean.
const SAME: f64 = 1e-9;

/// Readings of all runs of a condition at the same places.
#[derive(Default)]
pub(crate) struct CommonCurve {
    /// Where (SI).
    pub(crate) at: Vec<f64>,
    /// Per run, per place (SI).
    pub(crate) values: Vec<Vec<f64>>,
    /// Stated standard deviation per place (SI).
    pub(crate) sigma: Vec<Option<f64>>,
}

impl CommonCurve {
    /// Of `runs`, on the way in: equally spaced over what all of them cover, no denser than their readings, and linear
    /// between these. Readings above the surface, and behind the deepest, are left out.
    pub(crate) fn of(runs: &[&Run]) -> Self {
        let ways: Vec<Vec<Sample>> = runs.iter().map(|run| way_in(&run.samples)).collect();
        let end = |of: fn(&[Sample]) -> Option<&Sample>| {
            ways.iter().filter_map(move |way| of(way)).map(|sample| sample.at)
        };
        let start = end(|way| way.first()).fold(0.0, f64::max);
        let stop = end(|way| way.last()).fold(f64::INFINITY, f64::min);
        let fewest = ways.iter().map(Vec::len).min().unwrap_or(0);
        if fewest < 2 || start >= stop {
            return Self::default();
        }
        let n = fewest.min(PLACES);
        let place = |k: usize| start + (stop - start) * k as f64 / (n - 1) as f64;
        let at: Vec<f64> = (0..n).map(place).collect();
        let sigma = at.iter().map(|&place| stated_sigma(&ways, place)).collect();
        let values = ways.iter().map(|way| interpolated(way, &at)).collect();
        Self { at, values, sigma }
    }
}

/// What was read below the surface up to the deepest place, in the order of depth; of readings at one place their mean.
fn way_in(samples: &[Sample]) -> Vec<Sample> {
    let deepest = samples.iter().enumerate().max_by(|a, b| a.1.at.total_cmp(&b.1.at));
    let Some((last, deepest)) = deepest else { return Vec::new() };
    let mut way: Vec<Sample> =
        samples[..=last].iter().filter(|sample| sample.at > 0.0).copied().collect();
    way.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.value.total_cmp(&b.value)));
    let near = SAME * deepest.at;
    let same = way.chunk_by(|a, b| b.at - a.at <= near);
    let mean = |readings: &[Sample]| {
        let n = readings.len() as f64;
        let sum = readings.iter().map(|one| one.value).sum::<f64>();
        Sample { value: sum / n, ..readings[0] }
    };
    same.map(mean).collect()
}

/// The values of `way`, two readings at least, at the places `at` within it.
fn interpolated(way: &[Sample], at: &[f64]) -> Vec<f64> {
    at.iter()
        .map(|&place| {
            let above = way.partition_point(|one| one.at < place).clamp(1, way.len() - 1);
            let [a, b] = [way[above - 1], way[above]];
            let share = ((place - a.at) / (b.at - a.at)).clamp(0.0, 1.0);
            a.value + share * (b.value - a.value)
        })
        .collect()
}

/// Root mean square of what the runs state for the reading nearest to `place`, if all state it.
fn stated_sigma(ways: &[Vec<Sample>], place: f64) -> Option<f64> {
    let mut sum = 0.0;
    for way in ways {
        let near = |one: &&Sample| (one.at - place).abs();
        sum += way.iter().min_by(|a, b| near(a).total_cmp(&near(b)))?.sigma?.powi(2);
    }
    Some((sum / ways.len() as f64).sqrt())
}

/// Root mean square error of one reading of `curve` (SI).
pub(crate) fn reading_error(set: &MeasurementSet, curve: &Curve) -> f64 {
    curve.stated_sigma(set).unwrap_or_else(|| {
        let values = set.runs.iter().flat_map(|run| &run.samples).map(|one| one.value.abs());
        let greatest = values.fold(0.0, f64::max);
        // Nothing was measured of a condition that is planned.
        if greatest > 0.0 { UNSTATED * greatest } else { UNSTATED }
    })
}

/// What the errors of readings count as, where the set does not state it.
pub(crate) fn note_readings(set: &MeasurementSet, curve: &Curve) -> Option<String> {
    let mut samples = set.runs.iter().flat_map(|run| &run.samples);
    let is_assumed =
        curve.stated_sigma(set).is_none() && samples.any(|sample| sample.sigma.is_none());
    is_assumed.then(|| {
        format!(
            "readings without a stated error count as known to {} {}, {} % of the greatest",
            crate::rounding::to_digits(curve.value.scale * reading_error(set, curve), 3),
            curve.value.unit,
            1e2 * UNSTATED
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::scalar_run;

    fn run(samples: &[[f64; 2]]) -> Run {
        let sample = |&[at, value]: &[f64; 2]| Sample { at, value, sigma: None };
        Run { samples: samples.iter().map(sample).collect(), ..scalar_run(0, [None; 3]) }
    }

    #[test]
    fn plateaus_are_averaged_and_the_way_back_is_left_out() {
        let one =
            run(&[[-1e-3, 0.0], [1e-3, 1.0], [2e-3, 1.5], [2e-3, 2.5], [4e-3, 4.0], [3e-3, 0.5]]);
        let other = run(&[[1e-3, 3.0], [2e-3, 4.0], [5e-3, 7.0]]);
        let common = CommonCurve::of(&[&one, &other]);
        // Three readings each: from 1 mm to 4 mm in two steps.
        let expected = [[1.0, 2.5, 4.0], [3.0, 4.5, 6.0]];
        for (found, expected) in common.values.iter().zip(expected) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
        assert_eq!((common.at.len(), common.values.len()), (3, 2));
    }

    #[test]
    fn runs_without_a_common_way_give_nothing() {
        let (one, other) = (run(&[[1e-3, 1.0], [2e-3, 2.0]]), run(&[[3e-3, 1.0], [4e-3, 2.0]]));
        assert!(CommonCurve::of(&[&one, &other]).at.is_empty());
    }
}
