//! One condition of a measurement set, ready to be predicted many times.

use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;
use std::sync::{Arc, Mutex, PoisonError};

use configs::{FreeParameter, ResistiveMedium};
use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::{AssemblyRequest, ShapeEntry};
use measurements::{
    Condition, FinalDefinition, Geometry, Kind, MeasurementSet, Role, SizeError, StopDefinition,
};
use resistive::{Approach, Coefficients, Effect, Expression, ResistanceEntry};
use resistive::{
    Driven, Effort, Ending, Impact, Recorder, ResistanceLaw, Sample, Space, State, Surroundings,
    Tolerance, Trajectory,
};

use super::bent::Bent;
use super::error::ForwardError;
use super::field::FieldForce;
use super::over_time::{self, DURATION};
use super::pushed;
use super::scatter::PathScatter;
use crate::forward::observable::{Layout, Observable};
use crate::forward::{Bend, Moment, Scatter, sense};

/// Errors near 1e-9 m, far below any camera and small beside every difference that is taken.
const TOLERANCE: Tolerance = Tolerance { relative: 1e-8, absolute: 1e-10 };

/// A force between nodes has kinks, at which steps are the shorter the smaller the errors are.
const OF_FIELD: Tolerance = Tolerance { relative: 1e-6, absolute: 1e-8 };

/// Angles closer than this (rad) are one.
const ROUND_OFF: f64 = 1e-12;

/// An impact takes some twenty steps and a few changes of mode; a fit that wanders to where it takes a hundred times
/// as many has left what the model can describe, and must not wait there.
const EFFORT: Effort = Effort { steps: 4_000, changes: 400 };

/// How many predictions of a condition are kept: a derivative by one parameter leaves most conditions
/// as they were, and several threads take derivatives.
const KEPT: usize = 8;

/// A condition with the model's law for it.
pub(super) struct Prepared {
    id: String,
    recent: Mutex<VecDeque<(Inputs, Arc<Seen>)>>,
    layout: Layout,
    /// Whether a drive keeps its velocity.
    is_pushed: bool,
    stop: StopDefinition,
    last: FinalDefinition,
    shape: &'static ShapeEntry,
    sizes: ParamTable,
    space: Space,
    mass: f64,
    speed: f64,
    angle: f64,
    spin: f64,
    bed: Surroundings,
    law: Law,
}

/// Everything that an impact follows from: numbers of the law, effects with their amplitudes, and what
/// differs from the run of the mean bed but for what only its reading depends on.
#[derive(Clone, PartialEq)]
struct Inputs {
    numbers: Vec<f64>,
    effects: Vec<(Effect, f64)>,
    scatter: Scatter,
}

/// An impact as an exact instrument sees it.
struct Seen {
    /// Depth and range (m) at the times of the frames.
    frames: Vec<(f64, f64)>,
    /// Stopping time (s).
    stop: f64,
    /// Depth and range (m) in the end.
    last: (f64, f64),
    /// Readings of the curve of the layout (SI).
    curve: Vec<f64>,
    laws: Vec<Box<dyn ResistanceLaw>>,
}

