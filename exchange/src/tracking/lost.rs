//! Bodies that a tracker lost: their last position is written again and again.

use measurements::Frame;

/// Fewest readings that repeat the last position.
const REPEATED: usize = 20;

/// Speed (m/s) above which no bed stops a body within a frame.
const FAST: f64 = 0.3;

/// Ratio of the deceleration of a stop to the deceleration before it, above which the tracker has lost the body.
const SUDDEN: f64 = 5.0;

/// Frames over which a speed is averaged, and the least distance in them, in units of the resolution of the table.
const OVER: usize = 4;
const STEPS: f64 = 3.0;

/// The index of the first reading of `frames` (SI) at which the tracker has lost the body, and the speed (m/s) before it; `None`
/// where the body is not lost.
pub(super) fn lost_from(frames: &[Frame]) -> Option<(usize, f64)> {
    let last = frames.last()?;
    let same = |one: &&Frame| one.z.total_cmp(&last.z).is_eq() && one.x.total_cmp(&last.x).is_eq();
    let repeated = frames.iter().rev().take_while(same).count();
    let at = frames.len() - repeated;
    let moving = frames[..at].windows(OVER + 1);
    let speed = |part: &[Frame]| (part[OVER].z - part[0].z) / (part[OVER].t - part[0].t);
    let last = moving.clone().last()?;
    // A body that stops slows down within these frames.
    let end = (last[OVER].z - last[OVER - 1].z) / (last[OVER].t - last[OVER - 1].t);
    let before = speed(last).min(end);
    let steps = frames.windows(2).map(|pair| (pair[1].z - pair[0].z).abs());
    let finest = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let step = frames[at].t - frames[at - 1].t;
    let is_clear = before * step * OVER as f64 > STEPS * finest;
    let fastest = moving.max_by(|a, b| speed(a).total_cmp(&speed(b)))?;
    let braking = (speed(fastest) - before) / (frames[at - 1].t - fastest[OVER].t).max(step);
    (repeated > REPEATED && before > FAST && is_clear && before / step > SUDDEN * braking)
        .then_some((at, before))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body that is braked by `braking` (m/s²) from 2 m/s and stops, and whose tracker loses it at `lost` (s).
    fn frames(rate: f64, braking: f64, lost: f64) -> Vec<Frame> {
        let depth = |t: f64| {
            let t = t.min(lost);
            let braked = t.clamp(0.0, 2.0 / braking);
            2.0 * t.min(2.0 / braking) - 0.5 * braking * braked * braked
        };
        (-40..200)
            .map(|k| f64::from(k) / rate)
            .map(|t| Frame { t, z: depth(t), x: 0.0, sigma: None })
            .collect()
    }

    #[test]
    fn a_path_that_freezes_at_speed_is_lost_and_one_that_stops_is_not() {
        let (at, speed) = lost_from(&frames(1000.0, 40.0, 0.0205)).expect("it is lost");
        assert!((60..=62).contains(&at) && (speed - 1.2).abs() < 0.2, "{at}, {speed}");
        for rate in [240.0, 1000.0] {
            assert_eq!(lost_from(&frames(rate, 100.0, f64::INFINITY)), None, "{rate}");
        }
    }
}
