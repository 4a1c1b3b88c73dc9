//! Resistive-force models as the statistics see them: a prediction is an impact integrated anew.

mod bent;
mod candidates;
mod error;
mod extended;
mod field;
mod needs;
mod over_time;
mod prepared;
mod pushed;
mod scatter;
mod slow;

use configs::{FreeParameter, Medium, Model, ResistiveMedium};
use std::sync::Arc;

use measurements::{Condition, Kind, MeasurementSet, ParameterPrior};
use resistive::{Approach, Effect, RESISTANCE_LAWS};

use crate::forward::apparatus::{Apparatus, is_looked_for};
use crate::forward::observable::Layout;
use crate::forward::{
    ByFormulas, Candidate, Forward, Parameter, ParameterKind, PredictError, Prior, Request, Scatter,
};
use crate::next::Designs;
pub use error::ForwardError;
use prepared::{Prepared, extent};

/// By this share a parameter is moved to see whether anything depends on it.
const PROBE: f64 = 1e-2;

/// Error of the stopping time of an oblique impact, as a share of the time of its last frame, under a law that stops each
/// component by itself: which one stops last changes abruptly with a coefficient.
const STOP_OF_COMPONENTS: f64 = 0.1;

/// Standard deviation of what is known of each change of form beforehand.
const FORM: f64 = 0.3;

/// A resistive-force model before a measurement set.
///
/// The set says what was dropped and how, and, where it does, what into: its bulk density, gravity,
/// packing fraction and depth of the bed stand before the model's.
pub struct ResistiveForward {
    conditions: Vec<Prepared>,
    /// Those that some number of the set depends on.
    parameters: Vec<Parameter>,
    /// Values of all free parameters of the model, and where in them those of `parameters` stand.
    start: Vec<f64>,
    active: Vec<usize>,
    idle: Vec<String>,
    unused_priors: Vec<String>,
    candidates: Vec<Candidate>,
    effects: Vec<Effect>,
    scattering: Vec<&'static str>,
    apparatus: Apparatus,
    /// Of each condition, as [`Forward::stop_error`] has it.
    stop_errors: Vec<Option<f64>>,
}

impl ResistiveForward {
    /// `model` before `set`; `layouts` say what to predict, one per condition.
    ///
    /// # Errors
    /// If the model is not of a resistive medium, or lacks something that a condition needs.
    pub fn new(
        model: &Model,
        set: &MeasurementSet,
        layouts: &[Layout],
    ) -> Result<Self, ForwardError> {
        let Medium::Resistive(medium) = &model.medium else {
            return Err(ForwardError::Grains { model: model.run.name.clone() });
        };
        if layouts.iter().any(|one| one.craters() > 0) {
            return Err(ForwardError::Craters { model: model.run.name.clone() });
        }
        let free = medium.free_parameters();
        let extent = extent(set);
        let conditions = (0..set.conditions.len())
            .map(|index| Prepared::new(medium, &free, (set, extent), index, &layouts[index]))
            .collect::<Result<_, _>>()?;
        let is_present =
            |name: &str| medium.effects.iter().any(|choice| choice.effect.name() == name);
        let listed = RESISTANCE_LAWS.iter().filter_map(|entry| Effect::listed(entry.name));
        let listed = listed.flat_map(|effect| {
            // A form that these data cannot tell from another would be fitted for nothing.
            let others = effect.other_forms().into_iter();
            let others = others.filter(|(_, needs)| needs::missing(needs, set).is_empty());
            let others: Vec<Effect> = others.map(|(form, _)| form).collect();
            std::iter::once(effect).chain(others)
        });
        let own = medium.candidates.iter().map(|own| Effect::Own(Arc::clone(own)));
        let is_scattering = |key: &str| {
            let (whole, node) = (format!("resistance.{key}"), format!("resistance.{key}@"));
            free.iter().any(|one| one.path == whole || one.path.starts_with(&node))
        };
        let scattering: Vec<&'static str> = medium
            .resistance
            .entry
            .params
            .iter()
            .map(|spec| spec.key)
            .filter(|key| is_scattering(key))
            .collect();
        let apparatus = Apparatus::of(set, &scattering, layouts);
        // Errors of the apparatus are parameters of every fit, not effects.
        let effects: Vec<Effect> = listed
            .chain(own)
            .filter(|effect| !is_present(effect.name()) && !is_looked_for(set, effect.name()))
            .collect();
        let start: Vec<f64> = free.iter().map(|one| one.value).collect();
        let mut forward = Self {
            conditions,
            parameters: free.iter().map(|one| parameter(one, set)).collect::<Result<_, _>>()?,
            active: (0..free.len()).collect(),
            start,
            idle: Vec::new(),
            unused_priors: unused_priors(&free, set),
            candidates: candidates::of(&effects, set),
            effects,
            scattering,
            apparatus: Apparatus::default(),
            stop_errors: stop_errors(medium, set, layouts),
        };
        forward.drop_idle(set.kind);
        forward.parameters.extend_from_slice(apparatus.parameters());
        forward.apparatus = apparatus;
        forward.parameters.extend(forms());
        for index in slow::unseen(&forward, set) {
            forward.candidates[index].not_testable = Some(slow::WHY.to_owned());
        }
        Ok(forward)
    }

