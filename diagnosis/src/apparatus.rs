//! What the apparatus may have wrong in many runs alike, and how well that is known.
//!
//! Each is a parameter of every model, beside its coefficients, with a prior around zero: a stated standard deviation,
//! or one of [`defaults`]. So no effect is credited with what a clock, a scale or a balance explains as well
//! (Kennedy & O'Hagan 2001, J. R. Stat. Soc. B 63, 425, on calibration with discrepancies that have priors).

use measurements::{Condition, Kind, MeasurementSet, Role};

use crate::forward::{Parameter, ParameterKind, Prior, Scatter};
use crate::observable::Layout;

/// Standard deviations where a set states none.
pub mod defaults {
    /// Zero of the clock, in frames: contact is seen at the first frame that shows it, or at the nearest.
    pub const FRAMES: f64 = 0.5;
    /// Zero of depth (m), unless half a grain or the stated scatter of the level is more.
    pub const ZERO: f64 = 1e-3;
    /// Impact speeds, relative.
    pub const SPEED: f64 = 0.02;
    /// Scale of lengths, relative.
    pub const SCALE: f64 = 0.01;
    /// Mass of each body, relative.
    pub const MASS: f64 = 0.02;
    /// Direction of gravity in the plane of motion (deg).
    pub const TILT_DEG: f64 = 1.0;
    /// Resistance of one session against the others, relative.
    pub const SESSION: f64 = 0.05;
}

/// Beyond so many standard deviations of its prior, nothing is looked for.
const RANGE: f64 = 20.0;

/// Something that may be wrong in many runs alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    Clock,
    Zero,
    Speed,
    Scale,
    Tilt,
    Mass { body: usize },
    Session { session: usize, coefficient: usize },
}

/// What may be wrong before one set.
#[derive(Clone, Debug, Default)]
pub(crate) struct Apparatus {
    faults: Vec<Fault>,
    parameters: Vec<Parameter>,
    /// Which body falls, by condition.
    bodies: Vec<usize>,
    /// Share of the runs of each condition in each session.
    sessions: Vec<Vec<f64>>,
    coefficients: usize,
}

impl Apparatus {
    /// Before `set`, whose model has these `coefficients` and whose observables are `layouts`.
    pub(crate) fn of(set: &MeasurementSet, coefficients: &[&str], layouts: &[Layout]) -> Self {
        let mut all = Self { coefficients: coefficients.len(), ..Self::default() };
        let instrument = &set.instrument;
        let or = |stated: Option<f64>, default: f64| stated.unwrap_or(default);
        // What is held out chooses nothing, not even what is looked for.
        let fitted = || {
            let each = layouts.iter().zip(&set.conditions);
            each.filter(|(_, condition)| condition.role == Role::Fit).map(|(layout, _)| layout)
        };
        let is_timed = fitted().any(|one| one.stop_time || !one.times.is_empty());
        if let Some(sigma) = clock_sigma(set).filter(|_| is_timed) {
            all.add(Fault::Clock, "time-zero", "s", sigma);
        }
        let level = instrument.level_sigma.unwrap_or(0.0);
        let grain = 0.5 * set.bed.grain_diameter.unwrap_or(0.0);
        let zero = or(instrument.zero_sigma, defaults::ZERO.max(grain).max(level));
        all.add(Fault::Zero, "depth-zero", "m", zero);
        let speed = or(instrument.speed_bias_sigma_rel, defaults::SPEED);
        all.add(Fault::Speed, "speed-scale", "1", speed);
        all.add(Fault::Scale, "camera-scale", "1", or(instrument.scale_sigma_rel, defaults::SCALE));
        // Straight down and seen from where it leans to, gravity that leans is as good as upright.
        if fitted().any(|one| one.along_x || one.final_x) {
            let tilt = or(instrument.tilt_sigma_deg, defaults::TILT_DEG).to_radians();
            all.add(Fault::Tilt, "tilt", "rad", tilt);
        }
        all.add_bodies(set, or(instrument.mass_sigma_rel, defaults::MASS));
        all.add_sessions(set, coefficients, or(instrument.session_sigma_rel, defaults::SESSION));
        all
    }

