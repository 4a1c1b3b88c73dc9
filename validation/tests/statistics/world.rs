//! A small world of its own: a sphere in a bed, with effects that can be hidden in it. It shares no
//! code with the models that ship.

use diagnosis::forward::observable::Layout;
use diagnosis::forward::{
    Candidate, Forward, Parameter, ParameterKind, PredictError, Request, Scatter,
};

/// Bulk density of the bed (kg/m³).
const DENSITY: f64 = 1480.0;
pub(crate) const GRAVITY: f64 = 9.81;

/// What a condition sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// (m/s)
    pub(crate) speed: f64,
    /// (deg)
    pub(crate) angle: f64,
    /// (kg)
    pub(crate) mass: f64,
    /// (m)
    pub(crate) diameter: f64,
}

/// Coefficients of drag and of friction.
pub(crate) const TRUTH: [f64; 2] = [1.2, 12.0];

/// What can be added to the two-term law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect {
    Viscous,
    Yield,
    DepthExponent,
    Buoyancy,
    DepthDrag,
    Lift,
    /// Weight taken away, in parts of it.
    LessWeight,
    /// Mass added, in parts of it.
    MoreMass,
    /// In no list: friction that is higher around one depth.
    Layer,
    /// In no list: drag that saturates at a speed (m/s).
    Saturation,
}

impl Effect {
    pub(crate) const LISTED: [Self; 6] = [
        Self::Viscous,
        Self::Yield,
        Self::DepthExponent,
        Self::Buoyancy,
        Self::DepthDrag,
        Self::Lift,
    ];

    pub(crate) fn id(self) -> &'static str {
        match self {
            Self::Viscous => "viscous-drag",
            Self::Yield => "yield-stress",
            Self::DepthExponent => "depth-exponent",
            Self::Buoyancy => "buoyancy",
            Self::DepthDrag => "depth-drag",
            Self::Lift => "lift",
            Self::LessWeight => "less-weight",
            Self::MoreMass => "more-mass",
            Self::Layer => "layer",
            Self::Saturation => "saturation",
        }
    }
}

/// One run: the force on the sphere, and how it is integrated.
pub(crate) struct Impact<'a> {
    pub(crate) setting: Setting,
    pub(crate) coefficients: [f64; 2],
    pub(crate) effects: &'a [(Effect, f64)],
    /// Relative speed error, level (m).
    pub(crate) speed: f64,
    pub(crate) level: f64,
    /// Nodes of the force multiplier and of the sideways force, and the depth of the last (m).
    pub(crate) along: &'a [f64],
    pub(crate) sideways: &'a [f64],
    pub(crate) reach: f64,
}

/// Depth, range, and their velocities (m, m/s).
type State = [f64; 4];

/// A path by the ends of its steps.
pub(crate) struct Path {
    step: f64,
    states: Vec<State>,
    pub(crate) stop_time: f64,
    pub(crate) stop: (f64, f64),
}

