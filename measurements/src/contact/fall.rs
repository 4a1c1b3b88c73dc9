//! The fall before first contact, seen without knowing units, zeros or which way is down.

use crate::Frame;
use crate::contact::smooth::{blocks, greatest_velocity, median_step, velocity_window};
use crate::median::deviation_of;
use crate::reading::Reading;

/// Share of the greatest velocity above which a path counts as falling.
const FALLING: f64 = 0.3;

/// Frames, or means of neighbouring ones, that the parabola is fitted to.
const MOST: usize = 64;

/// Fewest frames that an acceleration is read from.
const FEWEST: usize = 6;

/// Fewest frames of a fall that tell the error of a reading by themselves.
const STEADILY: usize = 10;

/// Share of the neighbouring steps that may be longer or shorter than the median for a frame to count in the noise.
const STEADY: f64 = 0.1;

/// The fall before first contact, in the units of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fall {
    /// Acceleration before contact.
    pub acceleration: Reading,
    /// Greatest velocity.
    pub velocity: f64,
    /// Error of one reading of a position.
    pub noise: f64,
}

impl Fall {
    /// The fall in `frames`, whose depths increase on the way; `None` if they never do.
    ///
    /// The acceleration is that of a parabola from 30 % of the greatest velocity to it; its error is infinite where
    /// there are too few frames. It is a little too small, as the velocity is greatest just behind the contact.
    pub fn of_frames(frames: &[Frame]) -> Option<Self> {
        let noise = reading_noise(frames);
        let velocity = greatest_velocity(frames, noise)?;
        let window = velocity_window(frames, noise, FALLING)?;
        // The window goes on to where the path is slow again: what comes before its fastest part is the fall.
        let fast = velocity_window(window, noise, 0.95)
            .map_or(0, |fast| window.iter().position(|frame| frame.t >= fast[0].t).unwrap_or(0));
        // A tracker may hold a body that rests more steadily than one that falls.
        let noise = match fast >= STEADILY {
            true => noise.max(reading_noise(&window[..fast])),
            false => noise,
        };
        let acceleration = match window[..fast].len() >= FEWEST {
            true => acceleration(&window[..fast], noise),
            false => acceleration(&window[..window.len().min(fast + 2)], noise),
        };
        Some(Self { acceleration, velocity, noise })
    }
}

/// Error of one reading of a position, from what neighbouring readings differ by beyond a parabola: at least a
/// millionth of the way, and what the readings are rounded to.
pub fn reading_noise(frames: &[Frame]) -> f64 {
    let ends = frames.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], frame| {
        [low.min(frame.z), high.max(frame.z)]
    });
    let way = if ends[1] > ends[0] { ends[1] - ends[0] } else { 1.0 };
    let Some(step) = median_step(frames).filter(|step| *step > 0.0) else { return 1e-6 * way };
    let is_steady = |four: &[Frame]| {
        four.windows(2).all(|pair| ((pair[1].t - pair[0].t) / step - 1.0).abs() < STEADY)
    };
    let third = |four: &[Frame]| (four[3].z - 3.0 * four[2].z + 3.0 * four[1].z - four[0].z).abs();
    // A body that is held or rests may be the same reading again and again.
    let moves = |four: &[Frame]| (four[3].z - four[0].z).abs() > 0.0;
    let fours = frames.windows(4).filter(|four| is_steady(four) && moves(four));
    // A third difference has √20 errors of a reading.
    let seen = deviation_of(fours.map(third)) / 20f64.sqrt();
    seen.max(1e-6 * way)
}

/// Twice the leading coefficient of the parabola through `frames`.
fn acceleration(frames: &[Frame], noise: f64) -> Reading {
    let unknown = Reading { value: 0.0, se: f64::INFINITY };
    if frames.len() < FEWEST {
        return unknown;
    }
    let (frames, noise) = blocks(frames, MOST, noise);
    let n = frames.len() as f64;
    let middle = frames.iter().map(|frame| frame.t).sum::<f64>() / n;
    let scale = 0.5 * (frames[frames.len() - 1].t - frames[0].t);
    if scale.is_nan() || scale <= 0.0 {
        return unknown;
    }
    let (mut normal, mut right) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
    for frame in &frames {
        let t = (frame.t - middle) / scale;
        let row = nalgebra::Vector3::new(1.0, t, 0.5 * t * t);
        normal += row * row.transpose();
        right += row * frame.z;
    }
    let Some(inverse) = normal.try_inverse() else { return unknown };
    let per = 1.0 / (scale * scale);
    Reading { value: (inverse * right)[2] * per, se: noise * inverse[(2, 2)].sqrt() * per }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that is held for 0.2 s, falls 0.2 m in units of `length` and `time`, and is stopped in 20 ms.
    fn drop(length: f64, time: f64) -> Vec<Frame> {
        let (release, way): (f64, f64) = (0.2, 0.2);
        let (speed, contact) = ((2.0 * 9.81 * way).sqrt(), release + (2.0 * way / 9.81_f64).sqrt());
        let depth = |t: f64| match t {
            t if t < release => 0.0,
            t if t < contact => 0.5 * 9.81 * (t - release).powi(2),
            t => way + speed * 0.02 * (1.0 - libm::exp(-(t - contact) / 0.02)),
        };
        let noise = |k: i32| 1e-4 * (f64::from(k * 7919 % 101) / 50.0 - 1.0);
        (0..400)
            .map(|k| {
                let t = f64::from(k) / 500.0;
                Frame { t: t / time, z: (depth(t) + noise(k)) / length, x: 0.0, sigma: None }
            })
            .collect()
    }

    #[test]
    fn acceleration_and_noise_are_read_in_any_units() {
        for (length, time) in [(1.0, 1.0), (1e-2, 1e-3), (2e-4, 1.0)] {
            let fall = Fall::of_frames(&drop(length, time)).expect("a fall");
            let [a, noise] =
                [fall.acceleration.value * length / (time * time), fall.noise * length];
            assert!((a / 9.81 - 1.0).abs() < 0.05, "{a}");
            assert!((2e-5..2e-4).contains(&noise), "{noise}");
        }
    }

    #[test]
    fn what_never_goes_down_does_not_fall() {
        let up = |k: i32| Frame { t: f64::from(k), z: -f64::from(k), x: 0.0, sigma: None };
        let rising: Vec<Frame> = (0..20).map(up).collect();
        assert_eq!(Fall::of_frames(&rising), None);
        assert!(reading_noise(&[]) > 0.0);
    }
}
