//! Where and when the path of a run ends, as its frames show it.
//!
//! Near the end a coordinate is `e − a s²/2 − c s³/6` at the time `s` before it stops, and `e` from then on. The fit
//! is made for all times of the stop; what is said is the mean over them by their misfit.

use nalgebra::{Matrix3, Vector3};

use crate::contact::smooth::{half_window, median_step, velocities};
use crate::reading::Reading;
use crate::{Condition, Frame, Run};

/// The end of a run under every definition, on the clock and the scale of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stops {
    /// The later of the first zeros of the velocity components (s).
    pub(crate) component_zero: Reading,
    /// When the speed first falls below 5 % of the impact speed (s).
    pub(crate) five_percent: Reading,
    /// The largest depth and range up to there (m).
    pub(crate) deepest: [Reading; 2],
    /// Depth and range in the last frames (m), where those are at rest.
    pub(crate) resting: Option<[Reading; 2]>,
    /// Time from frame to frame (s).
    pub(crate) step: f64,
}

/// Share of the greatest velocity below which a path nears its end.
const NEARS: f64 = 0.6;

/// Share of it, and standard errors of a velocity, below which it may have ended.
const ENDS: f64 = 0.02;
const BY_CHANCE: f64 = 2.0;

/// Fewest frames of an end.
const FEWEST: usize = 6;

/// Times of the stop that are tried between two frames.
const BETWEEN_FRAMES: usize = 8;

/// Most frames behind the stop that a place of rest is the mean of.
const STILL: usize = 8;

/// Share of the impact speed that counts as stopped.
const STOPPED: f64 = 0.05;

/// The end of `run`, with readings that are good to `sigma` (m); `None` where its frames do not reach it.
pub(crate) fn read(run: &Run, condition: &Condition, sigma: f64) -> Option<Stops> {
    let frames = run.frames.as_slice();
    let step = median_step(frames)?;
    let oblique = condition.angle_deg < 89.0;
    let speed = condition.speed;
    if speed <= 0.0 {
        return None;
    }
    let depth = End::of(frames, |frame| frame.z, (sigma, step))?;
    let range = match oblique {
        true => Some(End::of(frames, |frame| frame.x, (sigma, step))?),
        false => None,
    };
    let last = match &range {
        Some(range) if range.time.value > depth.time.value => range,
        _ => &depth,
    };
    let still: Vec<Frame> =
        frames.iter().filter(|frame| frame.t > last.time.value + step).copied().collect();
    let still = &still[still.len().saturating_sub(STILL)..];
    let mean = |of: fn(&Frame) -> f64| {
        let n = still.len() as f64;
        Reading { value: still.iter().map(of).sum::<f64>() / n, se: sigma / n.sqrt() }
    };
    let nowhere = Reading { value: 0.0, se: 0.0 };
    Some(Stops {
        component_zero: last.time,
        five_percent: Reading {
            value: slow(&depth, range.as_ref(), STOPPED * speed, last.time.value)?,
            se: last.time.se,
        },
        deepest: [depth.place, range.as_ref().map_or(nowhere, |range| range.place)],
        resting: (still.len() > 1).then(|| [mean(|frame| frame.z), mean(|frame| frame.x)]),
        step,
    })
}

/// When the speed last was `limit` (m/s), from the ends of both coordinates.
fn slow(depth: &End, range: Option<&End>, limit: f64, end: f64) -> Option<f64> {
    let speed =
        |t: f64| libm::hypot(depth.velocity(t), range.map_or(0.0, |range| range.velocity(t)));
    let start = range.map_or(depth.start, |range| depth.start.max(range.start));
    if end <= start || speed(start) < limit {
        return None;
    }
    // The speed falls all the way: halve the time in which it does.
    let (mut fast, mut stopped) = (start, end);
    for _ in 0..40 {
        let middle = 0.5 * (fast + stopped);
        match speed(middle) < limit {
            true => stopped = middle,
            false => fast = middle,
        }
    }
    Some(stopped)
}

/// The end of one coordinate.
struct End {
    /// When it stops (s), and where (m).
    time: Reading,
    place: Reading,
    /// From when on (s) the velocity is known.
    start: f64,
    /// Deceleration at the stop (m/s²), and by how much it is larger before (m/s³), in the mean.
    deceleration: f64,
    change: f64,
}

