//! A resistive-force model with forces that formulas give, beside the effects of the list.

use std::sync::Arc;

use resistive::{Draft, Effect, Impact, OwnEffect, OwnEffectError, Space};

use super::ResistiveForward;
use crate::forward::{
    ByFormulas, Candidate, Forward, Moment, Parameter, Passages, PredictError, Request,
};

/// The model, and effects behind those of its list.
struct Extended<'a> {
    model: &'a ResistiveForward,
    effects: Vec<Effect>,
    candidates: Vec<Candidate>,
}

impl ByFormulas for ResistiveForward {
    fn space(&self) -> Space {
        self.conditions.first().map_or(Space::Spatial, |one| one.space())
    }

    fn extended(&self, drafts: Vec<Draft>) -> Result<Box<dyn Forward + '_>, OwnEffectError> {
        let read = |draft| OwnEffect::new(draft, |_| false).map(|own| Effect::Own(Arc::new(own)));
        let effects: Vec<Effect> = drafts.into_iter().map(read).collect::<Result<_, _>>()?;
        let mut candidates = self.candidates.clone();
        candidates.extend(effects.iter().map(candidate));
        Ok(Box::new(Extended { model: self, effects, candidates }))
    }
}

impl Passages for ResistiveForward {
    fn passage(
        &self,
        condition: usize,
        at: &Request<'_>,
        others: &[Request<'_>],
        n: usize,
    ) -> Result<Vec<Moment>, PredictError> {
        let prepared = &self.conditions[condition];
        let impact = |at: &Request<'_>| {
            let added = self.added(at.effects);
            let (values, scatter) = self.inputs(condition, at, !added.is_empty());
            prepared.impact_with(&values, &added, &scatter, &self.scattering)
        };
        let others: Vec<Impact> = others.iter().map(impact).collect();
        prepared.passage(&impact(at), &others, n).map_err(|why| self.failed(condition, why))
    }
}

impl Forward for Extended<'_> {
    fn parameters(&self) -> &[Parameter] {
        self.model.parameters()
    }

    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn n_scattering_coefficients(&self) -> usize {
        self.model.n_scattering_coefficients()
    }

    fn within(&self) -> Option<&dyn Forward> {
        Some(self.model)
    }

    fn predict(&self, condition: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
        let n = self.model.effects.len();
        let find = |index: usize| match index.checked_sub(n) {
            Some(own) => &self.effects[own],
            None => &self.model.effects[index],
        };
        let added: Vec<(&Effect, f64)> =
            at.effects.iter().map(|&(index, q)| (find(index), q)).collect();
        self.model.predict_with(condition, at, &added)
    }
}

/// A formula that is to be fitted: anything within the range of its amplitude is expected.
fn candidate(effect: &Effect) -> Candidate {
    /// Of the greatest amplitude, for derivatives.
    const STEP: f64 = 1e-4;
    let range = effect.amplitude().allowed;
    Candidate {
        id: effect.name().to_owned(),
        form: effect.form(),
        unit: effect.unit(),
        min: range.min,
        max: range.max,
        usual: None,
        step: STEP * range.max,
        not_testable: None,
        separable_from: String::new(),
        unresolved: Vec::new(),
    }
}
