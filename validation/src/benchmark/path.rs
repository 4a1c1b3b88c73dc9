//! Paths of spheres: Runge-Kutta of fourth order with a fixed step, in plain arrays.

use thiserror::Error;

use super::forces::{Sphere, State};

/// Step (s) of the paths that are measured: positions are right to about a micrometre.
pub(super) const FINE: f64 = 2e-4;

/// Step (s) of the paths that only strengths are found with.
pub(super) const COARSE: f64 = 8e-4;

/// Below this share of the impact speed a sphere counts as stopped.
const STOPPED: f64 = 0.05;

/// How much shorter the steps of the creep are.
const CREEP: f64 = 0.1;

/// A sphere that still moves so long after contact (s) stays where it is.
const LONGEST: f64 = 2.0;

/// Why a world gives no measurements.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum WorldError {
    #[error("a sphere does not stop")]
    Endless,
    #[error("a path is not finite")]
    NotFinite,
    #[error("no amplitude of {0} is as strong as that")]
    TooStrong(&'static str),
}

/// A path from the flight to rest.
#[derive(Clone, Debug)]
pub(super) struct Path {
    times: Vec<f64>,
    states: Vec<State>,
    /// When the speed has fallen below 5 % of the impact speed (s after contact).
    pub(super) stop_time: f64,
    /// Where it rests: x, z (m).
    pub(super) rest: [f64; 2],
}

impl Path {
    /// Of `sphere`, from `flight` (s) before contact.
    pub(super) fn of(sphere: &Sphere<'_>, flight: f64, step: f64) -> Result<Self, WorldError> {
        let (sin, cos) = libm::sincos(sphere.setting.angle_deg.to_radians());
        let vertical = sphere.setting.angle_deg >= 90.0;
        let horizontal = if vertical { 0.0 } else { sphere.speed * cos };
        let contact = [0.0, 0.0, horizontal, sphere.speed * sin];
        let mut path =
            Self { times: vec![0.0], states: vec![contact], stop_time: 0.0, rest: [0.0; 2] };
        path.fly_back(sphere, flight, step);
        path.sink(sphere, step)?;
        path.creep(sphere, CREEP * step);
        Ok(path)
    }

    /// Place (m) at `time` (s), by the cubic through two places and velocities.
    pub(super) fn at(&self, time: f64) -> [f64; 2] {
        let last = self.times.len() - 1;
        if time >= self.times[last] {
            return self.rest;
        }
        let k = self.times.partition_point(|t| *t <= time).clamp(1, last) - 1;
        let step = self.times[k + 1] - self.times[k];
        let s = (time - self.times[k]) / step;
        let (a, b) = (self.states[k], self.states[k + 1]);
        [0, 1].map(|i| {
            let (from, to, rise) = (a[i + 2] * step, b[i + 2] * step, b[i] - a[i]);
            let (square, cube) = (3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise);
            a[i] + s * (from + s * (square + s * cube))
        })
    }

    /// The flight that led to contact, backward in time.
    fn fly_back(&mut self, sphere: &Sphere<'_>, flight: f64, step: f64) {
        let steps = (flight / step).ceil() as usize;
        let (mut time, mut state) = (0.0, self.states[0]);
        let (mut times, mut states) = (Vec::new(), Vec::new());
        for _ in 0..steps {
            // A hair before contact, so that no stage sees the bed.
            state = advance(sphere, (time - 1e-12, state), -step);
            time -= step;
            times.push(time);
            states.push(state);
        }
        times.reverse();
        states.reverse();
        self.times.splice(0..0, times);
        self.states.splice(0..0, states);
    }

    /// From contact until the speed has fallen below 5 %.
    fn sink(&mut self, sphere: &Sphere<'_>, step: f64) -> Result<(), WorldError> {
        let limit = STOPPED * sphere.speed;
        let (mut time, mut state) = (0.0, self.states[self.states.len() - 1]);
        while time < LONGEST {
            let next = advance(sphere, (time, state), step);
            let (before, after) = (speed(&state), speed(&next));
            if !after.is_finite() {
                return Err(WorldError::NotFinite);
            }
            self.push(time + step, next);
            if after < limit {
                self.stop_time = time + step * (before - limit) / (before - after);
                return Ok(());
            }
            (time, state) = (time + step, next);
        }
        Err(WorldError::Endless)
    }

    /// From there to rest: in short steps, and the last bit, which a step would overshoot, at constant
    /// deceleration.
    fn creep(&mut self, sphere: &Sphere<'_>, step: f64) {
        let last = self.times.len() - 1;
        let (mut time, mut state) = (self.times[last], self.states[last]);
        loop {
            let [ax, az] = sphere.acceleration(time, state);
            let (v, [x, z, vx, vz]) = (speed(&state), state);
            let deceleration = -(ax * vx + az * vz) / v.max(f64::MIN_POSITIVE);
            if v <= 3.0 * deceleration * step {
                let way = 0.5 * v / deceleration;
                self.rest = [x + way * vx, z + way * vz];
                self.push(time + v / deceleration, [self.rest[0], self.rest[1], 0.0, 0.0]);
                return;
            }
            if time > LONGEST || v == 0.0 {
                self.rest = [x, z];
                return;
            }
            state = advance(sphere, (time, state), step);
            time += step;
            self.push(time, state);
        }
    }

    fn push(&mut self, time: f64, state: State) {
        self.times.push(time);
        self.states.push(state);
    }
}

fn speed(&[_, _, vx, vz]: &State) -> f64 {
    libm::hypot(vx, vz)
}

