//! Curves of several runs at common places: forces over depth, accelerations over time.

use measurements::{Along, Condition, Curve, Frame, Kind, MeasurementSet, Run, Sample, median};

use crate::observed::resampling::{depth_and_range, on_lines, seen_grid};
use crate::observed::series::{evenly, stated_sigma};

/// Most places that are compared; neighbours tell the same.
pub(crate) const PLACES: usize = 24;

/// Error that a reading is credited with where the set states none, over the greatest of the set.
const UNSTATED: f64 = 1e-3;

/// Most times before contact that are compared, and fewest readings of a run of an accelerometer.
const FLIGHT: usize = 6;
const FEWEST: usize = 3;

/// Share of the time to the stop up to which accelerations are compared: at the stop they jump.
const BEFORE_STOP: f64 = 0.9;

/// Share of the speed at contact that counts as stopped.
const STOPPED: f64 = 0.05;

/// Share of a record, at its end, over which the velocity of a body at rest is constant.
const AT_REST: f64 = 0.25;

/// Readings so many steps beside the contact are left out, and those beyond this share of the range.
const BESIDE: f64 = 1.5;
const WITHIN: f64 = 0.99;

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
    /// Of `runs` under `condition`, as the kind of `set` has them.
    pub(crate) fn of(set: &MeasurementSet, condition: &Condition, runs: &[&Run]) -> Self {
        match set.kind.curve().map(|curve| curve.along) {
            Some(Along::Time) => Self::over_time(set, condition, runs),
            _ => Self::over_depth(runs),
        }
    }

    /// Of `runs` over time, at common times: some before contact, and up to the stop less a tenth of the way there. Left
    /// out are times at which any accelerometer is beyond its range, and those at which a run is read on either side of
    /// the contact, where a curve bends or jumps.
    fn over_time(set: &MeasurementSet, condition: &Condition, runs: &[&Run]) -> Self {
        let frame = |one: &Sample| Frame { t: one.at, z: one.value, x: 0.0, sigma: one.sigma };
        let tracks: Vec<Vec<Frame>> =
            runs.iter().map(|run| run.samples.iter().map(frame).collect()).collect();
        if tracks.iter().any(|track| track.len() < FEWEST) {
            return Self::default();
        }
        let each: Vec<&[Frame]> = tracks.iter().map(Vec::as_slice).collect();
        let grid = seen_grid(&each);
        let is_felt = set.kind == Kind::Acceleration;
        let range = set.instrument.acceleration_range.filter(|_| is_felt).unwrap_or(f64::INFINITY);
        let is_seen = |value: f64| value.abs() < WITHIN * range;
        let is_clipped = tracks.iter().flatten().any(|frame| !is_seen(frame.z));
        // A cubic through readings that are cut off swings beside them.
        let between = |track: &&[Frame]| match is_clipped {
            true => on_lines(track, &grid),
            false => depth_and_range(track, &grid).into_iter().map(|one| one.0).collect(),
        };
        let values: Vec<Vec<f64>> = each.iter().map(between).collect();
        let n = values.len() as f64;
        let mean: Vec<f64> =
            (0..grid.len()).map(|at| values.iter().map(|run| run[at]).sum::<f64>() / n).collect();
        let step = median(grid.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(0.0);
        let is_kept = |at: &usize| {
            let all_seen = values.iter().all(|run| is_seen(run[*at]));
            all_seen && (!is_felt || grid[*at].abs() > BESIDE * step)
        };
        let known = (condition.speed, set.bed_of(condition).gravity);
        let stop = BEFORE_STOP * stopped((set.kind, is_clipped), &grid, &mean, known);
        let (before, after): (Vec<usize>, Vec<usize>) = (0..grid.len())
            .filter(is_kept)
            .filter(|&at| grid[at] <= stop)
            .partition(|&at| grid[at] < 0.0);
        let mut kept: Vec<usize> =
            evenly(before.len(), FLIGHT).into_iter().map(|at| before[at]).collect();
        kept.extend(evenly(after.len(), PLACES).into_iter().map(|at| after[at]));
        let sigma =
            |&at: &usize| stated_sigma(runs.iter().map(|run| stated(&run.samples)), grid[at]);
        Self {
            sigma: kept.iter().map(sigma).collect(),
            values: values.iter().map(|run| kept.iter().map(|&at| run[at]).collect()).collect(),
            at: kept.iter().map(|&at| grid[at]).collect(),
        }
    }

    /// Of `runs`, on the way in: equally spaced over what all of them cover, no denser than their readings, and linear
    /// between these. Readings above the surface, and behind the deepest, are left out.
    fn over_depth(runs: &[&Run]) -> Self {
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
        let of_ways = || ways.iter().map(|way| stated(way));
        let sigma = at.iter().map(|&place| stated_sigma(of_ways(), place)).collect();
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

/// The place and the stated standard deviation of each reading.
fn stated(samples: &[Sample]) -> impl Iterator<Item = (f64, Option<f64>)> {
    samples.iter().map(|sample| (sample.at, sample.sigma))
}

/// Downward velocities (m/s) at times `at` (s) from contact on, at a speed (m/s), of what reads `felt` (m/s²) in
/// gravity (m/s²), and the ways (m).
fn fallen(at: &[f64], felt: &[f64], (speed, gravity): (f64, f64)) -> Vec<[f64; 3]> {
    let mut all: Vec<[f64; 3]> = Vec::new();
    let (mut time, mut velocity, mut way, mut before) = (0.0, speed, 0.0, 0.0);
    for (&t, &felt) in at.iter().zip(felt).filter(|(t, _)| **t > 0.0) {
        let step = t - time;
        let next = velocity + step * (gravity - 0.5 * (before + felt));
        way += 0.5 * step * (velocity + next);
        (time, velocity, before) = (t, next, felt);
        all.push([time, velocity, way]);
    }
    all
}

/// The way of a body at a speed (m/s) and in gravity (m/s²) whose `kind` of curve is `read` at the times `at` (s), as
/// [`fallen`]; `None` where it does not tell.
fn path(kind: Kind, at: &[f64], read: &[f64], known: (f64, f64)) -> Option<Vec<[f64; 3]>> {
    match kind {
        Kind::Acceleration => Some(fallen(at, read, known)),
        Kind::Velocity => {
            let (mut time, mut velocity, mut way) = (0.0, known.0, 0.0);
            let seen = at.iter().zip(read).filter(|(t, _)| **t > 0.0);
            let path = seen.map(|(&t, &next)| {
                way += 0.5 * (t - time) * (velocity + next);
                (time, velocity) = (t, next);
                [time, velocity, way]
            });
            Some(path.collect())
        }
        _ => None,
    }
}

/// When (s) the velocity falls below 5 % of the speed at contact; infinite where it does not, or is not known. If
/// the peak is clipped, the integral keeps a part of the speed: then a body rests if its velocity is constant over the last
/// quarter of the record.
fn stopped((kind, is_clipped): (Kind, bool), at: &[f64], read: &[f64], known: (f64, f64)) -> f64 {
    let path = path(kind, at, read, known).unwrap_or_default();
    let small = STOPPED * known.0;
    let rests = |&[end, last, _]: &[f64; 3]| {
        let is_late = |[t, ..]: &&[f64; 3]| *t >= (1.0 - AT_REST) * end;
        path.iter().filter(is_late).all(|[_, v, _]| (v - last).abs() < small)
    };
    let left = path.last().filter(|end| is_clipped && rests(end)).map_or(0.0, |[_, v, _]| *v);
    path.iter().find(|[_, v, _]| *v < left.max(0.0) + small).map_or(f64::INFINITY, |[t, ..]| *t)
}

/// How deep (m) a body comes whose `kind` of curve is `read` at the times `at` (s), from a speed (m/s) and in gravity
/// (m/s²); `None` where it does not tell.
pub(crate) fn way(kind: Kind, at: &[f64], read: &[f64], known: (f64, f64)) -> Option<f64> {
    let path = path(kind, at, read, known)?;
    let deepest = path.iter().fold(0.0_f64, |most, [.., way]| most.max(*way));
    Some(deepest.max(f64::MIN_POSITIVE))
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
            plots::rounded(curve.value.scale * reading_error(set, curve), 3),
            curve.value.unit,
            1e2 * UNSTATED
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set};

    fn run(samples: &[[f64; 2]]) -> Run {
        let sample = |&[at, value]: &[f64; 2]| Sample { at, value, sigma: None };
        Run { samples: samples.iter().map(sample).collect(), ..scalar_run(0, [None; 3]) }
    }

    #[test]
    fn plateaus_are_averaged_and_the_way_back_is_left_out() {
        let one =
            run(&[[-1e-3, 0.0], [1e-3, 1.0], [2e-3, 1.5], [2e-3, 2.5], [4e-3, 4.0], [3e-3, 0.5]]);
        let other = run(&[[1e-3, 3.0], [2e-3, 4.0], [5e-3, 7.0]]);
        let common = CommonCurve::over_depth(&[&one, &other]);
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
    fn runs_that_are_not_in_phase_are_read_on_the_curve_and_not_on_its_chords() {
        let condition = condition(3.0, 90.0);
        let velocity = |t: f64| if t < 0.0 { 3.0 + 9.81 * t } else { 3.0 / (1.0 + 40.0 * t) };
        let seen = |phase: f64| {
            let samples = (-8..40).map(|k| 2e-3 * (f64::from(k) + phase));
            let samples: Vec<[f64; 2]> = samples.map(|t| [t, velocity(t)]).collect();
            run(&samples)
        };
        let runs = [0.0, 0.37, 0.71].map(seen);
        let set = set(Kind::Velocity, vec![condition.clone()], runs.to_vec());
        let common = CommonCurve::over_time(&set, &condition, &runs.each_ref());
        assert!(common.at.len() > 20 && common.at[0] < 0.0, "{:?}", common.at);
        for values in &common.values {
            for (t, value) in common.at.iter().zip(values) {
                // On chords it is up to 5 mm/s behind the contact, and more across it.
                assert!((value - velocity(*t)).abs() < 1e-3, "{t}: {value}");
            }
        }
    }

    #[test]
    fn a_body_that_feels_a_constant_force_stops_when_and_where_it_must() {
        let at: Vec<f64> = (0..=200).map(|k| 1e-3 * f64::from(k)).collect();
        let felt = vec![30.0; at.len()];
        // 2 m/s less 20 m/s² from 1 ms on, on average: after 95 ms 5 % are left, on a way of 0.1 m to rest.
        let known = (2.0, 10.0);
        let way = way(Kind::Acceleration, &at, &felt, known).expect("a way");
        assert!((stopped((Kind::Acceleration, false), &at, &felt, known) - 0.0958).abs() < 1.5e-3);
        assert!((way / 0.1 - 1.0).abs() < 0.03);
    }

    #[test]
    fn a_body_stops_where_it_rests_if_the_peak_of_what_it_felt_is_cut_off() {
        let at: Vec<f64> = (0..=200).map(|k| 1e-3 * f64::from(k)).collect();
        // 2 m/s less 20 m/s² for 100 ms, then rest; beyond 25 m/s² nothing is read for 50 ms.
        let read = |t: &f64| match *t {
            t if t <= 0.05 => 25.0,
            t if t <= 0.1 => 30.0,
            _ => 10.0,
        };
        let felt: Vec<f64> = at.iter().map(read).collect();
        let known = (2.0, 10.0);
        assert!(stopped((Kind::Acceleration, false), &at, &felt, known).is_infinite());
        let stop = stopped((Kind::Acceleration, true), &at, &felt, known);
        assert!((stop - 0.095).abs() < 2e-3, "{stop}");
        // A record that ends on the way shows no rest.
        let on_the_way = stopped((Kind::Acceleration, true), &at[..80], &felt[..80], known);
        assert!(on_the_way.is_infinite());
    }

    #[test]
    fn runs_without_a_common_way_give_nothing() {
        let (one, other) = (run(&[[1e-3, 1.0], [2e-3, 2.0]]), run(&[[3e-3, 1.0], [4e-3, 2.0]]));
        assert!(CommonCurve::over_depth(&[&one, &other]).at.is_empty());
    }
}
