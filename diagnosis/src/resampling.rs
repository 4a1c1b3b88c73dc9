//! Trajectories of several runs at common times.

use measurements::Frame;
use runner::beds::STOPPED;

/// Times that agree to this (s) are the same frame.
const SAME_TIME: f64 = 1e-7;

/// Frames on each side over which a speed is taken: neighbouring frames differ by little more than
/// their noise.
const HALF_WINDOW: usize = 3;

/// Times (s) at which all `tracks` have readings: the mean times of the frames themselves where they
/// agree, else equally spaced over what all cover, at the median spacing of frames, and no more of
/// them than the longest track has frames.
#[must_use]
pub(crate) fn common_grid(tracks: &[&[Frame]]) -> Vec<f64> {
    let start = tracks.iter().filter_map(|t| t.first()).fold(f64::MIN, |s, f| s.max(f.t));
    let end = tracks.iter().filter_map(|t| t.last()).fold(f64::MAX, |e, f| e.min(f.t));
    let inside = |track: &&[Frame]| -> Vec<f64> {
        let times = track.iter().map(|frame| frame.t);
        times.filter(|t| *t >= start - SAME_TIME && *t <= end + SAME_TIME).collect()
    };
    if let Some(grid) = mean_times(&tracks.iter().map(inside).collect::<Vec<_>>()) {
        return grid;
    }
    let mut steps: Vec<f64> = tracks
        .iter()
        .flat_map(|track| track.windows(2).map(|pair| pair[1].t - pair[0].t))
        .collect();
    steps.sort_by(f64::total_cmp);
    let Some(&step) = steps.get(steps.len() / 2) else { return Vec::new() };
    if end <= start || step <= 0.0 {
        return Vec::new();
    }
    // One reading long after the others must not fill the gap with interpolated ones.
    let most = tracks.iter().map(|track| track.len()).max().unwrap_or(0);
    let n = (((end - start) / step).floor() as usize).saturating_add(1).min(most);
    (0..n).map(|k| start + k as f64 * step).collect()
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

/// Depth and range (m) of `track` at the times of `grid`, linear between frames.
#[must_use]
pub(crate) fn depth_and_range(track: &[Frame], grid: &[f64]) -> Vec<(f64, f64)> {
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
            let share = (time - a.t) / (b.t - a.t);
            (a.z + share * (b.z - a.z), a.x + share * (b.x - a.x))
        })
        .collect()
}

/// How many frames of `grid` lie before the speed first falls below 5 % of `speed` (m/s), or of the
/// greatest since, for an intruder that is let go from rest.
#[must_use]
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
