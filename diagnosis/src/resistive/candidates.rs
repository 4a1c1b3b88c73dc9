//! What a diagnosis is told of the effects that could be added.

use measurements::MeasurementSet;
use resistive::{Confounder, Effect, confounders};

use super::needs::{contains, missing};
use crate::forward::Candidate;

/// A derivative is taken over this share of the greatest amplitude that one would expect.
const STEP: f64 = 1e-3;

/// `effects` as candidates before `set`, in their order.
pub(super) fn of(effects: &[Effect], set: &MeasurementSet) -> Vec<Candidate> {
    let mut candidates: Vec<Candidate> =
        effects.iter().map(|effect| candidate(effect, set)).collect();
    let testable: Vec<String> = candidates
        .iter()
        .filter(|candidate| candidate.not_testable.is_none())
        .map(|candidate| candidate.id.clone())
        .collect();
    for candidate in candidates.iter_mut().filter(|one| one.not_testable.is_none()) {
        candidate.unresolved = confounders(&candidate.id)
            .filter(|confounder| !confounder.any_of.iter().any(|need| contains(set, *need)))
            .map(|confounder| confounder.effect.to_owned())
            .filter(|confounder| testable.contains(confounder))
            .collect();
    }
    candidates
}

fn candidate(effect: &Effect, set: &MeasurementSet) -> Candidate {
    let spec = effect.amplitude();
    let lacks: Vec<&str> =
        missing(&effect.visible(), set).into_iter().map(|need| need.describe()).collect();
    let from = |confounder: Confounder| format!("from {}", confounder.describe());
    Candidate {
        id: effect.name().to_owned(),
        form: effect.form(),
        unit: effect.unit(),
        min: spec.allowed.min,
        max: spec.allowed.max,
        usual: Some([spec.plausible.min, spec.plausible.max]),
        step: STEP * spec.plausible.max,
        not_testable: (!lacks.is_empty()).then(|| format!("needs {}", lacks.join(" and "))),
        separable_from: confounders(effect.name()).map(from).collect::<Vec<_>>().join(", "),
        unresolved: Vec::new(),
    }
}
