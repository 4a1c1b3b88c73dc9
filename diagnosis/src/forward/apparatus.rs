//! Errors of the apparatus that many runs share, and how well each is known.
//!
//! Each error is a parameter of every model, beside its coefficients, with a prior around zero: a stated standard
//! deviation, or one of [`defaults`]. An effect therefore gets no credit for what a wrong clock, scale or mass explains
//! (Kennedy & O'Hagan 2001, J. R. Stat. Soc. B 63, 425, on calibration with discrepancies that have priors).

use measurements::{Along, Condition, Kind, MeasurementSet, Role, SurfaceDefinition, median};

use crate::forward::observable::Layout;
use crate::forward::{Parameter, ParameterKind, Prior, Scatter};

/// Standard deviations where a set states none.
pub mod defaults {
    /// Zero of the clock, in frames: contact is seen at the first frame that shows it, or at the nearest.
    pub const FRAMES: f64 = 0.5;
    /// Zero of depth (m), unless its share of a grain diameter or the stated scatter of the level is larger.
    pub const ZERO: f64 = 1e-3;
    /// Zero of depth in grain diameters, if depths count from the first contact: any of the highest grains can be met first.
    pub(crate) const FIRST_GRAIN: f64 = 0.5;
    /// Zero of depth in grain diameters, if depths count from the mean height of the surface.
    pub(crate) const MEAN_OF_GRAINS: f64 = 0.25;
    /// Impact speeds, relative.
    pub const SPEED: f64 = 0.02;
    /// Angles of oblique impacts (deg).
    pub(crate) const ANGLE_DEG: f64 = 0.5;
    /// Scale of lengths, relative.
    pub const SCALE: f64 = 0.01;
    /// Mass of each body, relative.
    pub const MASS: f64 = 0.02;
    /// Direction of gravity in the plane of motion (deg).
    pub(crate) const TILT_DEG: f64 = 1.0;
    /// Resistance of one session against the others, relative.
    pub const SESSION: f64 = 0.05;
    /// Resistance of one of several beds against the first, relative, beside what its density and gravity do.
    pub const BED: f64 = 0.3;
}

/// The range of each parameter, in standard deviations of its prior.
const RANGE: f64 = 20.0;

/// Straight down (deg).
const UPRIGHT_DEG: f64 = 90.0;

/// Most that the clock of an accelerometer is off by, in its steps. At contact a reading may jump: a fit that moves the
/// contact past a reading that it uses does not find back.
const FELT: f64 = 1.4;

/// Most bodies, and most sessions, that have parameters of their own: each costs a column of every fit.
const MOST: usize = 64;

/// One kind of shared error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    Clock,
    Zero,
    /// The level of the surface, if the clock, depths and speed of each run are read where its free fall reaches that level.
    Surface,
    Speed,
    Angle,
    /// The time at which ways forward are zero: that of contact, or of the first frame that shows it.
    Start,
    Scale,
    Tilt,
    Mass {
        body: usize,
    },
    /// One coefficient, of a group of runs: those of a session, or of a bed.
    Group {
        group: usize,
        coefficient: usize,
    },
}

impl Fault {
    /// Its name in reports; of a mass and of a group, what it is, before which one is told.
    const fn name(self) -> &'static str {
        match self {
            Self::Clock => "time-zero",
            Self::Zero => "depth-zero",
            Self::Surface => "surface",
            Self::Speed => "speed-scale",
            Self::Angle => "launch-angle",
            Self::Start => "range-zero",
            Self::Scale => "camera-scale",
            Self::Tilt => "tilt",
            Self::Mass { .. } => "mass",
            Self::Group { .. } => "group",
        }
    }
}

/// Errors of which what is known beforehand holds whatever happened on the day: of a scale, a speed and directions. Zeros,
/// sessions and beds are as they happen to be.
pub(crate) fn is_of_the_instrument(name: &str) -> bool {
    [Fault::Speed, Fault::Scale, Fault::Angle, Fault::Tilt].iter().any(|one| one.name() == name)
}

