//! How the observables of a condition answer to what differs from run to run.

use measurements::Instrument;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::forward::{Forward, PredictError, Request, Scatter};

/// Nodes of the force multiplier along the path.
const ALONG: usize = 6;

/// Nodes of the sideways force.
const SIDEWAYS: usize = 3;

/// A model with values for everything that it leaves free.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// β, in the order of [`Forward::parameters`].
    pub parameters: Vec<f64>,
    /// Amplitudes of the effects that are there, as (index in [`Forward::candidates`], q).
    pub effects: Vec<(usize, f64)>,
}

impl Point {
    /// Where the parameters of `forward` start, without effects.
    pub fn start(forward: &dyn Forward) -> Self {
        let parameters = forward.parameters().iter().map(|parameter| parameter.start).collect();
        Self { parameters, effects: Vec::new() }
    }

    /// The run of the mean bed.
    pub fn predict(
        &self,
        forward: &dyn Forward,
        condition: usize,
    ) -> Result<DVector<f64>, PredictError> {
        let coefficients = vec![0.0; forward.n_scattering_coefficients()];
        self.predict_run(forward, condition, &Scatter { coefficients, ..Scatter::default() })
    }

    /// A run with `scatter`.
    pub(crate) fn predict_run(
        &self,
        forward: &dyn Forward,
        condition: usize,
        scatter: &Scatter,
    ) -> Result<DVector<f64>, PredictError> {
        let request = Request { parameters: &self.parameters, effects: &self.effects, scatter };
        forward.predict(condition, &request).map(DVector::from_vec)
    }
}

/// Standard deviations of the random inputs of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Of the logarithm of each coefficient, τ_c.
    pub coefficient: f64,
    /// Of the resistance along the path, relative, τ_p; sideways it is half of that.
    pub path: f64,
    /// Of the impact speed, relative.
    pub speed: f64,
    /// Of the angle of an oblique impact (rad).
    pub angle: f64,
    /// Of the level of the surface (m).
    pub level: f64,
    /// Of the time at which a clip is zero (s).
    pub clock: f64,
    /// Of the time at which ways forward are zero (s).
    pub start: f64,
}

impl Spread {
    /// With what the instrument states about speed, angle and level.
    pub fn new(coefficient: f64, path: f64, instrument: &Instrument) -> Self {
        let speed = instrument.speed_sigma_rel.unwrap_or(0.0);
        let angle = instrument.angle_sigma_deg.map_or(0.0, f64::to_radians);
        let level = instrument.level_sigma.unwrap_or(0.0);
        Self { coefficient, path, speed, angle, level, clock: 0.0, start: 0.0 }
    }

    /// The same with a clock that starts with some frame: it is off by a part of one, all parts alike. Repeats would tell.
    pub(crate) fn of_one_run(coefficient: f64, path: f64, instrument: &Instrument) -> Self {
        let clock = instrument.rate.map_or(0.0, |rate| 1.0 / (f64::sqrt(12.0) * rate));
        Self { clock, ..Self::new(coefficient, path, instrument) }
    }
}

/// One random input of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Input {
    Coefficient(usize),
    Speed,
    Angle,
    Level,
    Clock,
    Start,
    Along(usize),
    Sideways(usize),
}

/// What differs from run to run under one condition, and how the observables follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    inputs: Vec<Input>,
    /// Observables of the run of the mean bed.
    pub mean: DVector<f64>,
    /// Their derivative by each input, J_b.
    pub slope: DMatrix<f64>,
    /// Their second derivative by each input.
    pub curvature: DMatrix<f64>,
}

impl Sensitivity {
    /// By central differences around the run of the mean bed at `point`; a path goes to `reach` (m). Zero for an input
    /// that the model can be integrated with on neither side.
    ///
    /// # Errors
    /// If the model cannot be integrated at `point` itself.
    pub fn at(
        point: &Point,
        forward: &dyn Forward,
        condition: usize,
        reach: f64,
    ) -> Result<Self, PredictError> {
        let coefficients = forward.n_scattering_coefficients();
        let mean = point.predict(forward, condition)?;
        if let Some(ways) = forward.ways_of_scatter(condition) {
            return Ok(Self::of_ways(ways, mean));
        }
        let inputs: Vec<Input> = (0..coefficients)
            .map(Input::Coefficient)
            .chain([Input::Speed, Input::Angle, Input::Level, Input::Clock, Input::Start])
            .chain((0..ALONG).map(Input::Along))
            .chain((0..SIDEWAYS).map(Input::Sideways))
            .collect();
        let mut slope = DMatrix::zeros(mean.len(), inputs.len());
        let mut curvature = slope.clone();
        let runs = inputs.par_iter().map(|input| {
            [input.step(), -input.step()].map(|by| {
                point.predict_run(forward, condition, &input.scatter(by, coefficients, reach))
            })
        });
        for (column, [forth, back]) in runs.collect::<Vec<_>>().into_iter().enumerate() {
            let step = inputs[column].step();
            match (forth, back) {
                (Ok(more), Ok(less)) => {
                    slope.set_column(column, &((&more - &less) / (2.0 * step)));
                    curvature.set_column(column, &((more + less - 2.0 * &mean) / (step * step)));
                }
                // To one side where the model cannot be integrated on the other; of no curvature.
                (Ok(more), Err(_)) => slope.set_column(column, &((more - &mean) / step)),
                (Err(_), Ok(less)) => slope.set_column(column, &((&mean - less) / step)),
                // An input with which it cannot be integrated at all scatters nothing.
                (Err(_), Err(_)) => (),
            }
        }
        Ok(Self { inputs, mean, slope, curvature })
    }

