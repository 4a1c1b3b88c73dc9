//! A condition that was not measured, as it would be measured.

use measurements::{Condition, Kind, MeasurementSet, Role};
use nalgebra::DVector;

use super::designs::Designs;
use super::hypothesis::Hypothesis;
use crate::fit::problem::FitProblem;
use crate::forward::Forward;
use crate::forward::observable::{Layout, Observable};
use crate::observed::{BEFORE_STOP, ObservedCondition, PENETRATION_FRAMES};

/// A condition with a model before it, and the errors that it would be measured with.
pub(super) struct Foreseen {
    set: MeasurementSet,
    forward: Box<dyn Forward>,
    observed: ObservedCondition,
}

impl Foreseen {
    /// `condition` with so many repeats, as `leader` predicts it; frames up to the predicted stop.
    /// `None` if the model cannot say.
    pub(super) fn of(
        problem: &FitProblem<'_>,
        designs: &dyn Designs,
        (condition, repeats): (Condition, usize),
        leader: &Hypothesis,
    ) -> Option<Self> {
        let set = alone(problem.set, condition);
        let predict = |layout: &Layout| -> Option<(Box<dyn Forward>, DVector<f64>)> {
            let forward = designs.forward(&set, std::slice::from_ref(layout))?;
            let point = leader.before(forward.as_ref())?.point;
            let mean = point.predict(forward.as_ref(), 0).ok()?;
            (mean.len() == layout.len()).then_some((forward, mean))
        };
        let layout = match problem.set.kind.curve() {
            Some(_) => curve_layout(problem)?,
            None => {
                let stop = predict(&Layout { stop_time: true, ..Layout::default() })?.1[0];
                layout(problem, &set.conditions[0], stop)
            }
        };
        let (forward, mean) = predict(&layout)?;
        let observed = ObservedCondition::foreseen(&set, layout, (mean, repeats));
        Some(Self { set, forward, observed })
    }

    pub(super) fn condition(&self) -> &Condition {
        &self.set.conditions[0]
    }

    pub(super) fn forward(&self) -> &dyn Forward {
        self.forward.as_ref()
    }

    pub(super) fn observed(&self) -> &ObservedCondition {
        &self.observed
    }
}

/// `set` with `condition` and nothing measured.
fn alone(set: &MeasurementSet, condition: Condition) -> MeasurementSet {
    MeasurementSet {
        id: set.id.clone(),
        source: None,
        baseline: None,
        conditions: vec![Condition { role: Role::Fit, ..condition }],
        runs: Vec::new(),
        keep: Vec::new(),
        notes: Vec::new(),
        feasible: set.feasible.clone(),
        priors: set.priors.clone(),
        beds: set.beds.clone(),
        ..*set
    }
}

/// What would be measured of `condition`, whose intruder stops at `stop` (s): frames as far as the set
/// has them, and the scalars that it has of any condition.
fn layout(problem: &FitProblem<'_>, condition: &Condition, stop: f64) -> Layout {
    let layouts = || problem.observed.fit.iter().map(|&at| &problem.observed.conditions[at].layout);
    let oblique = condition.angle_deg < 90.0;
    let scalars = |is: fn(&Layout) -> bool| layouts().any(is);
    let (final_z, final_x) = (scalars(|one| one.final_z), scalars(|one| one.final_z) && oblique);
    if problem.set.kind == Kind::Scalar || layouts().all(|one| one.times.is_empty()) {
        let stop_time = scalars(|one| one.stop_time);
        return Layout { final_z, final_x, stop_time, ..Layout::default() };
    }
    let flight = layouts().map(|one| one.times.iter().filter(|t| **t < 0.0));
    let flight = flight.max_by_key(|times| times.clone().count());
    // Where the resting point is measured too, frames of the set end as much earlier.
    let last = if final_z { BEFORE_STOP * stop } else { stop };
    let n = PENETRATION_FRAMES;
    let frames = (0..n).map(|frame| last * frame as f64 / (n - 1) as f64);
    let times = flight.into_iter().flatten().copied().chain(frames).collect();
    Layout { times, along_x: oblique, final_z, final_x, ..Layout::default() }
}

/// A curve as far as any condition of the set has one.
fn curve_layout(problem: &FitProblem<'_>) -> Option<Layout> {
    let layouts = problem.observed.fit.iter().map(|&at| &problem.observed.conditions[at].layout);
    let end = |one: &&Layout| one.curve.as_ref().and_then(|curve| curve.at.last().copied());
    layouts.max_by(|a, b| end(a).unwrap_or(0.0).total_cmp(&end(b).unwrap_or(0.0))).cloned()
}

impl ObservedCondition {
    /// The one condition of `set` as it would be measured: every one of so many runs like `mean`, whose
    /// numbers are those of `layout`.
    fn foreseen(
        set: &MeasurementSet,
        layout: Layout,
        (mean, repeats): (DVector<f64>, usize),
    ) -> Self {
        let condition = &set.conditions[0];
        let kinds: Vec<Observable> = layout.kinds();
        Self {
            id: condition.id.clone(),
            reading: crate::observed::reading_error::reading(set, &layout, condition, [&[], &[]]),
            stated: kinds
                .iter()
                .map(|kind| crate::observed::reading_error::stated(&set.stated, *kind))
                .collect(),
            reach: crate::observed::reach(set, &layout, &mean, condition),
            runs: vec![mean.clone(); repeats],
            order: vec![None; repeats],
            layout,
            mean,
        }
    }
}