/// The shared errors of one measurement set.
#[derive(Clone, Debug, Default)]
pub(crate) struct Apparatus {
    faults: Vec<Fault>,
    parameters: Vec<Parameter>,
    /// Which body falls, by condition.
    bodies: Vec<usize>,
    /// Motion of the body at the surface, by condition.
    falls: Vec<Fall>,
    /// By group of runs: its share of the runs of each condition.
    groups: Vec<Vec<f64>>,
    coefficients: usize,
}

/// Motion of a body at the surface.
#[derive(Clone, Copy, Debug)]
struct Fall {
    /// Velocity at contact, downward and forward (m/s).
    down: f64,
    forward: f64,
    /// Acceleration of the fall (m/s²).
    gravity: f64,
}

impl Fall {
    fn of(set: &MeasurementSet, condition: &Condition) -> Self {
        let angle = condition.angle_deg.to_radians();
        Self {
            down: condition.speed * libm::sin(angle),
            forward: condition.speed * libm::cos(angle),
            gravity: set.fall_of(condition),
        }
    }

    /// Adds to `scatter` that the surface lies `deeper` (m) than where the clock, depths and speed are read.
    fn add(self, scatter: &mut Scatter, deeper: f64) {
        let Self { down, forward, gravity } = self;
        // A surface that free fall never reaches is placed at the top of the fall.
        let later = (down * down + 2.0 * gravity * deeper).max(0.0).sqrt();
        let time = 2.0 * deeper / (down + later).max(f64::MIN_POSITIVE);
        let [before, after] = [down, later].map(|down| libm::hypot(down, forward));
        scatter.level += deeper;
        scatter.clock -= time;
        scatter.ahead += forward * time;
        scatter.speed += after / before.max(f64::MIN_POSITIVE) - 1.0;
        scatter.steeper += libm::atan2(later, forward) - libm::atan2(down, forward);
    }
}

impl Apparatus {
    /// Those of `set`, for a model with these `coefficients`; `layouts` are the observables of its conditions.
    pub(crate) fn of(set: &MeasurementSet, coefficients: &[&str], layouts: &[Layout]) -> Self {
        let falls = set.conditions.iter().map(|one| Fall::of(set, one)).collect();
        let mut all = Self { coefficients: coefficients.len(), falls, ..Self::default() };
        let instrument = &set.instrument;
        let or = |stated: Option<f64>, default: f64| stated.unwrap_or(default);
        // Held-out conditions must not decide which errors are fitted.
        let fitted = || {
            let each = layouts.iter().zip(&set.conditions);
            each.filter(|(_, condition)| condition.role == Role::Fit).map(|(layout, _)| layout)
        };
        let is_felt = set.kind == Kind::Acceleration;
        let is_along_time = set.kind.curve().is_some_and(|curve| curve.along == Along::Time);
        let is_timed = fitted().any(|one| one.stop_time || !one.times.is_empty() || is_along_time);
        if let Some(sigma) = clock_sigma(set).filter(|_| is_timed) {
            all.add(Fault::Clock, "s", sigma);
            if let Some(frame) = frame(set).filter(|_| is_felt) {
                all.confine_last(FELT * frame);
            }
        }
        let level = instrument.level_sigma.unwrap_or(0.0);
        let grain = set.coarsest_grains()
            * match set.surface {
                SurfaceDefinition::FirstContact => defaults::FIRST_GRAIN,
                SurfaceDefinition::Mean => defaults::MEAN_OF_GRAINS,
            };
        // Depths that count from the point where free fall reaches the surface have no other zero.
        let unstated = match instrument.surface_sigma {
            Some(_) => 0.0,
            None => defaults::ZERO.max(grain).max(level),
        };
        all.add(Fault::Zero, "m", or(instrument.zero_sigma, unstated));
        all.add(Fault::Surface, "m", or(instrument.surface_sigma, 0.0));
        let speed = or(instrument.speed_bias_sigma_rel, defaults::SPEED);
        all.add(Fault::Speed, "1", speed);
        let has_ways = fitted().any(|one| one.along_x || one.final_x);
        let is_oblique = |one: &Condition| one.role == Role::Fit && one.angle_deg < UPRIGHT_DEG;
        let is_oblique = set.conditions.iter().any(is_oblique);
        if is_oblique || has_ways {
            let angle = or(instrument.angle_bias_sigma_deg, defaults::ANGLE_DEG).to_radians();
            all.add(Fault::Angle, "rad", angle);
        }
        all.add(Fault::Scale, "1", or(instrument.scale_sigma_rel, defaults::SCALE));
        if let Some(sigma) = clock_sigma(set).filter(|_| has_ways && is_oblique) {
            all.add(Fault::Start, "s", sigma);
        }
        // Depth alone depends on the tilt to second order only.
        if has_ways {
            let tilt = or(instrument.tilt_sigma_deg, defaults::TILT_DEG).to_radians();
            all.add(Fault::Tilt, "rad", tilt);
        }
        // A drive moves any mass alike.
        if set.kind != Kind::ForceDepth {
            all.add_bodies(set, or(instrument.mass_sigma_rel, defaults::MASS));
        }
        all.add_sessions(set, coefficients, or(instrument.session_sigma_rel, defaults::SESSION));
        all.add_beds(set, coefficients);
        all
    }

