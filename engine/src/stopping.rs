//! When an intruder has stopped, as the literature defines it.

use serde::{Deserialize, Serialize};

use crate::body::Followed;
use crate::math::Vec3;

/// A speed below this share of the greatest so far counts as rest.
pub const REST_SPEED: f64 = 0.05;

/// How long (s) an intruder has to be at rest before the impact is over.
const REST_HOLD: f64 = 0.01;

/// Follows one impact and notes its stopping times, depth and range.
///
/// The stopping time of a component is when it first comes to zero, found between steps by linear
/// interpolation, and 0 for a component that the impact does not have; the stopping time of the
/// impact is the larger of the two (Wang, Ye & Zheng 2012, §3.4). The depth is the largest up to
/// that time (§3.3), so a rebound or a second settling does not count. That definition hangs on a
/// fluctuation where the intruder creeps; the rest time does not: from then on the speed stays
/// below 5 % of the greatest, which is the impact speed except for an intruder that is let go from
/// rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stopping {
    /// Greatest speed so far.
    speed: f64,
    start: Vec3,
    /// At the start (m).
    reach: f64,
    /// Whether the vertical component alone decides.
    is_tip: bool,
    /// Unit vector of the horizontal part of the impact velocity, or zero.
    forward: Vec3,
    before: Sample,
    horizontal: Option<Stop>,
    vertical: Option<f64>,
    deepest: f64,
    rest_since: Option<f64>,
    now: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Sample {
    time: f64,
    forward: f64,
    down: f64,
    range: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Stop {
    time: f64,
    range: f64,
}

impl Stopping {
    /// An impact that starts so.
    pub fn new(followed: Followed) -> Self {
        let Followed { position, velocity, reach } = followed;
        let speed = velocity.norm();
        let horizontal = Vec3::new(velocity.x, velocity.y, 0.0);
        // A vertical impact has a cosine of round-off size, which is not a horizontal impact.
        let oblique = horizontal.norm() > 1e-9 * speed;
        let forward = if oblique { horizontal.normalize() } else { Vec3::zeros() };
        Self {
            speed,
            start: position,
            reach,
            is_tip: false,
            forward,
            before: Sample {
                time: 0.0,
                forward: velocity.dot(&forward),
                down: -velocity.z,
                range: 0.0,
            },
            horizontal: if oblique { None } else { Some(Stop { time: 0.0, range: 0.0 }) },
            vertical: None,
            deepest: 0.0,
            rest_since: None,
            now: 0.0,
        }
    }

    /// The tip of a link that meets the bed so at `time` (s): it has stopped when it no longer sinks
    /// (S0, the end of the penetration).
    pub(crate) fn of_tip(time: f64, followed: Followed) -> Self {
        let start = Self::new(followed);
        Self { is_tip: true, before: Sample { time, ..start.before }, now: time, ..start }
    }

    /// Takes note of the state at `time` (s).
    pub fn observe(&mut self, time: f64, followed: Followed) {
        let Followed { position, velocity, reach } = followed;
        let now = Sample {
            time,
            forward: velocity.dot(&self.forward),
            down: -velocity.z,
            range: (position - self.start).dot(&self.forward),
        };
        let before = self.before;
        if self.stopping_time().is_none() {
            let sunk = (self.start.z - position.z) + (reach - self.reach);
            self.deepest = self.deepest.max(sunk);
        }
        if self.horizontal.is_none() && now.forward <= 0.0 {
            let share = before.forward / (before.forward - now.forward);
            self.horizontal = Some(Stop {
                time: before.time + share * (now.time - before.time),
                range: before.range + share * (now.range - before.range),
            });
        }
        if self.vertical.is_none() && before.down > 0.0 && now.down <= 0.0 {
            let share = before.down / (before.down - now.down);
            self.vertical = Some(before.time + share * (now.time - before.time));
        }
        self.speed = self.speed.max(velocity.norm());
        if velocity.norm() >= REST_SPEED * self.speed {
            self.rest_since = None;
        } else if self.rest_since.is_none() {
            self.rest_since = Some(time);
        }
        self.before = now;
        self.now = time;
    }

    /// Whether both components have come to zero and the intruder has kept still since.
    pub fn is_over(&self) -> bool {
        self.stopping_time().is_some()
            && self.rest_since.is_some_and(|since| self.now - since >= REST_HOLD)
    }

    /// The larger stopping time (s); of a tip, the vertical one.
    pub fn stopping_time(&self) -> Option<f64> {
        if self.is_tip {
            return self.vertical;
        }
        Some(self.horizontal_time()?.max(self.vertical?))
    }

    /// When the horizontal velocity first came to zero (s).
    pub fn horizontal_time(&self) -> Option<f64> {
        self.horizontal.map(|stop| stop.time)
    }

    /// When the vertical velocity first came to zero (s).
    pub fn vertical_time(&self) -> Option<f64> {
        self.vertical
    }

    /// Since when the speed has stayed below 5 % of the greatest (s).
    pub fn rest_time(&self) -> Option<f64> {
        self.rest_since
    }

    /// Largest depth of the lowest point below where that was at the start (m), up to the stopping
    /// time.
    pub fn depth(&self) -> f64 {
        self.deepest
    }

    /// Horizontal distance covered when the horizontal velocity first came to zero (m); until then,
    /// the distance so far.
    pub fn range(&self) -> f64 {
        self.horizontal.map_or(self.before.range, |stop| stop.range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point that is its own lowest one.
    fn followed(position: Vec3, velocity: Vec3) -> Followed {
        Followed { position, velocity, reach: 0.0 }
    }

    #[test]
    fn a_body_that_turns_is_as_deep_as_its_lowest_point() {
        let at = |z: f64, reach: f64, vz: f64| Followed {
            position: Vec3::new(0.0, 0.0, z),
            velocity: Vec3::new(0.0, 0.0, vz),
            reach,
        };
        let mut stopping = Stopping::new(at(1.0, 0.5, -1.0));
        // Half a turn onto the longer end: the centre sinks by 0.25, the lowest point by 0.75.
        stopping.observe(0.1, at(0.75, 1.0, -0.5));
        // Sums of powers of two: exact.
        assert_eq!(stopping.depth().to_bits(), 0.75_f64.to_bits());
    }

    /// Constant deceleration from `velocity` along both axes, sampled every `dt` until 1 s.
    fn decelerate(velocity: Vec3, deceleration: Vec3, dt: f64) -> Stopping {
        let mut stopping = Stopping::new(followed(Vec3::zeros(), velocity));
        for step in 1..=(1.0 / dt) as usize {
            let t = step as f64 * dt;
            let each = |axis: usize| {
                let (v, a) = (velocity[axis], deceleration[axis]);
                let t = if a == 0.0 { 0.0 } else { t.min(-1.01 * v / a) };
                (v * t + 0.5 * a * t * t, if a == 0.0 { 0.0 } else { v + a * t })
            };
            let ((x, vx), (z, vz)) = (each(0), each(2));
            stopping.observe(t, followed(Vec3::new(x, 0.0, z), Vec3::new(vx, 0.0, vz)));
        }
        stopping
    }

    #[test]
    fn the_later_component_decides_and_times_lie_between_steps() {
        let (v, a) = (Vec3::new(1.0, 0.0, -2.0), Vec3::new(-3.0, 0.0, 8.0));
        let stopping = decelerate(v, a, 1e-3);
        assert!((stopping.vertical_time().unwrap() - 0.25).abs() < 1e-12);
        assert!((stopping.horizontal_time().unwrap() - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(stopping.stopping_time(), stopping.horizontal_time());
        assert!((stopping.depth() - 0.25).abs() < 1e-5);
        assert!((stopping.range() - 1.0 / 6.0).abs() < 1e-5);
        assert!(stopping.is_over());
    }

    #[test]
    fn a_vertical_impact_has_no_horizontal_stopping_time() {
        let v = Vec3::new(2.0 * libm::cos(0.5 * std::f64::consts::PI), 0.0, -2.0);
        let stopping = decelerate(v, Vec3::new(0.0, 0.0, 8.0), 1e-3);
        assert_eq!(stopping.horizontal_time(), Some(0.0));
        assert!((stopping.stopping_time().unwrap() - 0.25).abs() < 1e-12);
    }

    #[test]
    fn rest_begins_where_the_speed_has_fallen_to_a_twentieth_of_the_greatest() {
        // v = v₀ e^(−t/τ) with τ = 0.1 s: at τ ln 20.
        let (decay, dt) = (0.1, 1e-4);
        let at = |t: f64| {
            let left = libm::exp(-t / decay);
            followed(Vec3::new(0.0, 0.0, -3.0 * decay * (1.0 - left)), Vec3::z() * (-3.0 * left))
        };
        let mut stopping = Stopping::new(at(0.0));
        for step in 1..=4000 {
            let t = f64::from(step) * dt;
            stopping.observe(t, at(t));
        }
        let exact = decay * libm::log(20.0);
        let rest = stopping.rest_time().expect("it slows down for ever");
        // The first step that is below.
        assert!(rest >= exact && rest < exact + dt, "{rest} {exact}");
        // A knock of six hundredths of the greatest speed ends it, one of four does not.
        let knock = |speed: f64| followed(Vec3::zeros(), Vec3::x() * speed);
        stopping.observe(0.5, knock(0.04 * 3.0));
        assert!(stopping.rest_time().is_some_and(|time| time < 0.5));
        stopping.observe(0.6, knock(0.06 * 3.0));
        assert_eq!(stopping.rest_time(), None);
    }

    #[test]
    fn an_intruder_let_go_from_rest_stops_when_it_has_fallen_and_not_at_once() {
        let mut stopping = Stopping::new(followed(Vec3::zeros(), Vec3::zeros()));
        assert!(stopping.stopping_time().is_none());
        for step in 1..=400 {
            let t = f64::from(step) * 1e-3;
            let phase = std::f64::consts::PI * t.min(0.2) / 0.2;
            let z = libm::cos(phase) - 1.0;
            let v = if t < 0.2 { -libm::sin(phase) } else { 0.0 };
            stopping.observe(t, followed(Vec3::new(0.0, 0.0, z), Vec3::new(0.0, 0.0, v)));
        }
        assert!((stopping.stopping_time().unwrap() - 0.2).abs() < 1e-12);
        assert!((stopping.depth() - 2.0).abs() < 1e-9);
        assert!(stopping.is_over());
    }
}
