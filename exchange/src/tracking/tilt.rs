//! A camera that is not level: bodies that fall freely accelerate sideways in its picture.

use measurements::{Frame, Reading};

/// Fewest readings of a free fall that show an acceleration.
const FEWEST: usize = 8;

/// Standard errors and angle (rad) beyond which a tilt is turned back.
const CLEAR: f64 = 2.5;
const LEAST: f64 = 3e-3;

/// Most that the tilts of runs may differ, in chi-squared per run: one camera has one tilt.
const ALIKE: f64 = 3.0;

/// The free fall of one run, and where it ends.
pub(super) struct Flight<'a> {
    /// The readings of the body in SI.
    pub(super) frames: &'a [Frame],
    /// First and last time (s) of free fall.
    pub(super) between: [f64; 2],
}

/// The angle (rad) of gravity in the picture, from the downward toward the forward axis, by all `flights` under `gravity`
/// (m/s²); `None` if it is not clear, or differs between runs.
pub(super) fn tilt(flights: &[Flight<'_>], gravity: f64) -> Option<Reading> {
    let each: Vec<Reading> = flights.iter().filter_map(|one| one.sideways(gravity)).collect();
    let weight = |one: &Reading| one.se.powi(-2);
    let weights: f64 = each.iter().map(weight).sum();
    let value = each.iter().map(|one| weight(one) * one.value).sum::<f64>() / weights;
    let misfit = |one: &Reading| weight(one) * (one.value - value).powi(2);
    let excess = each.iter().map(misfit).sum::<f64>() / each.len().max(1) as f64;
    let se = weights.sqrt().recip() * excess.max(1.0).sqrt();
    let is_clear = excess <= ALIKE && value.abs() > LEAST.max(CLEAR * se);
    is_clear.then_some(Reading { value: libm::asin(value.clamp(-1.0, 1.0)), se })
}

impl Flight<'_> {
    /// Sideways acceleration over `gravity`; `None` where too few readings show it.
    fn sideways(&self, gravity: f64) -> Option<Reading> {
        let [first, last] = self.between;
        let own = self.frames.iter().filter(|one| (first..=last).contains(&one.t));
        let own: Vec<&Frame> = own.collect();
        if own.len() < FEWEST {
            return None;
        }
        // Least squares with orthogonal polynomials in time: constant, line and parabola.
        let n = own.len() as f64;
        let mean = |of: &dyn Fn(&Frame) -> f64| own.iter().map(|one| of(one)).sum::<f64>() / n;
        let middle = mean(&|one| one.t);
        let line = |one: &Frame| one.t - middle;
        let square = mean(&|one| line(one).powi(2));
        let lean = mean(&|one| line(one).powi(3)) / square;
        let bend = |one: &Frame| line(one).powi(2) - lean * line(one) - square;
        let bends = mean(&|one| bend(one).powi(2));
        let [level, slope, curvature] = [
            mean(&|one| one.x),
            mean(&|one| line(one) * one.x) / square,
            mean(&|one| bend(one) * one.x) / bends,
        ];
        let miss = |one: &Frame| one.x - level - slope * line(one) - curvature * bend(one);
        let noise = (n * mean(&|one| miss(one).powi(2)) / (n - 3.0)).sqrt();
        let se = 2.0 * noise / (n * bends).sqrt() / gravity;
        let is_told = se.is_finite() && se > 0.0;
        is_told.then(|| Reading { value: 2.0 * curvature / gravity, se })
    }
}

/// `frames` rotated by `tilt` (rad) around the point `around` (way and depth in m), as a level camera records them.
pub(super) fn turned_back(frames: &[Frame], tilt: f64, around: [f64; 2]) -> Vec<Frame> {
    let (sine, cosine) = libm::sincos(tilt);
    let turn = |one: &Frame| {
        let (x, z) = (one.x - around[0], one.z - around[1]);
        Frame { x: around[0] + x * cosine - z * sine, z: around[1] + z * cosine + x * sine, ..*one }
    };
    frames.iter().map(turn).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: f64 = 9.81;

    /// A body that falls at `angle` (rad) from the vertical, in a picture that is tilted, with readings off by 0.1 mm.
    fn fall(tilt: f64, forward: f64) -> Vec<Frame> {
        let noise = |k: i32, of: f64| 1e-4 * libm::sin(f64::from(k) * of);
        let frame = |k: i32| {
            let t = f64::from(k) / 500.0;
            let (x, z) = (forward * t, 1.0 * t + 0.5 * GRAVITY * t * t);
            let (sine, cosine) = libm::sincos(tilt);
            let (x, z) = (x * cosine + z * sine, z * cosine - x * sine);
            Frame { t, x: x + noise(k, 1.7), z: z + noise(k, 2.3), sigma: None }
        };
        (-60..=0).map(frame).collect()
    }

    #[test]
    fn a_tilted_camera_is_found_and_its_picture_turned_back() {
        for (angle, forward) in [(0.05, 0.0), (-0.03, 1.0)] {
            let frames = [fall(angle, forward), fall(angle, 0.5 * forward)];
            let flights = frames.each_ref().map(|frames| Flight { frames, between: [-0.12, 0.0] });
            let found = tilt(&flights, GRAVITY).expect("it is tilted");
            assert!((found.value - angle).abs() < 4.0 * found.se.max(1e-3), "{found:?}");
            let level = turned_back(&frames[0], found.value, [0.0, 0.0]);
            let (first, last) = (level[0], level[level.len() - 1]);
            let fallen = (last.x - first.x) - forward * (last.t - first.t);
            assert!(fallen.abs() < 1e-3, "{fallen}");
        }
    }

    #[test]
    fn a_level_camera_and_two_cameras_have_no_tilt() {
        let level = fall(0.0, 1.0);
        let flight = |frames| Flight { frames, between: [-0.12, 0.0] };
        assert_eq!(tilt(&[flight(&level)], GRAVITY), None);
        let [one, other] = [fall(0.05, 0.0), fall(-0.05, 0.0)];
        assert_eq!(tilt(&[flight(&one), flight(&other)], GRAVITY), None);
    }
}