impl End {
    fn of(
        frames: &[Frame],
        coordinate: impl Fn(&Frame) -> f64 + Copy,
        (sigma, step): (f64, f64),
    ) -> Option<Self> {
        let frames = ending(frames, coordinate, (sigma, step))?;
        let points: Vec<(f64, f64)> =
            frames.iter().map(|frame| (frame.t, coordinate(frame))).collect();
        let (first, last) = (points[0].0, points[points.len() - 1].0);
        let places = BETWEEN_FRAMES * (points.len() - 1);
        let place = |k: usize| first + (last - first) * k as f64 / places as f64;
        // At least three frames lie before the stop.
        let tried = (3 * BETWEEN_FRAMES..=places).map(place);
        let fits: Vec<Fit> =
            tried.filter_map(|stop| Fit::of(&points, stop, (sigma, last - first))).collect();
        let best = fits.iter().map(|fit| fit.misfit).fold(f64::INFINITY, f64::min);
        let freedom = (points.len() as f64 - 4.0).max(1.0);
        let excess = (best / freedom).max(1.0) * (1.0 + 4.0 / freedom);
        let mean = |of: fn(&Fit) -> (f64, f64)| {
            let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
            for fit in &fits {
                let weight = libm::exp(-0.5 * (fit.misfit - best) / excess);
                let (value, variance) = of(fit);
                sum += weight;
                first += weight * value;
                second += weight * (value * value + excess * variance);
            }
            let value = first / sum;
            Reading { value, se: (second / sum - value * value).max(0.0).sqrt() }
        };
        (best.is_finite()).then(|| Self {
            time: mean(|fit| (fit.stop, 0.0)),
            place: mean(|fit| (fit.numbers[0], fit.variance)),
            start: first,
            deceleration: mean(|fit| (fit.numbers[1], 0.0)).value,
            change: mean(|fit| (fit.numbers[2], 0.0)).value,
        })
    }

    /// (m/s) at `time`.
    fn velocity(&self, time: f64) -> f64 {
        let left = (self.time.value - time).max(0.0);
        (self.deceleration * left + 0.5 * self.change * left * left).max(0.0)
    }
}

/// The frames from where a coordinate has slowed down to shortly behind its stop.
fn ending(
    frames: &[Frame],
    coordinate: impl Fn(&Frame) -> f64 + Copy,
    (sigma, step): (f64, f64),
) -> Option<&[Frame]> {
    let rough = velocities(frames, 2, coordinate).into_iter().fold(0.0, f64::max);
    let half = half_window(rough, sigma, step).min(1 + frames.len() / 10);
    let velocities = velocities(frames, half, coordinate);
    let fastest = (0..frames.len()).max_by(|a, b| velocities[*a].total_cmp(&velocities[*b]))?;
    let most = velocities[fastest];
    let error = sigma / (step * (half * (half + 1) * (2 * half + 1)) as f64 / 3.0).sqrt();
    let limit = (ENDS * most).max(BY_CHANCE * error.min(0.1 * most));
    let after = |limit: f64| (fastest..frames.len()).find(|k| velocities[*k] < limit);
    let (from, stop) = (after(NEARS * most)?, after(limit)?);
    // What springs back is not part of the stop.
    let stays = |k: &usize| *k < stop + 3 || velocities[*k] > -limit;
    let to = (stop..frames.len().min(stop + half + 4)).take_while(stays).last()?;
    // A stop in the last frames may be none.
    let is_seen = to >= stop + 2 && to + 1 >= from + FEWEST;
    is_seen.then(|| &frames[from..=to])
}

/// The end for one time of the stop.
struct Fit {
    stop: f64,
    misfit: f64,
    /// e, a, c.
    numbers: Vector3<f64>,
    /// Of e (m²).
    variance: f64,
}

impl Fit {
    fn of(points: &[(f64, f64)], stop: f64, (sigma, scale): (f64, f64)) -> Option<Self> {
        let (mut normal, mut right, mut square) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
        let weight = 1.0 / (sigma * sigma);
        // Heights count from the last one, so that squares of them cost no digits.
        let height = points[points.len() - 1].1;
        for (t, y) in points {
            let left = ((stop - t) / scale).max(0.0);
            let row = Vector3::new(1.0, -0.5 * left * left, -left * left * left / 6.0);
            let value = y - height;
            normal += row * row.transpose() * weight;
            right += row * (value * weight);
            square += weight * value * value;
        }
        let covariance = normal.cholesky()?.inverse();
        let found = covariance * right;
        let numbers =
            Vector3::new(found[0] + height, found[1] / scale.powi(2), found[2] / scale.powi(3));
        let misfit = (square - found.dot(&right)).max(0.0);
        // It comes to rest from moving forward.
        let first = ((stop - points[0].0) / scale).max(0.0);
        let forward = found[1] >= 0.0 && found[1] + 0.5 * found[2] * first >= 0.0;
        forward.then_some(Self { stop, misfit, numbers, variance: covariance[(0, 0)] })
    }
}