    fn add(&mut self, fault: Fault, name: impl Into<String>, unit: &str, sigma: f64) {
        // A stated zero says that it is exact.
        if sigma > 0.0 && sigma.is_finite() {
            self.faults.push(fault);
            self.parameters.push(Parameter {
                name: name.into(),
                unit: unit.to_owned(),
                start: 0.0,
                min: -RANGE * sigma,
                max: RANGE * sigma,
                prior: Some(Prior { mean: 0.0, sigma }),
                kind: ParameterKind::Apparatus,
            });
        }
    }

    fn add_bodies(&mut self, set: &MeasurementSet, sigma: f64) {
        let mut bodies: Vec<&Condition> = Vec::new();
        for condition in &set.conditions {
            let known = bodies.iter().position(|body| is_same_body(body, condition));
            self.bodies.push(known.unwrap_or(bodies.len()));
            if known.is_none() {
                bodies.push(condition);
            }
        }
        for (body, first) in bodies.iter().enumerate() {
            let (shape, diameter, mass) = (&first.shape, 1e3 * first.diameter, 1e3 * first.mass);
            let name =
                format!("mass ({shape} of {} mm, {} g)", four_digits(diameter), four_digits(mass));
            self.add(Fault::Mass { body }, name, "1", sigma);
        }
    }

    fn add_sessions(&mut self, set: &MeasurementSet, coefficients: &[&str], sigma: f64) {
        let mut names: Vec<&str> = set.runs.iter().filter_map(|r| r.session.as_deref()).collect();
        names.sort_unstable();
        names.dedup();
        if names.len() < 2 {
            return;
        }
        self.sessions = (0..set.conditions.len())
            .map(|condition| {
                let runs = || set.runs.iter().filter(move |run| run.condition == condition);
                let all = runs().count().max(1) as f64;
                let of = |name: &str| runs().filter(|r| r.session.as_deref() == Some(name)).count();
                names.iter().map(|name| of(name) as f64 / all).collect()
            })
            .collect();
        for (session, name) in names.iter().enumerate() {
            for (coefficient, key) in coefficients.iter().enumerate() {
                let fault = Fault::Session { session, coefficient };
                self.add(fault, format!("session ({name}, {key})"), "1", sigma);
            }
        }
    }

    /// The parameters, in an order of their own.
    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// `scatter` of a run under `condition` with these `values` of the parameters beside it.
    pub(crate) fn added_to(&self, scatter: &Scatter, condition: usize, values: &[f64]) -> Scatter {
        let mut all = scatter.clone();
        for (fault, &value) in self.faults.iter().zip(values) {
            match *fault {
                Fault::Clock => all.clock += value,
                Fault::Zero => all.level += value,
                Fault::Speed => all.speed += value,
                Fault::Scale => all.scale += value,
                Fault::Tilt => all.tilt += value,
                Fault::Mass { body } if self.bodies.get(condition) == Some(&body) => {
                    all.mass += value;
                }
                Fault::Mass { .. } => (),
                Fault::Session { session, coefficient } => {
                    let share = self.sessions.get(condition).map_or(0.0, |all| all[session]);
                    all.coefficients.resize(self.coefficients, 0.0);
                    all.coefficients[coefficient] += share * value;
                }
            }
        }
        all
    }
}

/// Whether the effect called `name` is an error of the apparatus that is looked for beside every effect: one that `set`
/// does not say to be absent.
pub(crate) fn is_looked_for(set: &MeasurementSet, name: &str) -> bool {
    let instrument = &set.instrument;
    let stated = match name {
        "camera-scale" => instrument.scale_sigma_rel,
        "depth-zero" => instrument.zero_sigma,
        "tilt" => instrument.tilt_sigma_deg,
        _ => return false,
    };
    stated != Some(0.0)
}

/// Standard deviation of the zero of the clock (s); none where no time is read from a clip.
fn clock_sigma(set: &MeasurementSet) -> Option<f64> {
    if set.instrument.time_sigma.is_some() {
        return set.instrument.time_sigma;
    }
    let frame = set.instrument.rate.filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate);
    let interval = || {
        let steps = set.runs.iter().flat_map(|run| run.frames.windows(2));
        let mut steps: Vec<f64> = steps.map(|pair| pair[1].t - pair[0].t).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied()
    };
    let frame = match set.kind {
        Kind::Trajectory => frame.or_else(interval),
        Kind::Scalar => frame,
    };
    frame.map(|frame| defaults::FRAMES * frame)
}