    fn add(&mut self, fault: Fault, unit: &str, sigma: f64) {
        self.add_named(fault, fault.name().to_owned(), unit, sigma);
    }

    fn add_named(&mut self, fault: Fault, name: String, unit: &str, sigma: f64) {
        // A stated zero means that the quantity is exact.
        if sigma > 0.0 && sigma.is_finite() {
            self.faults.push(fault);
            self.parameters.push(Parameter {
                name,
                unit: unit.to_owned(),
                start: 0.0,
                min: -RANGE * sigma,
                max: RANGE * sigma,
                prior: Some(Prior { mean: 0.0, sigma }),
                kind: ParameterKind::Apparatus,
            });
        }
    }

    /// Confines the last parameter to this size.
    fn confine_last(&mut self, size: f64) {
        if let Some(last) = self.parameters.last_mut() {
            (last.min, last.max) = (last.min.max(-size), last.max.min(size));
        }
    }

    fn add_bodies(&mut self, set: &MeasurementSet, sigma: f64) {
        let (bodies, which) = bodies(set);
        self.bodies = which;
        if bodies.len() > MOST {
            return;
        }
        for (body, first) in bodies.iter().enumerate() {
            let (shape, diameter, mass) = (&first.shape, 1e3 * first.diameter, 1e3 * first.mass);
            let name = format!(
                "{} ({shape} of {} mm, {} g)",
                Fault::Mass { body }.name(),
                plots::rounded(diameter, 4),
                plots::rounded(mass, 4)
            );
            self.add_named(Fault::Mass { body }, name, "1", sigma);
        }
    }

    /// A change of each coefficient for a group of runs (what it is, and its name), which `shares` of each condition are in.
    fn add_group(
        &mut self,
        (what, name): (&str, &str),
        shares: Vec<f64>,
        coefficients: &[&str],
        sigma: f64,
    ) {
        let group = self.groups.len();
        self.groups.push(shares);
        for (coefficient, key) in coefficients.iter().enumerate() {
            let fault = Fault::Group { group, coefficient };
            self.add_named(fault, format!("{what} ({name}, {key})"), "1", sigma);
        }
    }

    fn add_sessions(&mut self, set: &MeasurementSet, coefficients: &[&str], sigma: f64) {
        let names = sessions(set);
        if names.len() < 2 || names.len() > MOST {
            return;
        }
        let mut counts = vec![0.0; set.conditions.len()];
        for run in &set.runs {
            counts[run.condition] += 1.0;
        }
        for name in names {
            let mut shares = vec![0.0; set.conditions.len()];
            for run in set.runs.iter().filter(|run| run.session.as_deref() == Some(name)) {
                shares[run.condition] += 1.0 / counts[run.condition];
            }
            self.add_group(("session", name), shares, coefficients, sigma);
        }
    }

    /// Coefficients are those of the first bed; each other one has a term of its own beside them, because grains of another
    /// shape or surface resist otherwise.
    fn add_beds(&mut self, set: &MeasurementSet, coefficients: &[&str]) {
        if set.beds.len() > MOST {
            return;
        }
        for (bed, named) in set.beds.iter().enumerate().skip(1) {
            let is_in = |one: &Condition| f64::from(u8::from(one.bed == Some(bed)));
            let shares = set.conditions.iter().map(is_in).collect();
            self.add_group(("bed", &named.name), shares, coefficients, defaults::BED);
        }
    }

