//! Trajectories of several runs at common times.

use crate::measurement::Frame;

/// Times that agree to this (s) are the same frame.
const SAME_TIME: f64 = 1e-7;

/// Share of the impact speed below which an intruder counts as stopped.
pub(crate) const STOPPED: f64 = 0.05;

/// Frames on each side over which a speed is taken: neighbouring frames differ by little more than
/// their noise.
const HALF_WINDOW: usize = 3;

/// Times (s) at which all `tracks` have readings: those of the frames themselves where they agree,
/// else equally spaced over what all cover, at the median spacing of frames.
#[must_use]
pub(crate) fn common_grid(tracks: &[&[Frame]]) -> Vec<f64> {
    let Some(first) = tracks.first() else { return Vec::new() };
    let start = tracks.iter().filter_map(|t| t.first()).fold(f64::MIN, |s, f| s.max(f.t));
    let end = tracks.iter().filter_map(|t| t.last()).fold(f64::MAX, |e, f| e.min(f.t));
    let inside = |track: &[Frame]| -> Vec<f64> {
        let times = track.iter().map(|frame| frame.t);
        times.filter(|t| *t >= start - SAME_TIME && *t <= end + SAME_TIME).collect()
    };
    let grid = inside(first);
    let agrees = |track: &&[Frame]| {
        let times = inside(track);
        times.len() == grid.len() && times.iter().zip(&grid).all(|(a, b)| (a - b).abs() < SAME_TIME)
    };
    if tracks.iter().all(agrees) {
        return grid;
    }
    let mut steps: Vec<f64> = tracks
        .iter()
        .flat_map(|track| track.windows(2).map(|pair| pair[1].t - pair[0].t))
        .collect();
    steps.sort_by(f64::total_cmp);
    let step = steps[steps.len() / 2];
    if end <= start || step <= 0.0 {
        return Vec::new();
    }
    let n = ((end - start) / step).floor() as usize;
    (0..=n).map(|k| start + k as f64 * step).collect()
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