/// One step of Runge and Kutta.
fn advance(sphere: &Sphere<'_>, (time, state): (f64, State), step: f64) -> State {
    let rate = |time: f64, state: State| -> State {
        let [ax, az] = sphere.acceleration(time, state);
        [state[2], state[3], ax, az]
    };
    let add = |rate: State, by: f64| -> State { std::array::from_fn(|i| state[i] + by * rate[i]) };
    let first = rate(time, state);
    let second = rate(time + 0.5 * step, add(first, 0.5 * step));
    let third = rate(time + 0.5 * step, add(second, 0.5 * step));
    let fourth = rate(time + step, add(third, step));
    std::array::from_fn(|i| {
        state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
    })
}

#[cfg(test)]
mod tests {
    use super::super::field::Field;
    use super::super::forces::{DENSITY, GRAVITY, Setting};
    use super::super::hidden::{Amplitudes, COUNT, Hidden};
    use super::*;

    const NOTHING: Amplitudes = [0.0; COUNT];

    fn sphere<'a>(
        angle_deg: f64,
        [drag, friction]: [f64; 2],
        amplitudes: &'a Amplitudes,
    ) -> Sphere<'a> {
        let setting = Setting {
            speed: 2.0,
            angle_deg,
            mass: 0.0667,
            diameter: 0.0254,
            spin: 0.0,
            packing: 0.59,
            bed_depth: 0.3,
        };
        let (along, sideways) = (Field::none(), Field::none());
        Sphere { setting, speed: 2.0, drag, friction, amplitudes, along, sideways, progress: 0.0 }
    }

    /// Drag and gravity: v² = v_t² + (v₀² − v_t²) e^(−2z/L), with L = m/(C_d ρ A) and v_t² = g L; with
    /// friction k z, v² = (v₀² + a) e^(−2z/L) + b (1 − e^(−2z/L)) … − k L z/m: linear in depth.
    #[test]
    fn speed_over_depth_is_that_of_the_closed_form_for_drag_and_friction() {
        let sphere = sphere(90.0, [1.2, 12.0], &NOTHING);
        let path = Path::of(&sphere, 0.0, FINE).expect("it stops");
        let Setting { mass, diameter, .. } = sphere.setting;
        let area = std::f64::consts::FRAC_PI_4 * diameter * diameter;
        let (length, stiffness) = (mass / (1.2 * DENSITY * area), 12.0 * DENSITY * GRAVITY * area);
        // d(v²)/dz = 2 g − 2 v²/L − 2 k z/m, solved with v² = 4 at 0.
        let slope = stiffness * length / mass;
        let offset = length * (GRAVITY + 0.5 * slope);
        let square = |z: f64| (4.0 - offset) * libm::exp(-2.0 * z / length) + offset - slope * z;
        for (time, state) in
            path.times.iter().zip(&path.states).filter(|(t, _)| **t < path.stop_time)
        {
            // RK4 at 0.2 ms over times of 20 ms: (0.01)^4/100 of 4 m²/s².
            assert!((state[3] * state[3] - square(state[1])).abs() < 1e-8, "{time}");
        }
        // The root of v² is where it rests.
        assert!(square(path.rest[1] - 2e-6) > 0.0 && square(path.rest[1] + 2e-6) < 0.0);
        let limit = square(path.at(path.stop_time)[1]).sqrt();
        assert!((limit - 0.1).abs() < 1e-5, "{limit}");
    }

    #[test]
    fn friction_alone_is_an_oscillator() {
        let sphere = sphere(90.0, [0.0, 12.0], &NOTHING);
        let path = Path::of(&sphere, 0.0, FINE).expect("it stops");
        let area = std::f64::consts::FRAC_PI_4 * 0.0254 * 0.0254;
        let frequency = (12.0 * DENSITY * GRAVITY * area / 0.0667).sqrt();
        let middle = GRAVITY / frequency.powi(2);
        let deepest = middle + libm::hypot(middle, 2.0 / frequency);
        assert!((path.rest[1] - deepest).abs() < 1e-6, "{} {deepest}", path.rest[1]);
    }

    #[test]
    fn the_flight_before_contact_is_that_of_gravity_guide_and_lean() {
        let mut amplitudes = NOTHING;
        amplitudes[Hidden::RailFriction as usize] = 0.2;
        amplitudes[Hidden::Tilt as usize] = 0.03;
        let sphere = sphere(90.0, [1.0, 10.0], &amplitudes);
        let path = Path::of(&sphere, 0.02, FINE).expect("it stops");
        let down = GRAVITY * libm::cos(0.03) - 0.2 / 0.0667;
        let [x, z] = path.at(-0.02);
        // The guide follows the path, which leans by 1e-3 of a radian: some 1e-6 of the way.
        assert!((z - (-2.0 * 0.02 + 0.5 * down * 4e-4)).abs() < 1e-7, "{z}");
        assert!((x - 0.5 * GRAVITY * libm::sin(0.03) * 4e-4).abs() < 2e-6, "{x}");
    }

    #[test]
    fn a_path_four_times_as_coarse_rests_at_the_same_place() {
        for angle in [35.0, 60.0, 90.0] {
            let sphere = sphere(angle, [1.2, 12.0], &NOTHING);
            let [fine, coarse] =
                [FINE, COARSE].map(|step| Path::of(&sphere, 0.0, step).expect("it stops").rest);
            for axis in 0..2 {
                // A hundredth of what a camera sees.
                assert!((fine[axis] - coarse[axis]).abs() < 2e-6, "{fine:?} {coarse:?}");
            }
        }
    }
}