/// The law of a model in one impact, as a function of its free parameters.
struct Law {
    baseline: &'static ResistanceEntry,
    coefficients: Vec<Affine>,
    functions: Vec<(&'static str, Expression)>,
    effects: Vec<(Effect, Affine)>,
    approach: Approach,
    /// Greatest depth (m) and impact speed (m/s) of the set.
    extent: [f64; 2],
}

/// A number that depends on the free parameters: a coefficient that is a table over angle is a weighted
/// mean of two of them.
struct Affine {
    key: &'static str,
    constant: f64,
    weights: Vec<(usize, f64)>,
}

impl Affine {
    fn at(&self, parameters: &[f64]) -> f64 {
        self.weights.iter().fold(self.constant, |sum, &(index, w)| sum + w * parameters[index])
    }
}

impl Law {
    fn new(
        medium: &ResistiveMedium,
        free: &[FreeParameter],
        (approach, extent): (Approach, [f64; 2]),
    ) -> Self {
        let baseline = medium.resistance.entry;
        let here = medium.coefficients_at(approach.angle);
        let (functions, numbers): (Vec<_>, Vec<_>) =
            baseline.params.iter().map(|spec| spec.key).partition(|key| here.is_function(key));
        let changed: Vec<(Coefficients, f64)> = free
            .iter()
            .map(|one| {
                let change = if one.allowed.contains(one.value + 1.0) { 1.0 } else { -1.0 };
                let value = one.value + change * one.value.abs().clamp(1e-3, 1.0);
                let moved = medium.with_parameters(&[(&one.path, value)]);
                // Where neither direction is allowed, nothing can be free.
                let there =
                    moved.map_or_else(|_| here.clone(), |m| m.coefficients_at(approach.angle));
                (there, value - one.value)
            })
            .collect();
        let affine = |key: &'static str| {
            let weights: Vec<(usize, f64)> = changed
                .iter()
                .enumerate()
                .map(|(index, (there, step))| (index, (there.get(key) - here.get(key)) / step))
                .filter(|(_, weight)| *weight != 0.0)
                .collect();
            let shares: f64 = weights.iter().map(|&(index, w)| w * free[index].value).sum();
            Affine { key, constant: here.get(key) - shares, weights }
        };
        let effects = medium
            .effects
            .iter()
            .map(|effect| {
                let path = format!("effect.{}.q", effect.effect.name());
                let q = match free.iter().position(|one| one.path == path) {
                    Some(index) => Affine { key: "q", constant: 0.0, weights: vec![(index, 1.0)] },
                    None => Affine { key: "q", constant: effect.q, weights: Vec::new() },
                };
                (effect.effect.clone(), q)
            })
            .collect();
        Self {
            baseline,
            coefficients: numbers.into_iter().map(affine).collect(),
            functions: functions
                .into_iter()
                .filter_map(|key| Some((key, here.function(key)?.clone())))
                .collect(),
            effects,
            approach,
            extent,
        }
    }

    fn inputs(&self, parameters: &[f64], added: &[(&Effect, f64)], scatter: &Scatter) -> Inputs {
        let own = self.effects.iter().map(|(effect, q)| (effect, q.at(parameters)));
        let all = own.chain(added.iter().copied());
        Inputs {
            numbers: self.coefficients.iter().map(|one| one.at(parameters)).collect(),
            effects: all.map(|(effect, q)| (effect.clone(), q)).collect(),
            scatter: Scatter { level: 0.0, ahead: 0.0, start: 0.0, scale: 0.0, ..scatter.clone() },
        }
    }

    /// The laws with these parameters, `added` effects and what scatters from run to run.
    fn laws(
        &self,
        parameters: &[f64],
        added: &[(&Effect, f64)],
        scatter: &Scatter,
        scattering: &[&str],
    ) -> Vec<Box<dyn ResistanceLaw>> {
        let mut numbers = ParamTable::new();
        for coefficient in &self.coefficients {
            let place = scattering.iter().position(|key| *key == coefficient.key);
            let log = place.and_then(|index| scatter.coefficients.get(index)).copied();
            let factor = log.map_or(1.0, |log| if log == 0.0 { 1.0 } else { libm::exp(log) });
            numbers.set(coefficient.key, factor * coefficient.at(parameters));
        }
        let coefficients = self
            .functions
            .iter()
            .fold(Coefficients::new(numbers), |all, (key, f)| all.with_function(key, f.clone()));
        let mut laws = vec![(self.baseline.build)(&coefficients)];
        let own = self.effects.iter().map(|(effect, q)| (effect, q.at(parameters), false));
        let added = added.iter().map(|&(effect, q)| (effect, q, true));
        let mut effects: Vec<(&Effect, f64, bool)> =
            own.chain(added).filter(|(_, q, _)| *q != 0.0).collect();
        effects.sort_by_key(|(effect, ..)| effect.rank());
        laws.extend(effects.iter().map(|&(effect, q, bends)| {
            let law = effect.build(q, self.approach);
            if bends { self.bent(law, scatter) } else { law }
        }));
        if scatter.tilt != 0.0 {
            laws.extend(Effect::listed("tilt").map(|tilt| tilt.build(scatter.tilt, self.approach)));
        }
        if let Some(field) = &scatter.field {
            laws.push(Box::new(FieldForce {
                field: Arc::clone(field),
                angle: self.approach.angle,
            }));
        }
        if let Some(path) = PathScatter::of(scatter) {
            laws.push(Box::new(path));
        }
        laws
    }

    fn bent(&self, law: Box<dyn ResistanceLaw>, scatter: &Scatter) -> Box<dyn ResistanceLaw> {
        let (by, [reach, speed]) = (scatter.bend, self.extent);
        match by == Bend::default() {
            true => law,
            false => Box::new(Bent { law, by, reach, speed }),
        }
    }
}

