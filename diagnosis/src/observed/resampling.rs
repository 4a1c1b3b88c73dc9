//! Trajectories of several runs at common times.

use measurements::{Frame, median};
use runner::beds::STOPPED;

/// Times that agree to this (s) are the same frame.
const SAME_TIME: f64 = 1e-7;

/// Median steps between frames beyond which nothing is known of the path between two.
const GAP: f64 = 2.5;

/// Least share of the times that may be left between gaps; with fewer, the frames are irregular throughout.
const LEAST_LEFT: f64 = 0.25;

/// Frames on each side over which a speed is taken: neighbouring frames differ by little more than
/// their noise.
const HALF_WINDOW: usize = 3;

/// Times (s) at which all `tracks` have readings: the mean times of the frames themselves where they
/// agree, else equally spaced over what all cover, at the median spacing of frames, and no more of
/// them than the longest track has frames.
fn common_grid(tracks: &[&[Frame]]) -> Vec<f64> {
    let start = tracks.iter().filter_map(|t| t.first()).fold(f64::MIN, |s, f| s.max(f.t));
    let end = tracks.iter().filter_map(|t| t.last()).fold(f64::MAX, |e, f| e.min(f.t));
    let inside = |track: &&[Frame]| -> Vec<f64> {
        let times = track.iter().map(|frame| frame.t);
        times.filter(|t| *t >= start - SAME_TIME && *t <= end + SAME_TIME).collect()
    };
    if let Some(grid) = mean_times(&tracks.iter().map(inside).collect::<Vec<_>>()) {
        return grid;
    }
    let pairs = tracks.iter().flat_map(|track| track.windows(2));
    let Some(step) = median(pairs.map(|pair| pair[1].t - pair[0].t)) else { return Vec::new() };
    if end <= start || step <= 0.0 {
        return Vec::new();
    }
    // One reading long after the others must not fill the gap with interpolated ones.
    let most = tracks.iter().map(|track| track.len()).max().unwrap_or(0);
    let n = (((end - start) / step).floor() as usize).saturating_add(1).min(most);
    (0..n).map(|k| start + k as f64 * step).collect()
}

/// The times of [`common_grid`] outside gaps of any track, and where no track is on either side of first contact.
pub(crate) fn seen_grid(tracks: &[&[Frame]]) -> Vec<f64> {
    let all = common_grid(tracks);
    let Some(step) = median(all.windows(2).map(|pair| pair[1] - pair[0])) else { return all };
    let is_seen = |time: &&f64| tracks.iter().all(|track| !is_in_a_gap(track, **time, GAP * step));
    let seen: Vec<f64> = all.iter().filter(is_seen).copied().collect();
    if seen.len() as f64 >= LEAST_LEFT * all.len() as f64 { seen } else { all }
}

/// Whether `time` lies between two frames of `track` that are more than `longest` (s) apart, or on either side of first
/// contact, where the acceleration jumps.
fn is_in_a_gap(track: &[Frame], time: f64, longest: f64) -> bool {
    let behind = track.partition_point(|frame| frame.t < time - SAME_TIME);
    match (behind.checked_sub(1).and_then(|before| track.get(before)), track.get(behind)) {
        (Some(a), Some(b)) => {
            b.t - time > SAME_TIME && (b.t - a.t > longest || !is_on_one_side(&[*a, *b]))
        }
        _ => false,
    }
}

/// Mean of the k-th times (s) of all `tracks`; `None` if any two are not the same.
fn mean_times(tracks: &[Vec<f64>]) -> Option<Vec<f64>> {
    let n = tracks.first().map_or(0, Vec::len);
    if tracks.iter().any(|times| times.len() != n) {
        return None;
    }
    let mean = |k: usize| {
        // Sorted, so that the sum has the same bits in whichever order the runs come.
        let mut times: Vec<f64> = tracks.iter().map(|times| times[k]).collect();
        times.sort_by(f64::total_cmp);
        let same = times[times.len() - 1] - times[0] < SAME_TIME;
        same.then(|| times.iter().sum::<f64>() / times.len() as f64)
    };
    (0..n).map(mean).collect()
}

/// Depth and range (m) of `track` at the times of `grid`: between frames on the cubic through four near ones on the same
/// side of first contact, which a slow camera needs; on the line between two where there are no such four.
pub(crate) fn depth_and_range(track: &[Frame], grid: &[f64]) -> Vec<(f64, f64)> {
    read(track, grid, |at| {
        let mut four = [1, 0, 2].into_iter().filter_map(|before| {
            let first = at.checked_sub(before)?;
            track.get(first..first + 4).filter(|four| is_even(four) && is_on_one_side(four))
        });
        four.next().unwrap_or(&track[at..at + 2])
    })
}

/// What `track` holds in place of depths at the times of `grid`, linear between frames: a curve may jump.
pub(crate) fn on_lines(track: &[Frame], grid: &[f64]) -> Vec<f64> {
    read(track, grid, |at| &track[at..at + 2]).into_iter().map(|one| one.0).collect()
}

/// Depth and range (m) at the times of `grid`, on the polynomial through the frames that `near` gives for the last frame
/// before a time.
fn read<'a>(
    track: &'a [Frame],
    grid: &[f64],
    near: impl Fn(usize) -> &'a [Frame],
) -> Vec<(f64, f64)> {
    let mut at = 0;
    grid.iter()
        .map(|&time| {
            while at + 2 < track.len() && track[at + 1].t <= time + SAME_TIME {
                at += 1;
            }
            let (a, b) = (&track[at], &track[at + 1]);
            if (a.t - time).abs() < SAME_TIME {
                return (a.z, a.x);
            }
            if (b.t - time).abs() < SAME_TIME {
                return (b.z, b.x);
            }
            let near = near(at);
            let weight = |own: usize| -> f64 {
                let others = (0..near.len()).filter(|&other| other != own);
                others.map(|other| (time - near[other].t) / (near[own].t - near[other].t)).product()
            };
            near.iter().enumerate().fold((0.0, 0.0), |(z, x), (own, frame)| {
                (z + weight(own) * frame.z, x + weight(own) * frame.x)
            })
        })
        .collect()
}