    /// Of runs that differ from `mean` in `ways`, in place of forces along the path.
    fn of_ways(ways: &DMatrix<f64>, mean: DVector<f64>) -> Self {
        let inputs = (0..ways.ncols()).map(Input::Along).collect();
        let curvature = DMatrix::zeros(mean.len(), ways.ncols());
        Self { inputs, mean, slope: ways.clone(), curvature }
    }

    /// Whether the observables follow the impact speed.
    pub(crate) fn depends_on_speed(&self) -> bool {
        self.depends_on(Input::Speed)
    }

    /// Whether they follow the angle of the impact.
    pub(crate) fn depends_on_angle(&self) -> bool {
        self.depends_on(Input::Angle)
    }

    /// Whether they follow the level of the surface.
    pub(crate) fn depends_on_level(&self) -> bool {
        self.depends_on(Input::Level)
    }

    /// Whether they follow the zero of the clock.
    pub(crate) fn depends_on_clock(&self) -> bool {
        self.depends_on(Input::Clock)
    }

    /// Derivative of the observables by the logarithm of each coefficient.
    pub(crate) fn by_coefficients(&self) -> DMatrix<f64> {
        self.by(|input| matches!(input, Input::Coefficient(_)))
    }

    /// Whether they follow the zero of ways forward.
    pub(crate) fn depends_on_start(&self) -> bool {
        self.depends_on(Input::Start)
    }

    /// Derivative of the observables by the angle of the impact.
    pub(crate) fn by_angle(&self) -> DMatrix<f64> {
        self.by(|input| *input == Input::Angle)
    }

    fn by(&self, is_asked: impl Fn(&Input) -> bool) -> DMatrix<f64> {
        let inputs = self.inputs.iter().enumerate();
        let columns: Vec<usize> =
            inputs.filter(|(_, input)| is_asked(input)).map(|(column, _)| column).collect();
        self.slope.select_columns(&columns)
    }

    fn depends_on(&self, input: Input) -> bool {
        let mut columns = self.inputs.iter().zip(self.slope.column_iter());
        columns.any(|(one, column)| *one == input && column.iter().any(|slope| *slope != 0.0))
    }

    /// Standard deviation of each input.
    pub fn spread(&self, spread: &Spread) -> DVector<f64> {
        DVector::from_iterator(
            self.inputs.len(),
            self.inputs.iter().map(|input| match input {
                Input::Coefficient(_) => spread.coefficient,
                Input::Speed => spread.speed,
                Input::Angle => spread.angle,
                Input::Level => spread.level,
                Input::Clock => spread.clock,
                Input::Start => spread.start,
                Input::Along(_) => spread.path,
                Input::Sideways(_) => 0.5 * spread.path,
            }),
        )
    }

    /// What the mean of runs differs by from the run of the mean bed, to second order in the scatter.
    pub(crate) fn shift_of_mean(&self, spread: &Spread) -> DVector<f64> {
        0.5 * &self.curvature * self.spread(spread).map(|sd| sd * sd)
    }
}

impl Input {
    /// About one standard deviation of a common bed, so that the curvature is that of its scatter.
    fn step(self) -> f64 {
        match self {
            Self::Coefficient(_) => 0.05,
            Self::Speed => 0.01,
            Self::Angle => 5e-3,
            Self::Level => 2e-4,
            Self::Clock | Self::Start => 1e-4,
            Self::Along(_) => 0.1,
            Self::Sideways(_) => 0.05,
        }
    }

    fn scatter(self, value: f64, coefficients: usize, reach: f64) -> Scatter {
        let only = |n: usize, index: usize| {
            (0..n).map(|k| if k == index { value } else { 0.0 }).collect::<Vec<_>>()
        };
        let mut scatter =
            Scatter { coefficients: vec![0.0; coefficients], reach, ..Scatter::default() };
        match self {
            Self::Coefficient(index) => scatter.coefficients[index] = value,
            Self::Speed => scatter.speed = value,
            Self::Angle => scatter.steeper = value,
            Self::Level => scatter.level = value,
            Self::Clock => scatter.clock = value,
            Self::Start => scatter.start = value,
            Self::Along(index) => scatter.along = only(ALONG, index),
            Self::Sideways(index) => scatter.sideways = only(SIDEWAYS, index),
        }
        scatter
    }
}

/// Which way a force acts on a moving body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Against the motion.
    Along,
    /// Normal to it, out of the bed.
    Sideways,
}

/// Change of the observables by a force around each of `nodes` equally spaced depths from the surface
/// to `reach` (m), in units of the resistance; one column per node, zero where the model cannot be integrated with it.
pub(crate) fn force_response(
    point: &Point,
    forward: &dyn Forward,
    condition: usize,
    direction: Direction,
    (nodes, reach): (usize, f64),
) -> Result<DMatrix<f64>, PredictError> {
    /// To one side: a direction in which to look needs no second order.
    const STEP: f64 = 0.02;
    let coefficients = vec![0.0; forward.n_scattering_coefficients()];
    let still = Scatter { coefficients, reach, ..Scatter::default() };
    let mean = point.predict(forward, condition)?;
    let mut columns = Vec::with_capacity(nodes);
    for node in 0..nodes {
        let moved = |by: f64| {
            let force = (0..nodes).map(|k| if k == node { by } else { 0.0 }).collect();
            let scatter = match direction {
                Direction::Along => Scatter { along: force, ..still.clone() },
                Direction::Sideways => Scatter { sideways: force, ..still.clone() },
            };
            Ok((point.predict_run(forward, condition, &scatter)? - &mean) / by)
        };
        let column = moved(STEP).or_else(|_: PredictError| moved(-STEP));
        columns.push(column.unwrap_or_else(|_| DVector::zeros(mean.len())));
    }
    Ok(DMatrix::from_columns(&columns))
}