impl Prepared {
    pub(super) fn new(
        medium: &ResistiveMedium,
        free: &[FreeParameter],
        (set, extent): (&MeasurementSet, [f64; 2]),
        index: usize,
        layout: &Layout,
    ) -> Result<Self, ForwardError> {
        let condition = &set.conditions[index];
        let bed = set.bed_of(condition);
        let (space, name) = match bed.geometry {
            Geometry::Planar => (Space::Planar, "2d"),
            Geometry::Spatial => (Space::Spatial, "3d"),
        };
        let shape = condition.shape_entry().ok_or_else(|| ForwardError::UnknownShape {
            condition: condition.id.clone(),
            shape: condition.shape.clone(),
            known: intruders::SHAPES.iter().map(|entry| entry.name).collect(),
        })?;
        if !shape.is_of_resistance(space) {
            let condition = condition.id.clone();
            return Err(ForwardError::WrongSpace { condition, shape: shape.name, space: name });
        }
        let is_pushed = set.kind == Kind::ForceDepth;
        if is_pushed && shape.links.is_some() {
            let condition = condition.id.clone();
            return Err(ForwardError::NotPushed { condition, shape: shape.name });
        }
        if set.kind == Kind::Spin && !shape.slender {
            let condition = condition.id.clone();
            return Err(ForwardError::KeepsSpin { condition, shape: shape.name });
        }
        // What the set states stands above what the model says, as its gravity does.
        let fluid = bed.stated.fluid.or(medium.fluid);
        if fluid.is_some() && shape.slender {
            let condition = condition.id.clone();
            return Err(ForwardError::InFluid { condition, shape: shape.name });
        }
        let angle = condition.angle_deg.to_radians();
        let approach = Approach { speed: condition.speed, angle };
        let bed = Surroundings {
            bulk_density: bed.bulk_density.unwrap_or(medium.bulk_density),
            gravity: bed.gravity,
            packing: condition.packing.or(medium.packing),
            bed_depth: condition.bed_depth.or(medium.bed_depth),
            fluid,
        };
        let there = ResistiveMedium { bulk_density: bed.bulk_density, ..medium.clone() };
        Ok(Self {
            id: condition.id.clone(),
            recent: Mutex::new(VecDeque::with_capacity(KEPT + 1)),
            layout: layout.clone(),
            is_pushed,
            stop: set.stop,
            last: set.last,
            shape,
            sizes: condition.sizes(shape).map_err(|error| unsized_body(condition, shape, error))?,
            space,
            mass: condition.mass,
            speed: condition.speed,
            angle,
            spin: condition.spin,
            bed,
            law: Law::new(&there, free, (approach, extent)),
        })
    }

    /// Name of the condition in the set.
    pub(super) fn id(&self) -> &str {
        &self.id
    }

    /// The dimension of the bed.
    pub(super) fn space(&self) -> Space {
        self.space
    }

    /// The impact with these parameters, `added` effects and what differs from run to run.
    pub(super) fn impact_with(
        &self,
        parameters: &[f64],
        added: &[(&Effect, f64)],
        scatter: &Scatter,
        scattering: &[&str],
    ) -> Impact {
        self.impact(self.law.laws(parameters, added, scatter, scattering), scatter)
    }