/// `value` to four digits, without zeros at its end.
fn four_digits(value: f64) -> f64 {
    let digits = libm::log10(value.abs().max(f64::MIN_POSITIVE)).floor() as i32;
    let size = 10f64.powi(3 - digits);
    (value * size).round() / size
}

fn is_same_body(one: &Condition, other: &Condition) -> bool {
    one.shape == other.shape
        && one.diameter.total_cmp(&other.diameter).is_eq()
        && one.mass.total_cmp(&other.mass).is_eq()
        && one.length == other.length
        && one.height == other.height
        && one.apex_deg == other.apex_deg
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set};

    fn before(change: impl Fn(&mut MeasurementSet)) -> (MeasurementSet, Apparatus) {
        let conditions = vec![condition(1.0, 90.0), condition(2.0, 60.0)];
        let runs = [0, 0, 1, 1].map(|at| scalar_run(at, [Some(0.1), Some(0.05), Some(0.01)]));
        let mut set = set(Kind::Scalar, conditions, runs.into());
        change(&mut set);
        let layout = Layout {
            times: Vec::new(),
            along_x: false,
            stop_time: true,
            final_z: true,
            final_x: true,
        };
        let apparatus = Apparatus::of(&set, &["drag", "friction"], &[layout.clone(), layout]);
        (set, apparatus)
    }

    fn sigma(apparatus: &Apparatus, name: &str) -> Option<f64> {
        let mut all = apparatus.parameters().iter();
        all.find(|one| one.name == name).and_then(|one| Some(one.prior?.sigma))
    }

    #[test]
    fn what_is_stated_stands_before_what_is_usual_and_zero_says_exact() {
        let (_, usual) = before(|_| ());
        // Half of a frame of 500 Hz; the grains of 0.8 mm and the level of 0.2 mm are finer than 1 mm.
        assert_eq!(sigma(&usual, "time-zero"), Some(1e-3));
        assert_eq!(sigma(&usual, "depth-zero"), Some(1e-3));
        assert_eq!(sigma(&usual, "camera-scale"), Some(defaults::SCALE));
        let (_, stated) = before(|set| {
            set.instrument.time_sigma = Some(2e-4);
            set.instrument.scale_sigma_rel = Some(0.0);
        });
        assert_eq!(sigma(&stated, "time-zero"), Some(2e-4));
        assert!(
            sigma(&stated, "camera-scale").is_none() && sigma(&stated, "speed-scale").is_some()
        );
        let (_, exact) = before(|set| set.instrument = set.instrument.without_shared_errors());
        assert!(exact.parameters().is_empty(), "{exact:?}");
    }

    #[test]
    fn each_error_reaches_the_runs_that_share_it() {
        let (_, apparatus) = before(|set| {
            set.conditions[1].mass *= 2.0;
            for (run, name) in set.runs.iter_mut().zip(["a", "b", "b", "b"]) {
                run.session = Some(name.into());
            }
        });
        let at = |name: &str| apparatus.parameters().iter().position(|one| one.name == name);
        let alone = |name: &str, condition: usize| {
            let mut values = vec![0.0; apparatus.parameters().len()];
            values[at(name).expect("it is looked for")] = 0.01;
            apparatus.added_to(&Scatter::default(), condition, &values)
        };
        let are = |values: [f64; 2], expected: [f64; 2]| {
            values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-15)
        };
        assert!(are([0, 1].map(|c| alone("speed-scale", c).speed), [0.01; 2]));
        let body = apparatus.parameters().iter().find(|one| one.name.starts_with("mass ("));
        let body = body.map(|one| one.name.clone()).expect("a body");
        assert!(are([0, 1].map(|c| alone(&body, c).mass), [0.01, 0.0]));
        // Half of the runs of the first condition, and all of the second, are of session b.
        let of_b = [0, 1].map(|c| alone("session (b, friction)", c).coefficients[1]);
        assert!(are(of_b, [0.005, 0.01]));
    }
}
