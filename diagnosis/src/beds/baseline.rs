//! The runs of a model of grains as they stand: their means, their scatter from bed to bed, and the force
//! law that comes nearest to them.
//!
//! The force law (two terms, see `configs/two-term-vector.toml`) stands in where only small changes are
//! asked for: how observables answer to a force around a depth, to another impact speed, to the friction of
//! a rail. Of craters it says nothing: to first order they stay as they are. How runs scatter is learned
//! from the runs themselves (`modes`).

use std::sync::Arc;

use configs::{LoadOptions, Model, ModelSource, find_shipped};
use measurements::{Instrument, MeasurementSet};
use nalgebra::{DMatrix, DVector};
use runner::beds::Record;
use thiserror::Error;

use super::bed_model::BedModel;
use super::modes::Modes;
use super::observables::observables;
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::observable::Layout;
use crate::forward::sensitivity::Point;
use crate::forward::{Forward, Moment, Passages, PredictError, Request, Scatter};
use crate::noise::Noise;
use crate::observed::reading_error::reading;
use crate::observed::{Observed, ObservedCondition, reach};
use crate::resistive::{ForwardError, ResistiveForward};

/// The force law that stands in.
const STAND_IN: &str = "two-term-vector";

/// Why there is no baseline.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum BaselineError {
    #[error(transparent)]
    Forward(#[from] ForwardError),
    #[error("the runs of the model are not like an impact: {0}")]
    FitProblem(#[from] FitError),
    #[error(transparent)]
    Config(#[from] configs::ConfigError),
    #[error("condition {condition}: only {found} impacts finished; at least two are needed")]
    TooFew { condition: String, found: usize },
}

/// A force law near to a bed.
pub(super) struct StandIn {
    pub(super) forward: ResistiveForward,
    point: Point,
    /// Per condition: how many numbers of the set it answers, and how many there are; craters come last.
    answered: Vec<(usize, usize)>,
}

/// The runs of a model as it stands.
pub(super) struct Baseline {
    /// What a set of its runs would hold; conditions that were not run have an empty layout.
    pub(super) observed: Observed,
    pub(super) stand_in: StandIn,
    /// The force law, fitted to the runs.
    pub(super) fitted: Fitted,
    /// How its runs scatter.
    pub(super) modes: Modes,
    /// Per condition: every way in which they do, in units of the scatter of all runs relative to their means.
    pub(super) ways: Vec<DMatrix<f64>>,
    /// Per condition: covariance of the numbers of one run. Empty for those that were not run.
    pub(super) spread: Vec<DMatrix<f64>>,
}

impl Baseline {
    /// Of `runs`, one list per condition of the set, empty for those that were not run.
    pub(super) fn of(
        bed_model: &BedModel<'_>,
        layouts: &[Layout],
        runs: &[Vec<Record>],
    ) -> Result<Self, BaselineError> {
        let instrument = Instrument::default().without_shared_errors();
        let set = MeasurementSet { instrument, ..bed_model.set.clone() };
        // Conditions without runs are not looked at, if there are others.
        let none = runs.iter().all(Vec::is_empty);
        if let Some(at) = runs.iter().position(|runs| none || runs.len() == 1) {
            let (condition, found) = (set.conditions[at].id.clone(), runs[at].len());
            return Err(BaselineError::TooFew { condition, found });
        }
        let observed = as_measured(&set, layouts, runs);
        let shipped = find_shipped(STAND_IN)
            .map_or_else(|| ModelSource::Path(STAND_IN.into()), ModelSource::Shipped);
        let law = Model::load(shipped, &LoadOptions::default())?.model;
        let of_law: Vec<Layout> = layouts.iter().map(of_a_force_law).collect();
        let forward = ResistiveForward::new(&law, &set, &of_law)?;
        let answered = layouts.iter().map(|one| (one.len() - one.craters(), one.len())).collect();
        let paths = as_measured(&set, &of_law, runs);
        let problem = FitProblem { set: &set, observed: &paths, forward: &forward };
        let fitted = problem.fit_from(&Point::start(&forward), &Noise::guess(&instrument))?;
        let modes = Modes::of(&observed);
        let mut spread = vec![DMatrix::zeros(0, 0); observed.conditions.len()];
        let (mut scatter, mut whole) = (0.0, 0.0);
        for &at in &observed.fit {
            spread[at] = modes.covariance(at);
            scatter += spread[at].trace();
            whole += observed.conditions[at].mean.norm_squared();
        }
        let relative = (scatter / whole).sqrt();
        let ways = (0..spread.len()).map(|at| modes.ways(at) / relative).collect();
        let point = fitted.fit.point.clone();
        let stand_in = StandIn { forward, point, answered };
        Ok(Self { observed, stand_in, fitted, modes, ways, spread })
    }
}

/// What of `layout` a force law answers: all but craters. Of a set of nothing else it is fitted to the final depths, which
/// every run has.
fn of_a_force_law(layout: &Layout) -> Layout {
    let mut path = layout.without_craters();
    path.final_z |= path.is_empty();
    path
}

/// What a set of `runs` would hold, one list per condition, of the numbers in `layouts`.
fn as_measured(set: &MeasurementSet, layouts: &[Layout], runs: &[Vec<Record>]) -> Observed {
    let each = layouts.iter().zip(runs).enumerate();
    let conditions: Vec<ObservedCondition> =
        each.map(|(at, (layout, runs))| observed_condition(set, at, layout, runs)).collect();
    let fit = (0..conditions.len()).filter(|&at| !conditions[at].runs.is_empty()).collect();
    Observed { conditions, fit, holdout: Vec::new(), notes: Vec::new() }
}

/// The observables of `runs` under condition `at`; of none, where there are no runs.
fn observed_condition(
    set: &MeasurementSet,
    at: usize,
    layout: &Layout,
    runs: &[Record],
) -> ObservedCondition {
    let condition = &set.conditions[at];
    let layout = if runs.is_empty() { Layout::default() } else { layout.clone() };
    let vectors: Vec<DVector<f64>> =
        runs.iter().map(|run| observables(run, &layout, condition, set)).collect();
    let sum = vectors.iter().fold(DVector::zeros(layout.len()), |sum, one| sum + one);
    let mean = sum / vectors.len().max(1) as f64;
    let kinds = layout.kinds();
    ObservedCondition {
        id: condition.id.clone(),
        reading: reading(set, &layout, condition, [&[], &[]]),
        stated: vec![None; kinds.len()],
        reach: reach(set, &layout, &mean, condition),
        order: vec![None; vectors.len()],
        runs: vectors,
        mean,
        layout,
    }
}

impl StandIn {
    /// What `effects` of the force law (indices of its candidates) and what scatters change of the
    /// observables. The change by what scatters is odd in it: means over beds hold its second order
    /// already, since they are means over beds. A force that the model lacks acts on every run.
    pub(super) fn response(
        &self,
        condition: usize,
        effects: &[(usize, f64)],
        scatter: &Scatter,
    ) -> Result<DVector<f64>, PredictError> {
        let still = Scatter { coefficients: vec![0.0; self.n_scattering()], ..Scatter::default() };
        let predict = |effects: &[(usize, f64)], scatter: &Scatter| {
            let at = Request { parameters: &self.point.parameters, effects, scatter };
            self.forward.predict(condition, &at).map(DVector::from_vec)
        };
        let base = predict(&[], &still)?;
        let mut response = DVector::zeros(base.len());
        if effects.iter().any(|(_, q)| *q != 0.0) {
            response += predict(effects, &still)? - &base;
        }
        let scatter = &match &scatter.field {
            Some(field) => {
                let lacked = Scatter { field: Some(Arc::clone(field)), ..still.clone() };
                response += predict(&[], &lacked)? - &base;
                Scatter { field: None, ..scatter.clone() }
            }
            None => scatter.clone(),
        };
        if !scatter.is_still() {
            response += 0.5 * (predict(&[], scatter)? - predict(&[], &opposite(scatter))?);
        }
        let (answered, all) = self.answered[condition];
        Ok(response.rows(0, answered).into_owned().resize_vertically(all, 0.0))
    }

    /// What the body of `condition` goes through on the run that differs by `scatter`, and what it would meet there by
    /// each of `others`, at `n` moments.
    pub(super) fn passage(
        &self,
        condition: usize,
        (scatter, others): (&Scatter, &[&Scatter]),
        n: usize,
    ) -> Result<Vec<Moment>, PredictError> {
        let at = |scatter| Request { parameters: &self.point.parameters, effects: &[], scatter };
        let others: Vec<Request<'_>> = others.iter().map(|&scatter| at(scatter)).collect();
        self.forward.passage(condition, &at(scatter), &others, n)
    }

    /// Whether it answers any number of the set.
    pub(super) fn answers_any(&self) -> bool {
        self.answered.iter().any(|(answered, _)| *answered > 0)
    }

    /// Keys of the coefficients that scatter.
    pub(super) fn scattering(&self) -> &[&'static str] {
        self.forward.scattering()
    }

    pub(super) fn n_scattering(&self) -> usize {
        self.forward.n_scattering_coefficients()
    }
}

fn opposite(scatter: &Scatter) -> Scatter {
    let less = |values: &[f64]| values.iter().map(|value| -value).collect();
    Scatter {
        coefficients: less(&scatter.coefficients),
        speed: -scatter.speed,
        steeper: -scatter.steeper,
        level: -scatter.level,
        clock: -scatter.clock,
        ahead: -scatter.ahead,
        start: -scatter.start,
        scale: -scatter.scale,
        mass: -scatter.mass,
        tilt: -scatter.tilt,
        along: less(&scatter.along),
        sideways: less(&scatter.sideways),
        ..scatter.clone()
    }
}