/// Whether the steps between `frames` are alike: a cubic through others magnifies their errors.
fn is_even(frames: &[Frame]) -> bool {
    let steps = || frames.windows(2).map(|pair| pair[1].t - pair[0].t);
    let least = steps().fold(f64::INFINITY, f64::min);
    steps().all(|step| step <= GAP * least)
}

/// Whether all `frames` are before first contact, or all are behind it.
fn is_on_one_side(frames: &[Frame]) -> bool {
    frames.iter().all(|frame| frame.t <= SAME_TIME)
        || frames.iter().all(|frame| frame.t >= -SAME_TIME)
}

/// How many frames of `grid` lie before the speed first falls below 5 % of `speed` (m/s), or of the
/// greatest since, for an intruder that is let go from rest.
pub(crate) fn stopped_at(grid: &[f64], mean: &[(f64, f64)], speed: f64) -> usize {
    let speed_at = |at: usize| {
        let window = at.saturating_sub(HALF_WINDOW)..(at + HALF_WINDOW + 1).min(grid.len());
        let velocity =
            |part: fn(&(f64, f64)) -> f64| slope(window.clone().map(|k| (grid[k], part(&mean[k]))));
        libm::hypot(velocity(|m| m.0), velocity(|m| m.1))
    };
    let mut greatest = speed;
    for at in (0..grid.len()).filter(|&at| grid[at] > 0.0) {
        let now = speed_at(at);
        if now < STOPPED * greatest {
            return at;
        }
        greatest = greatest.max(now);
    }
    grid.len()
}

/// Slope of the least-squares line through `points`.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let n = points.clone().count() as f64;
    let (t, y) = points.clone().fold((0.0, 0.0), |(t, y), (a, b)| (t + a / n, y + b / n));
    let (top, bottom) = points.fold((0.0, 0.0), |(top, bottom), (a, b)| {
        (top + (a - t) * (b - y), bottom + (a - t).powi(2))
    });
    if bottom > 0.0 { top / bottom } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_between_slow_frames_is_the_curve_and_not_its_chords() {
        let depth = |t: f64| 2.0 * t - 30.0 * t * t + 100.0 * t * t * t;
        let frames: Vec<Frame> = (0..8)
            .map(|at| f64::from(at) / 120.0)
            .map(|t| Frame { t, z: depth(t), x: -depth(t), sigma: None })
            .collect();
        let grid: Vec<f64> = (2..12).map(|at| f64::from(at) / 240.0).collect();
        for (t, (z, x)) in grid.iter().zip(depth_and_range(&frames, &grid)) {
            assert!((z - depth(*t)).abs() < 1e-12 && (z + x).abs() < 1e-12, "{t}: {z}");
        }
        // Contact, where the acceleration jumps, is on the path of neither side.
        let depth = |t: f64| 2.0 * t - 30.0 * t * t.max(0.0);
        let fall = |at: i32| f64::from(at) / 120.0 - 0.03;
        let frames: Vec<Frame> =
            (0..10).map(fall).map(|t| Frame { t, z: depth(t), x: 0.0, sigma: None }).collect();
        let other: Vec<Frame> = frames
            .iter()
            .map(|one| Frame { t: one.t + 4e-3, z: depth(one.t + 4e-3), ..*one })
            .collect();
        let grid = seen_grid(&[&frames, &other]);
        for (t, (z, _)) in grid.iter().zip(depth_and_range(&frames, &grid)) {
            assert!((z - depth(*t)).abs() < 1e-12, "{t}: {z}");
        }
        // Nothing is made up where the body is not seen.
        let is_seen = |frame: &&Frame| !(0.02..0.04).contains(&frame.t);
        let frames: Vec<Frame> = (0..8)
            .map(|at| f64::from(at) / 120.0)
            .map(|t| Frame { t, z: depth(t), x: 0.0, sigma: None })
            .collect();
        let gap: Vec<Frame> = frames.iter().filter(is_seen).copied().collect();
        let other: Vec<Frame> =
            frames.iter().map(|one| Frame { t: one.t + 1e-3, ..*one }).collect();
        let grid = seen_grid(&[&gap, &other]);
        assert!(grid.len() >= 2 && grid.iter().all(|t| !(0.017..0.041).contains(t)), "{grid:?}");
    }

    fn track(times: &[f64]) -> Vec<Frame> {
        times.iter().map(|&t| Frame { t, z: t, x: 0.0, sigma: None }).collect()
    }

    #[test]
    fn the_grid_does_not_depend_on_which_run_comes_first() {
        let tracks = [[0.0, 0.1, 0.2], [3e-8, 0.1 + 7e-8, 0.2], [1e-8, 0.1, 0.2 + 9e-8]];
        let [a, b, c] = tracks.map(|times| track(&times));
        let grid = common_grid(&[&a, &b, &c]);
        assert_eq!(grid.len(), 3);
        for order in [[&b, &c, &a], [&c, &b, &a], [&b, &a, &c]] {
            assert_eq!(common_grid(&order.map(Vec::as_slice)), grid);
        }
    }

    #[test]
    fn a_reading_long_after_the_others_does_not_blow_up_the_grid() {
        let (a, b) = (track(&[0.0, 1e-3, 2e-3, 1e9]), track(&[0.0, 1.5e-3, 2.5e-3, 1e9]));
        assert_eq!(common_grid(&[&a, &b]).len(), 4);
    }
}