    /// About `n` moments of the way of `impact` in the bed, from contact until the body rests or has come as deep as it
    /// is pushed, with the forces of `others` there.
    pub(super) fn passage(
        &self,
        impact: &Impact,
        others: &[Impact],
        n: usize,
    ) -> Result<Vec<Moment>, String> {
        let duration = match (self.is_pushed, &self.layout.curve) {
            (true, Some(curve)) => {
                curve.at.iter().copied().fold(0.0, f64::max) / self.speed.max(f64::MIN_POSITIVE)
            }
            _ => impact.run(DURATION, &mut ()).map_err(|error| error.to_string())?.time,
        };
        let from = impact.assembly().part(0, impact.start()).tip.x;
        let mut moments = Vec::with_capacity(n + 1);
        let interval = duration / n.max(1) as f64;
        let mut seen = Recorder::new(impact, interval, |sample: &Sample<'_>| {
            moments.extend(moment(sample, from, (impact, others)));
        });
        impact.run(duration, &mut seen).map_err(|error| error.to_string())?;
        drop(seen);
        Ok(moments)
    }

    /// The observables, in the order of the layout.
    pub(super) fn predict(
        &self,
        parameters: &[f64],
        added: &[(&Effect, f64)],
        scatter: &Scatter,
        scattering: &[&str],
    ) -> Result<Vec<f64>, String> {
        let mut inputs = self.law.inputs(parameters, added, scatter);
        if self.layout.curve.is_some() {
            // The depth at which a force is read, and what an accelerometer reads, hang on these.
            (inputs.scatter.level, inputs.scatter.scale) = (scatter.level, scatter.scale);
        }
        // A poisoned lock holds nothing worse than fewer predictions.
        let recent = || self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        let known = recent().iter().find(|(one, _)| *one == inputs).map(|(_, seen)| seen.clone());
        if let Some(seen) = known {
            return self.read(&seen, scatter);
        }
        let seen = Arc::new(self.integrate(parameters, added, scatter, scattering)?);
        let predicted = self.read(&seen, scatter);
        let mut recent = recent();
        recent.push_front((inputs, seen));
        recent.truncate(KEPT);
        predicted
    }

    /// What is read of `seen`.
    fn read(&self, seen: &Seen, scatter: &Scatter) -> Result<Vec<f64>, String> {
        let ahead = scatter.ahead - scatter.start * self.speed * libm::cos(self.angle);
        let read = |&(depth, range): &(f64, f64)| {
            let (mut depth, mut range) = (depth + scatter.level, range + ahead);
            seen.laws.iter().for_each(|law| law.read(&mut depth, &mut range));
            (depth * (1.0 + scatter.scale), range * (1.0 + scatter.scale))
        };
        let frames: Vec<(f64, f64)> = seen.frames.iter().map(read).collect();
        let mut observables: Vec<f64> = frames.iter().map(|(depth, _)| *depth).collect();
        if self.layout.along_x {
            observables.extend(frames.iter().map(|(_, range)| *range));
        }
        observables.extend(&seen.curve);
        let (depth, range) = read(&seen.last);
        observables.extend(self.layout.scalars().map(|kind| match kind {
            Observable::StopTime => seen.stop,
            Observable::FinalRange => range,
            _ => depth,
        }));
        match observables.iter().all(|value| value.is_finite()) {
            true => Ok(observables),
            false => Err("an observable is not finite".to_owned()),
        }
    }

    fn integrate(
        &self,
        parameters: &[f64],
        added: &[(&Effect, f64)],
        scatter: &Scatter,
        scattering: &[&str],
    ) -> Result<Seen, String> {
        let laws = self.law.laws(parameters, added, scatter, scattering);
        let impact = self.impact(laws, scatter);
        if self.is_pushed {
            let depths = self.layout.curve.as_ref().map_or(&[][..], |curve| &curve.at);
            let curve = pushed::forces(&impact, depths, scatter)?;
            let (stop, last, laws) = (0.0, (0.0, 0.0), impact.into_laws());
            return Ok(Seen { frames: Vec::new(), stop, last, curve, laws });
        }
        if let Some(curve) = &self.layout.curve {
            let curve = over_time::readings(&impact, curve, scatter)?;
            let (stop, last, laws) = (0.0, (0.0, 0.0), impact.into_laws());
            return Ok(Seen { frames: Vec::new(), stop, last, curve, laws });
        }
        let times: Vec<f64> = self.layout.times.iter().map(|time| time + scatter.clock).collect();
        let (before, after) = split(&times);
        let mut flight = impact.flight(&before).map_err(|error| error.to_string())?;
        flight.reverse();
        let mut seen = Trajectory::at(after);
        let ending = impact.run(DURATION, &mut seen).map_err(|error| error.to_string())?;
        let x = impact.assembly().part(0, impact.start()).tip.x;
        let tip = |state: &State| impact.assembly().part(0, state).tip;
        let place = |state: &State| (-tip(state).z, tip(state).x - x);
        let last = match self.last {
            FinalDefinition::Deepest => (ending.parts[0].depth, ending.parts[0].range),
            // With its sign, forward: a size would have a kink where a vertical impact drifts.
            FinalDefinition::Resting => place(&ending.state),
        };
        Ok(Seen {
            frames: flight.iter().chain(seen.states()).map(place).collect(),
            stop: self.stop_time(&impact, &ending) - scatter.clock,
            last,
            curve: Vec::new(),
            laws: impact.into_laws(),
        })
    }

    fn stop_time(&self, impact: &Impact, ending: &Ending) -> f64 {
        let part = &ending.parts[0];
        let contact = part.contact.unwrap_or(0.0);
        let drifts = impact.assembly().ends_with_its_tips()
            && ending.state.rate.iter().any(|&rate| rate != 0.0);
        let stop = match self.stop {
            // A link has stopped when its tip no longer sinks, wherever it still drifts.
            StopDefinition::ComponentZero if drifts => part.vertical,
            StopDefinition::ComponentZero => part.time(),
            StopDefinition::SpeedFivePercent => ending.slow,
        };
        stop.unwrap_or(ending.time) - contact
    }

    fn impact(&self, laws: Vec<Box<dyn ResistanceLaw>>, scatter: &Scatter) -> Impact {
        let speed = self.speed * (1.0 + scatter.speed);
        // Without ways forward, an impact that leans from the vertical looks like any other.
        let angle = match self.layout.along_x || self.layout.final_x {
            true => self.angle + scatter.steeper,
            false if self.angle < FRAC_PI_2 => (self.angle + scatter.steeper).min(FRAC_PI_2),
            false => FRAC_PI_2,
        };
        // Straight down is exactly down: a cosine of round-off size is no horizontal speed.
        let (sine, cosine) = match (angle - FRAC_PI_2).abs() < ROUND_OFF {
            true => (1.0, 0.0),
            false => (libm::sin(angle), libm::cos(angle)),
        };
        let made = (self.shape.assembly)(&AssemblyRequest {
            params: &self.sizes,
            space: self.space,
            mass: self.mass * (1.0 + scatter.mass),
            velocity: Vec3::new(speed * cosine, 0.0, -speed * sine),
            spin: self.spin,
        });
        let assembly = match self.is_pushed {
            true => Box::new(Driven::new(made.assembly)),
            false => made.assembly,
        };
        let tolerance = if scatter.field.is_some() { OF_FIELD } else { TOLERANCE };
        Impact::new(assembly, laws, self.bed, made.start)
            .with_tolerance(tolerance)
            .with_effort(EFFORT)
    }
}

