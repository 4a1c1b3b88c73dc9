//! Velocities of a path, as far as the noise of its readings lets them be seen.

use crate::Frame;
use crate::median::median;
use crate::reading::Reading;

/// Error of a velocity, relative to the greatest, that smoothing has to reach.
const VELOCITY_ERROR: f64 = 0.02;

/// Most frames on each side that a velocity is taken over.
const WIDEST: usize = 25;

/// Slope of the line through points that are good to `sigma`.
pub(crate) fn slope(points: impl Iterator<Item = (f64, f64)> + Clone, sigma: f64) -> Reading {
    let n = points.clone().count() as f64;
    let (t, y) = points.clone().fold((0.0, 0.0), |(t, y), (a, b)| (t + a / n, y + b / n));
    let (top, bottom) = points.fold((0.0, 0.0), |(top, bottom), (a, b)| {
        (top + (a - t) * (b - y), bottom + (a - t).powi(2))
    });
    match bottom > 0.0 {
        true => Reading { value: top / bottom, se: sigma / bottom.sqrt() },
        false => Reading { value: 0.0, se: f64::INFINITY },
    }
}

/// Velocity (m/s) of one coordinate at every frame, over `half` frames on each side where there are.
pub(crate) fn velocities(
    frames: &[Frame],
    half: usize,
    coordinate: impl Fn(&Frame) -> f64 + Copy,
) -> Vec<f64> {
    let last = frames.len().saturating_sub(1);
    let at = |k: usize| {
        let around = &frames[k.saturating_sub(half)..=(k + half).min(last)];
        slope(around.iter().map(|frame| (frame.t, coordinate(frame))), 1.0).value
    };
    (0..frames.len()).map(at).collect()
}

/// How many frames on each side a velocity near `speed` (m/s) has to be taken over, with readings good to
/// `sigma` (m) and `step` (s) between frames.
pub(crate) fn half_window(speed: f64, sigma: f64, step: f64) -> usize {
    let wide_enough = |half: usize| {
        let h = half as f64;
        let bottom = h * (h + 1.0) * (2.0 * h + 1.0) / 3.0;
        sigma <= VELOCITY_ERROR * speed * step * bottom.sqrt()
    };
    (1..WIDEST).find(|half| wide_enough(*half)).unwrap_or(WIDEST)
}

/// Median time (s) between frames.
pub(crate) fn median_step(frames: &[Frame]) -> Option<f64> {
    median(frames.windows(2).map(|pair| pair[1].t - pair[0].t))
}

/// The greatest downward velocity (m/s) of readings that are good to `sigma` (m).
pub(crate) fn greatest_velocity(frames: &[Frame], sigma: f64) -> Option<f64> {
    fastest(frames, sigma).map(|(_, velocity)| velocity)
}

/// The frame of that velocity, and the velocity (m/s).
pub(crate) fn fastest(frames: &[Frame], sigma: f64) -> Option<(usize, f64)> {
    let (velocities, peak) = downward(frames, sigma)?;
    Some((peak, velocities[peak]))
}

/// Downward velocities, and which of them is the greatest.
fn downward(frames: &[Frame], sigma: f64) -> Option<(Vec<f64>, usize)> {
    let step = median_step(frames)?;
    let greatest = |velocities: &[f64]| {
        let largest = velocities.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        largest.filter(|(_, velocity)| *velocity > 0.0)
    };
    let rough = greatest(&velocities(frames, 2, |frame| frame.z))?.1;
    let velocities = velocities(frames, half_window(rough, sigma, step), |frame| frame.z);
    let (peak, _) = greatest(&velocities)?;
    Some((velocities, peak))
}

/// The frames around the greatest downward velocity, as far as it stays above a `share` of that.
///
/// What precedes the release and what follows the stop is left out, wherever the clock has its zero.
pub(crate) fn velocity_window(frames: &[Frame], sigma: f64, share: f64) -> Option<&[Frame]> {
    let (velocities, peak) = downward(frames, sigma)?;
    let most = velocities[peak];
    let is_near = |k: &usize| velocities[*k] >= share * most;
    let from = (0..=peak).rev().take_while(is_near).last()?;
    let to = (peak..frames.len()).take_while(is_near).last()?;
    // The first velocity is taken over what follows; the frames it is taken from belong to it.
    Some(&frames[from..=to])
}

/// Means of neighbouring frames, at most so many, and their error (m).
pub(crate) fn blocks(frames: &[Frame], most: usize, sigma: f64) -> (Vec<Frame>, f64) {
    let size = frames.len().div_ceil(most).max(1);
    let mean = |block: &[Frame]| {
        let n = block.len() as f64;
        let of = |number: fn(&Frame) -> f64| block.iter().map(number).sum::<f64>() / n;
        Frame { t: of(|f| f.t), z: of(|f| f.z), x: of(|f| f.x), sigma: None }
    };
    let whole = frames.chunks_exact(size).map(mean).collect();
    (whole, sigma / (size as f64).sqrt())
}
