//! What a diagnosis is told of the effects that could be added.

use contact_laws::{ResistanceEntry, Role, Twin, twins};

use super::needs::{contains, missing};
use crate::forward::Candidate;
use crate::measurement::MeasurementSet;

/// A derivative is taken over this share of the greatest amplitude that one would expect.
const STEP: f64 = 1e-3;

/// `effects` as candidates before `set`, in their order.
pub(super) fn of(effects: &[&'static ResistanceEntry], set: &MeasurementSet) -> Vec<Candidate> {
    let mut candidates: Vec<Candidate> =
        effects.iter().map(|entry| candidate(entry, set)).collect();
    let testable: Vec<String> = candidates
        .iter()
        .filter(|candidate| candidate.not_testable.is_none())
        .map(|candidate| candidate.id.clone())
        .collect();
    for candidate in candidates.iter_mut().filter(|one| one.not_testable.is_none()) {
        candidate.unresolved = twins(&candidate.id)
            .filter(|twin| !twin.any_of.iter().any(|need| contains(set, *need)))
            .map(|twin| twin.effect.to_owned())
            .filter(|twin| testable.contains(twin))
            .collect();
    }
    candidates
}

fn candidate(entry: &ResistanceEntry, set: &MeasurementSet) -> Candidate {
    let Role::Effect(facts) = entry.role else { unreachable!("only effects are candidates") };
    let spec = &entry.params[0];
    let lacks: Vec<&str> =
        missing(facts.visible, set).into_iter().map(|need| need.describe()).collect();
    let from = |twin: Twin| format!("from {}", twin.describe());
    Candidate {
        id: entry.name.to_owned(),
        unit: facts.unit.to_owned(),
        min: spec.allowed.min,
        max: spec.allowed.max,
        step: STEP * spec.plausible.max,
        not_testable: (!lacks.is_empty()).then(|| format!("needs {}", lacks.join(" and "))),
        separable_from: twins(entry.name).map(from).collect::<Vec<_>>().join(", "),
        unresolved: Vec::new(),
    }
}