    /// Sets those parameters aside that no number of the set depends on: the horizontal coefficients
    /// before vertical impacts, the nodes of a table beyond its angles; before slow pushes, what no force shows.
    fn drop_idle(&mut self, kind: Kind) {
        let still = Scatter::default();
        let all = |values: &[f64]| -> Vec<Option<Vec<f64>>> {
            let at = Request { parameters: values, effects: &[], scatter: &still };
            (0..self.conditions.len()).map(|index| self.predict(index, &at).ok()).collect()
        };
        let before = all(&self.start);
        let matters = |index: usize| {
            let mut values = self.start.clone();
            values[index] += PROBE * if values[index] == 0.0 { 1.0 } else { values[index] };
            let after = all(&values);
            match kind {
                Kind::ForceDepth => after.iter().zip(&before).any(|(after, before)| {
                    let both = after.as_ref().zip(before.as_ref());
                    both.is_some_and(|(a, b)| slow::differs(b, a, PROBE * slow::SEEN))
                }),
                _ => after != before,
            }
        };
        let (active, idle): (Vec<usize>, Vec<usize>) =
            (0..self.start.len()).partition(|&index| matters(index));
        self.idle = idle.iter().map(|&index| self.parameters[index].name.clone()).collect();
        self.parameters = active.iter().map(|&index| self.parameters[index].clone()).collect();
        self.active = active;
    }

    /// Free parameters of the model that no number of the set depends on; they stay as they are.
    pub fn idle(&self) -> &[String] {
        &self.idle
    }

    /// Keys of the coefficients that scatter from run to run, in the order of [`Scatter::coefficients`].
    pub(crate) fn scattering(&self) -> &[&'static str] {
        &self.scattering
    }

    /// Names in `[parameters]` of the set that are no free parameter of the model.
    pub fn unused_priors(&self) -> &[String] {
        &self.unused_priors
    }

    /// The effects that are candidates, in their order: those of the table, then those of the model.
    pub fn effects(&self) -> &[Effect] {
        &self.effects
    }
}

impl Designs for Model {
    fn forward(&self, set: &MeasurementSet, layouts: &[Layout]) -> Option<Box<dyn Forward>> {
        let forward = ResistiveForward::new(self, set, layouts).ok()?;
        Some(Box::new(forward))
    }
}

impl Forward for ResistiveForward {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn n_scattering_coefficients(&self) -> usize {
        self.scattering.len()
    }

    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
        self.predict_with(condition, at, &self.added(at.effects))
    }

    fn stop_error(&self, condition: usize) -> Option<f64> {
        self.stop_errors[condition]
    }

    fn by_formulas(&self) -> Option<&dyn ByFormulas> {
        Some(self)
    }
}

impl ResistiveForward {
    /// Effects of the list with amplitudes, by their indices.
    fn added(&self, effects: &[(usize, f64)]) -> Vec<(&Effect, f64)> {
        effects.iter().map(|&(index, q)| (&self.effects[index], q)).collect()
    }

