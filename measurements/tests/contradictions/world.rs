//! A laboratory of its own: spheres that fall into sand before a camera, well or badly read.

use measurements::{
    Bed, Condition, Frame, Geometry, Instrument, Kind, MeasurementSet, Run, StopDefinition,
};
use rand::RngExt;
use rand_pcg::Pcg64;

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 1480.0;
/// Of the sphere (m).
pub(crate) const DIAMETER: f64 = 0.0254;

/// What is measured, how well, and what is read wrong.
#[derive(Clone, Debug)]
pub(crate) struct Laboratory {
    /// Speed (m/s) and angle (deg) of each condition.
    pub(crate) settings: Vec<(f64, f64)>,
    pub(crate) repeats: usize,
    /// Frames per second (1/s), and how many come before contact and after the stop.
    pub(crate) rate: f64,
    pub(crate) before: usize,
    pub(crate) after: usize,
    /// Whether contact falls anywhere between two frames and the clock is set to it, else a frame is at it.
    pub(crate) between_frames: bool,
    /// Error of a reading (m), of the level (m), of the speed (relative), of coefficients (relative).
    pub(crate) camera: f64,
    pub(crate) level: f64,
    pub(crate) speed: f64,
    pub(crate) scatter: f64,
    /// Mass of the sphere (kg).
    pub(crate) mass: f64,
    /// Coefficients of drag and friction, and a constant resistance in parts of the weight.
    pub(crate) drag: f64,
    pub(crate) friction: f64,
    pub(crate) constant: f64,
    /// Share of gravity that a guide takes.
    pub(crate) guide: f64,
    /// What stopping times and final depths are.
    pub(crate) stop: StopDefinition,
    /// Contact on the clock of the tables (s), depth of the surface on their scale (m).
    pub(crate) clock: f64,
    pub(crate) surface: f64,
    /// What positions are multiplied with, and stated speeds.
    pub(crate) scale: f64,
    pub(crate) stated_speed: f64,
}

impl Default for Laboratory {
    fn default() -> Self {
        Self {
            settings: vec![(0.8, 90.0), (1.4, 90.0), (2.0, 90.0), (2.8, 90.0)],
            repeats: 3,
            rate: 650.0,
            before: 10,
            after: 20,
            between_frames: true,
            camera: 1e-4,
            level: 2e-4,
            speed: 0.01,
            scatter: 0.05,
            mass: 0.0667,
            drag: 1.2,
            friction: 12.0,
            constant: 0.0,
            guide: 0.0,
            stop: StopDefinition::ComponentZero,
            clock: 0.0,
            surface: 0.0,
            scale: 1.0,
            stated_speed: 1.0,
        }
    }
}

/// Depth, range and their velocities (m, m/s).
type State = [f64; 4];

/// Step of the integration (s).
const STEP: f64 = 1e-4;

impl Laboratory {
    /// The measurements, drawn with `seed`.
    pub(crate) fn measure(&self, seed: u64) -> MeasurementSet {
        let mut random = Pcg64::new(u128::from(seed), 7);
        let mut runs = Vec::new();
        for condition in 0..self.settings.len() {
            for repeat in 0..self.repeats {
                runs.push(self.run(condition, repeat, &mut random));
            }
        }
        let conditions = self.settings.iter().enumerate();
        MeasurementSet {
            instrument: Instrument {
                rate: Some(self.rate),
                position_sigma: Some(self.camera),
                speed_sigma_rel: Some(self.speed),
                level_sigma: Some(self.level),
                ..Instrument::default()
            },
            stop: self.stop,
            runs,
            ..MeasurementSet::new(
                "world",
                Kind::Trajectory,
                Bed {
                    grain_diameter: Some(8e-4),
                    ..Bed::new(Geometry::Spatial, Some(DENSITY), GRAVITY)
                },
                conditions.map(|(at, setting)| self.condition(at, *setting)).collect(),
            )
        }
    }

    fn condition(&self, at: usize, (speed, angle_deg): (f64, f64)) -> Condition {
        Condition {
            angle_deg,
            ..Condition::straight_down(
                format!("c{at:02}"),
                ("sphere", DIAMETER, self.mass),
                self.stated_speed * speed,
            )
        }
    }