/// Greatest depth (m) and impact speed (m/s) over the conditions of `set` that are not held out.
pub(super) fn extent(set: &MeasurementSet) -> [f64; 2] {
    let is_seen = |condition: &&Condition| condition.role == Role::Fit;
    let depths = set.runs.iter().filter(|run| is_seen(&&set.conditions[run.condition]));
    let depths = depths.flat_map(|run| {
        let of_forces = run.samples.iter().filter(|_| set.kind == Kind::ForceDepth);
        let frames = run.frames.iter().map(|frame| frame.z);
        frames.chain(run.final_z).chain(of_forces.map(|sample| sample.at))
    });
    let seen = || set.conditions.iter().filter(is_seen);
    let widest = seen().map(|condition| condition.diameter).fold(f64::MIN_POSITIVE, f64::max);
    let speed = seen().map(|condition| condition.speed).fold(f64::MIN_POSITIVE, f64::max);
    // A set without depths may still have stopping times.
    [depths.fold(widest, f64::max), speed]
}

/// The body in a sample of `impact`, whose way began at `from` (m); `None` out of the bed and at rest, where no force is
/// against its motion.
fn moment(
    sample: &Sample<'_>,
    from: f64,
    (impact, others): (&Impact, &[Impact]),
) -> Option<Moment> {
    let part = &sample.parts[0].part;
    let (velocity, speed) = (part.velocity, part.velocity.norm());
    let (depth, area) = (part.immersion.depth, part.immersion.loaded_area);
    let direction = velocity / speed;
    let normal = Vec3::new(-direction.z, 0.0, direction.x) * sense(direction.x);
    let components = |impact: &Impact| {
        let force = impact.force_in(0, sample.state);
        [-force.dot(&direction), force.dot(&normal)]
    };
    (depth > 0.0 && speed > 0.0).then(|| {
        let bed = impact.bed();
        Moment {
            time: sample.time,
            way: part.tip.x - from,
            depth,
            speed,
            direction: [direction.x, direction.z],
            unit: bed.bulk_density * bed.gravity * area * part.immersion.diameter,
            force: components(impact)[0],
            others: others.iter().map(components).collect(),
        }
    })
}

/// The times before first contact, in falling order, and the others.
fn split(times: &[f64]) -> (Vec<f64>, &[f64]) {
    let n_before = times.partition_point(|&time| time < 0.0);
    (times[..n_before].iter().rev().copied().collect(), &times[n_before..])
}

fn unsized_body(
    condition: &Condition,
    shape: &'static ShapeEntry,
    error: SizeError,
) -> ForwardError {
    let (condition, shape) = (condition.id.clone(), shape.name);
    match error {
        SizeError::Missing(key) => ForwardError::MissingSize { condition, shape, key },
        SizeError::Bad(key, value) => ForwardError::BadSize { condition, shape, key, value },
    }
}