impl Impact<'_> {
    fn launch(&self) -> State {
        let (sin, cos) = libm::sincos(self.setting.angle.to_radians());
        let speed = self.setting.speed * (1.0 + self.speed);
        [0.0, 0.0, speed * sin, speed * cos]
    }

    fn acceleration(&self, [z, _, vz, vx]: State) -> [f64; 2] {
        let Setting { mass, diameter, .. } = self.setting;
        let depth = (z - self.level).max(0.0);
        let v = libm::hypot(vz, vx).max(1e-9);
        let has = |effect| {
            self.effects.iter().filter(|(e, _)| *e == effect).map(|(_, q)| *q).sum::<f64>()
        };
        let mut less_weight = has(Effect::LessWeight);
        let inertia = 1.0 + has(Effect::MoreMass);
        let mut resistance = 0.0;
        let mut normal = 0.0;
        if depth > 0.0 {
            let area = std::f64::consts::FRAC_PI_4 * diameter * diameter;
            let load = DENSITY * GRAVITY * area;
            let scaled = libm::pow(depth / diameter, 1.0 + has(Effect::DepthExponent)) * diameter;
            let drag = self.coefficients[0] * (1.0 + has(Effect::DepthDrag) * depth / diameter);
            let layer = has(Effect::Layer) * libm::exp(-((depth - 0.012) / 0.004).powi(2));
            let saturates = match has(Effect::Saturation) {
                speed if speed > 0.0 => 1.0 / (1.0 + (v / speed).powi(2)),
                _ => 1.0,
            };
            resistance = saturates * drag * DENSITY * area * v * v
                + self.coefficients[1] * load * scaled * (1.0 + layer)
                + has(Effect::Viscous) * DENSITY * area * (GRAVITY * diameter).sqrt() * v
                + has(Effect::Yield) * load * diameter;
            resistance *= 1.0 + at_depth(self.along, depth, self.reach);
            normal = resistance * at_depth(self.sideways, depth, self.reach)
                + has(Effect::Lift) * DENSITY * area * v * v;
            let cap = depth.min(diameter);
            let volume = std::f64::consts::PI * cap * cap * (0.5 * diameter - cap / 3.0);
            less_weight += has(Effect::Buoyancy) * DENSITY * volume / mass;
        }
        let (along, across) = (resistance / mass / v, normal / mass / v);
        [
            (GRAVITY * (1.0 - less_weight) - along * vz - across * vx) / inertia,
            (-along * vx + across * vz) / inertia,
        ]
    }

    /// Runge-Kutta of fourth order with a fixed `step` (s), until the speed is 5 % of the set one.
    pub(crate) fn path(&self, step: f64) -> Result<Path, String> {
        let limit = 0.05 * self.setting.speed;
        let mut states = vec![self.launch()];
        let mut state = self.launch();
        for k in 0..4000 {
            let add = |s: State, d: State, by: f64| -> State {
                std::array::from_fn(|i| s[i] + by * d[i])
            };
            let rate = |s: State| -> State {
                let a = self.acceleration(s);
                [s[2], s[3], a[0], a[1]]
            };
            let k1 = rate(state);
            let k2 = rate(add(state, k1, 0.5 * step));
            let k3 = rate(add(state, k2, 0.5 * step));
            let k4 = rate(add(state, k3, step));
            let next: State = std::array::from_fn(|i| {
                state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
            });
            let (before, after) = (libm::hypot(state[2], state[3]), libm::hypot(next[2], next[3]));
            states.push(next);
            if !after.is_finite() {
                return Err("the path is not finite".into());
            }
            if k > 2 && after < limit {
                let share = (before - limit) / (before - after);
                let stop_time = (k as f64 + share) * step;
                let mut path = Path { step, states, stop_time, stop: (0.0, 0.0) };
                path.stop = path.inside(stop_time);
                return Ok(path);
            }
            state = next;
        }
        Err("the sphere does not stop".into())
    }
}

impl Path {
    /// Depth and range at `time` (s): free before contact, at rest after the stop.
    pub(crate) fn at(&self, time: f64) -> (f64, f64) {
        if time <= 0.0 {
            let [_, _, vz, vx] = self.states[0];
            (vz * time + 0.5 * GRAVITY * time * time, vx * time)
        } else if time >= self.stop_time {
            self.stop
        } else {
            self.inside(time)
        }
    }

    /// By Hermite's cubic.
    fn inside(&self, time: f64) -> (f64, f64) {
        let at = ((time / self.step) as usize).min(self.states.len() - 2);
        let s = time / self.step - at as f64;
        let (a, b) = (self.states[at], self.states[at + 1]);
        let cubic = |i: usize| {
            let (va, vb) = (a[i + 2] * self.step, b[i + 2] * self.step);
            let rise = b[i] - a[i];
            let (c2, c3) = (3.0 * rise - 2.0 * va - vb, va + vb - 2.0 * rise);
            a[i] + s * (va + s * (c2 + s * c3))
        };
        (cubic(0), cubic(1))
    }
}