    /// Values of all free parameters of the model, and what differs from run to run with the errors of the apparatus.
    fn inputs(&self, condition: usize, at: &Request<'_>, is_extended: bool) -> (Vec<f64>, Scatter) {
        let mut values = self.start.clone();
        for (&index, &value) in self.active.iter().zip(at.parameters) {
            values[index] = value;
        }
        let others = &at.parameters[self.active.len().min(at.parameters.len())..];
        let (errors, forms) = others.split_at(self.apparatus.parameters().len().min(others.len()));
        let mut scatter = self.apparatus.added_to(at.scatter, condition, errors);
        if is_extended {
            scatter.bend.0.iter_mut().zip(forms).for_each(|(bend, form)| *bend += form);
        }
        (values, scatter)
    }

    /// The observables of `condition` with `added`, whatever effects `at` asks for.
    fn predict_with(
        &self,
        condition: usize,
        at: &Request<'_>,
        added: &[(&Effect, f64)],
    ) -> Result<Vec<f64>, PredictError> {
        let (values, scatter) = self.inputs(condition, at, !added.is_empty());
        let prepared = &self.conditions[condition];
        prepared
            .predict(&values, added, &scatter, &self.scattering)
            .map_err(|why| self.failed(condition, why))
    }

    fn failed(&self, condition: usize, why: String) -> PredictError {
        PredictError { condition, id: self.conditions[condition].id().to_owned(), why }
    }
}

/// Of each condition of `set`, the error of a stopping time that has a kink in the coefficients of `medium`.
fn stop_errors(
    medium: &ResistiveMedium,
    set: &MeasurementSet,
    layouts: &[Layout],
) -> Vec<Option<f64>> {
    let each = set.conditions.iter().zip(layouts);
    let error = |(condition, layout): (&Condition, &Layout)| {
        let angle = condition.angle_deg.to_radians();
        let laws = medium.laws_at(Approach { speed: condition.speed, angle });
        let has_kink = condition.angle_deg < 90.0 && laws.iter().any(|law| law.holds_components());
        // Without frames the stop is most of what is known.
        let last = layout.times.last().filter(|_| has_kink)?;
        Some(STOP_OF_COMPONENTS * last)
    };
    each.map(error).collect()
}

/// By how much effects that are added may differ from their formulas, a parameter per polynomial: nature does not use
/// our formulas.
fn forms() -> impl Iterator<Item = Parameter> {
    let names = ["depth", "depth, curved", "speed", "speed, curved", "depth and speed"];
    names.into_iter().map(|name| Parameter {
        name: format!("form over {name}"),
        unit: "1".to_owned(),
        start: 0.0,
        min: -1.0,
        max: 1.0,
        prior: Some(Prior { mean: 0.0, sigma: FORM }),
        kind: ParameterKind::Form,
    })
}

fn unused_priors(free: &[FreeParameter], set: &MeasurementSet) -> Vec<String> {
    let is_used = |prior: &ParameterPrior| free.iter().any(|one| prior.is_of(&one.path));
    set.priors.iter().filter(|prior| !is_used(prior)).map(|prior| prior.name.clone()).collect()
}

/// `free` with what `set` knows of it.
fn parameter(free: &FreeParameter, set: &MeasurementSet) -> Result<Parameter, ForwardError> {
    let prior = set.priors.iter().find(|prior| prior.is_of(&free.path));
    if let Some(prior) = prior.filter(|prior| !prior.unit.is_empty() && prior.unit != free.unit) {
        return Err(ForwardError::PriorUnit {
            name: prior.name.clone(),
            found: prior.unit.clone(),
            expected: free.unit.clone(),
        });
    }
    let prior = prior.map(|prior| Prior { mean: prior.mean, sigma: prior.sigma });
    Ok(Parameter {
        name: free.path.clone(),
        unit: free.unit.clone(),
        start: free.value,
        min: free.allowed.min,
        max: free.allowed.max,
        prior,
        kind: ParameterKind::Model,
    })
}