    /// The parameters; [`Apparatus::added_to`] takes their values in this order.
    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// `scatter` of a run under `condition`, with the shared errors `values` added.
    pub(crate) fn added_to(&self, scatter: &Scatter, condition: usize, values: &[f64]) -> Scatter {
        let mut all = scatter.clone();
        for (fault, &value) in self.faults.iter().zip(values) {
            match *fault {
                Fault::Clock => all.clock += value,
                Fault::Zero => all.level += value,
                Fault::Surface => self.falls[condition].add(&mut all, value),
                Fault::Speed => all.speed += value,
                Fault::Angle => all.steeper += value,
                Fault::Start => all.start += value,
                Fault::Scale => all.scale += value,
                Fault::Tilt => all.tilt += value,
                Fault::Mass { body } if self.bodies.get(condition) == Some(&body) => {
                    all.mass += value;
                }
                Fault::Mass { .. } => (),
                Fault::Group { group, coefficient } => {
                    let share = self.groups[group][condition];
                    if share > 0.0 {
                        all.coefficients.resize(self.coefficients, 0.0);
                        all.coefficients[coefficient] += share * value;
                    }
                }
            }
        }
        all
    }
}

/// The sessions of `set`, sorted.
fn sessions(set: &MeasurementSet) -> Vec<&str> {
    let mut names: Vec<&str> = set.runs.iter().filter_map(|run| run.session.as_deref()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The distinct bodies of `set`, and which of them falls in each condition.
fn bodies(set: &MeasurementSet) -> (Vec<&Condition>, Vec<usize>) {
    let mut bodies: Vec<&Condition> = Vec::new();
    let mut which = Vec::with_capacity(set.conditions.len());
    for condition in &set.conditions {
        let known = bodies.iter().position(|body| is_same_body(body, condition));
        which.push(known.unwrap_or(bodies.len()));
        if known.is_none() {
            bodies.push(condition);
        }
    }
    (bodies, which)
}

/// Which shared errors of `set` are too many to be fitted, in sentences.
pub(crate) fn too_many(set: &MeasurementSet) -> Vec<String> {
    let counts = [
        (sessions(set).len(), "sessions"),
        (bodies(set).0.len(), "bodies"),
        (set.beds.len(), "beds"),
    ];
    let sentence = |&(count, what): &(usize, &str)| {
        (count > MOST)
            .then(|| format!("{count} {what}: their own errors are fitted for up to {MOST}"))
    };
    counts.iter().filter_map(sentence).collect()
}

/// Whether the effect called `name` is a shared error that every fit includes; `set` excludes it by a standard deviation
/// of zero.
pub(crate) fn is_looked_for(set: &MeasurementSet, name: &str) -> bool {
    let instrument = &set.instrument;
    let stated = [
        (Fault::Scale, instrument.scale_sigma_rel),
        (Fault::Zero, instrument.zero_sigma),
        (Fault::Tilt, instrument.tilt_sigma_deg),
    ];
    stated.iter().any(|(fault, sigma)| fault.name() == name && *sigma != Some(0.0))
}

/// Standard deviation of the zero of the clock (s); none where no time is read from a clip.
fn clock_sigma(set: &MeasurementSet) -> Option<f64> {
    if set.instrument.time_sigma.is_some() {
        return set.instrument.time_sigma;
    }
    frame(set).map(|frame| defaults::FRAMES * frame)
}

/// Time between two readings (s).
fn frame(set: &MeasurementSet) -> Option<f64> {
    let frame = set.instrument.rate.filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate);
    match set.kind {
        Kind::Trajectory => frame.or_else(|| {
            let steps = set.runs.iter().flat_map(|run| run.frames.windows(2));
            median(steps.map(|pair| pair[1].t - pair[0].t))
        }),
        Kind::Scalar | Kind::ForceDepth => frame,
        Kind::Acceleration | Kind::Velocity | Kind::Spin => frame.or_else(|| {
            let steps = set.runs.iter().flat_map(|run| run.samples.windows(2));
            median(steps.map(|pair| pair[1].at - pair[0].at))
        }),
    }
}

fn is_same_body(one: &Condition, other: &Condition) -> bool {
    one.shape == other.shape
        && one.diameter.total_cmp(&other.diameter).is_eq()
        && one.mass.total_cmp(&other.mass).is_eq()
        && one.length == other.length
        && one.height == other.height
        && one.shaft_diameter == other.shaft_diameter
        && one.apex_deg == other.apex_deg
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::{NamedBed, Run};

    fn before(change: impl Fn(&mut MeasurementSet)) -> (MeasurementSet, Apparatus) {
        let conditions = vec![condition(1.0, 90.0), condition(2.0, 60.0)];
        let runs = [0, 0, 1, 1].map(|at| scalar_run(at, [Some(0.1), Some(0.05), Some(0.01)]));
        let mut set = set(Kind::Scalar, conditions, runs.into());
        change(&mut set);
        let layout = Layout { stop_time: true, final_z: true, final_x: true, ..Layout::default() };
        let apparatus = Apparatus::of(&set, &["drag", "friction"], &[layout.clone(), layout]);
        (set, apparatus)
    }

    fn sigma(apparatus: &Apparatus, name: &str) -> Option<f64> {
        let mut all = apparatus.parameters().iter();
        all.find(|one| one.name == name).and_then(|one| Some(one.prior?.sigma))
    }

    #[test]
    fn a_surface_that_lies_deeper_leaves_the_fall_where_it_is() {
        let fall = Fall { down: 1.5, forward: 0.7, gravity: 9.81 };
        for deeper in [-3e-3, 2e-3] {
            let mut scatter = Scatter::default();
            fall.add(&mut scatter, deeper);
            let speed = (1.0 + scatter.speed) * libm::hypot(fall.down, fall.forward);
            let angle = libm::atan2(fall.down, fall.forward) + scatter.steeper;
            let [down, forward] = [libm::sin(angle), libm::cos(angle)].map(|part| speed * part);
            for t in [-0.02, 0.0, 0.005] {
                let since = t + scatter.clock;
                let depth = scatter.level + since * (down + 0.5 * fall.gravity * since);
                assert!((depth - t * (fall.down + 0.5 * fall.gravity * t)).abs() < 1e-12, "{t}");
                let way = scatter.ahead + forward * since;
                assert!((way - fall.forward * t).abs() < 1e-12, "{t}");
            }
        }
        let (_, read) = before(|set| set.instrument.surface_sigma = Some(2e-3));
        assert_eq!(sigma(&read, "surface"), Some(2e-3));
        assert_eq!(sigma(&read, "depth-zero"), None);
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

    #[test]
    fn one_of_several_beds_resists_otherwise_in_its_own_conditions() {
        let (set, apparatus) = before(|set| {
            let named = |name: &str| NamedBed { name: name.to_owned(), bed: set.bed };
            set.beds = vec![named("sand"), named("beads")];
            (set.conditions[0].bed, set.conditions[1].bed) = (Some(0), Some(1));
        });
        let name = "bed (beads, friction)";
        assert_eq!(sigma(&apparatus, name), Some(defaults::BED));
        let at = apparatus.parameters().iter().position(|one| one.name == name);
        let mut values = vec![0.0; apparatus.parameters().len()];
        values[at.expect("it is looked for")] = 0.2;
        let of = |c: usize| apparatus.added_to(&Scatter::default(), c, &values).coefficients;
        assert!(of(0).iter().all(|value| value.abs() < 1e-15));
        assert_eq!(of(1), [0.0, 0.2]);
        assert!(too_many(&set).is_empty() && sigma(&apparatus, "bed (sand, friction)").is_none());
        let (_, one) = before(|set| {
            set.beds = vec![NamedBed { name: "sand".to_owned(), bed: set.bed }];
        });
        assert!(sigma(&one, "bed (sand, friction)").is_none());
    }

    #[test]
    fn a_session_for_every_run_is_too_many_and_is_said() {
        let (set, apparatus) = before(|set| {
            let one = set.runs[0].clone();
            set.runs = (0..=MOST)
                .map(|at| Run { session: Some(format!("s{at}")), ..one.clone() })
                .collect();
        });
        assert!(!apparatus.parameters().iter().any(|one| one.name.starts_with("session")));
        assert_eq!(too_many(&set), ["65 sessions: their own errors are fitted for up to 64"]);
    }
}