    fn run(&self, condition: usize, repeat: usize, random: &mut Pcg64) -> Run {
        let (speed, angle) = self.settings[condition];
        let speed = speed * (1.0 + self.speed * normal(random));
        let factor = libm::exp(self.scatter * normal(random));
        let (sine, cosine) = libm::sincos(angle.to_radians());
        let cosine = if angle < 90.0 { cosine } else { 0.0 };
        let start = [0.0, 0.0, speed * sine, speed * cosine];
        let path = self.path(start, factor);
        let end = path.len() as f64 * STEP;
        let first_below = |most: f64| {
            let at = path.iter().position(|s| libm::hypot(s[2], s[3]) < most);
            at.map_or(end, |at| at as f64 * STEP)
        };
        let stop_time = match self.stop {
            StopDefinition::ComponentZero => end,
            StopDefinition::SpeedFivePercent => first_below(0.05 * speed),
        };
        let phase = if self.between_frames { random.random::<f64>() } else { 0.0 };
        let level = self.level * normal(random);
        let mut read = |value: f64| self.scale * (value + self.camera * normal(random));
        let last = (end * self.rate) as i64 + self.after as i64;
        let at = |t: f64| match t < 0.0 {
            true => [start[2] * t + 0.5 * (1.0 - self.guide) * GRAVITY * t * t, start[3] * t],
            false => {
                let state = path[((t / STEP) as usize).min(path.len() - 1)];
                let rest = if t >= end { 0.0 } else { t % STEP };
                [state[0] + state[2] * rest, state[1] + state[3] * rest]
            }
        };
        let frames = (-(self.before as i64)..=last)
            .map(|frame| {
                let t = (frame as f64 - phase + f64::from(u8::from(phase > 0.0))) / self.rate;
                let [z, x] = at(t);
                let z = read(z + level + self.surface);
                Frame { t: t + self.clock, z, x: read(x), sigma: None }
            })
            .collect();
        let rest = path[path.len() - 1];
        let late = (random.random::<f64>() - 0.5) / self.rate;
        Run {
            repeat: Some(repeat as i64),
            stop_time: Some(stop_time + late),
            final_z: Some(rest[0] + level + self.camera * normal(random)),
            final_x: (angle < 90.0).then_some(rest[1]),
            frames,
            ..Run::new(format!("{condition}-{repeat}"), condition)
        }
    }

    /// From contact to rest, a state per step.
    fn path(&self, start: State, factor: f64) -> Vec<State> {
        let mut states = vec![start];
        while states.len() < 20_000 {
            let state = states[states.len() - 1];
            let middle = advance(state, self.acceleration(state, factor), 0.5 * STEP);
            let next = advance(state, self.acceleration(middle, factor), STEP);
            let turns = next[2] * state[2] + next[3] * state[3] <= 0.0;
            if turns || libm::hypot(next[2], next[3]) < 2e-3 {
                states.push([next[0], next[1], 0.0, 0.0]);
                break;
            }
            states.push(next);
        }
        states
    }

    fn acceleration(&self, [z, _, vz, vx]: State, factor: f64) -> [f64; 2] {
        let speed = libm::hypot(vz, vx).max(1e-9);
        let cap = z.clamp(0.0, 0.5 * DIAMETER);
        let area = std::f64::consts::PI * cap * (DIAMETER - cap);
        let load = DENSITY * GRAVITY * area;
        let resistance = factor
            * (self.drag * DENSITY * area * speed * speed
                + self.friction * load * z.max(0.0)
                + self.constant * self.mass * GRAVITY * f64::from(u8::from(z > 0.0)));
        let along = resistance / self.mass / speed;
        [(1.0 - self.guide) * GRAVITY - along * vz, -along * vx]
    }
}

fn advance(state: State, [az, ax]: [f64; 2], step: f64) -> State {
    [
        state[0] + step * (state[2] + 0.5 * step * az),
        state[1] + step * (state[3] + 0.5 * step * ax),
        state[2] + step * az,
        state[3] + step * ax,
    ]
}

pub(crate) fn normal(random: &mut Pcg64) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - random.random::<f64>())).sqrt();
    radius * libm::cos(std::f64::consts::TAU * random.random::<f64>())
}