fn at_depth(nodes: &[f64], depth: f64, reach: f64) -> f64 {
    let Some(last) = nodes.last() else { return 0.0 };
    let place = depth / reach * (nodes.len() - 1) as f64;
    let k = place as usize;
    if k + 1 >= nodes.len() {
        return *last;
    }
    nodes[k] + (place - k as f64) * (nodes[k + 1] - nodes[k])
}

/// The two-term law as a model with candidates.
pub(crate) struct TwoTerm {
    settings: Vec<Setting>,
    layouts: Vec<Layout>,
    effects: Vec<Effect>,
    adopted: Vec<(Effect, f64)>,
    parameters: Vec<Parameter>,
    candidates: Vec<Candidate>,
}

impl TwoTerm {
    pub(crate) fn new(settings: &[Setting], layouts: Vec<Layout>, effects: &[Effect]) -> Self {
        let parameter = |name: &str, start| Parameter {
            name: name.into(),
            unit: String::new(),
            start,
            min: 0.0,
            max: 100.0,
            prior: None,
            kind: ParameterKind::Model,
        };
        let candidate = |effect: &Effect| {
            let (min, max, step) = match effect {
                Effect::DepthExponent => (-0.5, 0.8, 0.02),
                Effect::Buoyancy => (0.0, 20.0, 0.1),
                Effect::DepthDrag => (-0.5, 5.0, 0.02),
                Effect::LessWeight | Effect::MoreMass => (-0.5, 0.9, 0.01),
                _ => (-5.0, 20.0, 0.02),
            };
            Candidate {
                id: effect.id().into(),
                unit: "1".into(),
                min,
                max,
                usual: None,
                step,
                not_testable: None,
                separable_from: "from others by more runs".into(),
                form: Vec::new(),
                unresolved: Vec::new(),
            }
        };
        Self {
            settings: settings.to_vec(),
            layouts,
            effects: effects.to_vec(),
            adopted: Vec::new(),
            // Off the truth, as an analyst would start.
            parameters: vec![parameter("drag", 1.0), parameter("friction", 10.0)],
            candidates: effects.iter().map(candidate).collect(),
        }
    }

    /// Makes `effects` part of the model.
    pub(crate) fn adopt(&mut self, effects: &[(Effect, f64)]) {
        self.adopted.extend_from_slice(effects);
    }

    /// Declares that the data cannot show candidate `index`.
    pub(crate) fn forbid(&mut self, index: usize) {
        self.candidates[index].not_testable = Some("only vertical runs".into());
    }
}

impl Forward for TwoTerm {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn n_scattering_coefficients(&self) -> usize {
        2
    }

    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
        let Scatter { coefficients, speed, level, along, sideways, reach, .. } = at.scatter;
        let mut effects = self.adopted.clone();
        effects.extend(at.effects.iter().map(|&(index, q)| (self.effects[index], q)));
        let impact = Impact {
            setting: self.settings[condition],
            coefficients: std::array::from_fn(|i| at.parameters[i] * libm::exp(coefficients[i])),
            effects: &effects,
            speed: *speed,
            level: *level,
            along,
            sideways,
            reach: *reach,
        };
        let path = impact.path(5e-4).map_err(|why| {
            let id = format!("setting {condition}");
            PredictError { condition, id, why }
        })?;
        Ok(observables(&self.layouts[condition], &path))
    }
}

fn observables(layout: &Layout, path: &Path) -> Vec<f64> {
    let mut numbers: Vec<f64> = layout.times.iter().map(|t| path.at(*t).0).collect();
    if layout.along_x {
        numbers.extend(layout.times.iter().map(|t| path.at(*t).1));
    }
    let scalars = [
        (layout.stop_time, path.stop_time),
        (layout.final_z, path.stop.0),
        (layout.final_x, path.stop.1),
    ];
    numbers.extend(scalars.iter().filter(|(there, _)| *there).map(|(_, value)| *value));
    numbers
}
