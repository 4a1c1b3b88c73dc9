//! What a push is too slow to show.

use measurements::{Kind, MeasurementSet};

use crate::forward::{Forward, Request, Scatter};

/// Share of the force below which nobody sees a change: load cells are as good.
pub(super) const SEEN: f64 = 1e-3;

/// Why the candidates that [`unseen`] gives are not tested.
pub(super) const WHY: &str = "needs a faster push: at its usual size it changes no force by 0.1 %";

/// Candidates that at their largest usual amplitude change no force of `set` by as much as is seen. At one slow speed
/// any force of the speed would else stand for a constant one, with an amplitude that no bed has.
pub(super) fn unseen(forward: &dyn Forward, set: &MeasurementSet) -> Vec<usize> {
    if set.kind != Kind::ForceDepth {
        return Vec::new();
    }
    let start: Vec<f64> = forward.parameters().iter().map(|one| one.start).collect();
    let still = Scatter::default();
    let all = |effects: &[(usize, f64)]| -> Vec<Option<Vec<f64>>> {
        let at = Request { parameters: &start, effects, scatter: &still };
        (0..set.conditions.len()).map(|index| forward.predict(index, &at).ok()).collect()
    };
    let before = all(&[]);
    let is_seen = |index: usize, q: f64| {
        // What cannot be computed is told where it is fitted.
        let with = all(&[(index, q)]);
        with.iter().zip(&before).any(|(with, before)| match (with, before) {
            (Some(with), Some(before)) => differs(before, with, SEEN),
            _ => true,
        })
    };
    let candidates = forward.candidates().iter().enumerate();
    candidates
        .filter(|(index, candidate)| {
            let is_hidden = |ends: [f64; 2]| !ends.iter().any(|q| *q != 0.0 && is_seen(*index, *q));
            candidate.not_testable.is_none() && candidate.usual.is_some_and(is_hidden)
        })
        .map(|(index, _)| index)
        .collect()
}

/// Whether two predictions differ by more than `share` of the greatest of the first anywhere.
pub(super) fn differs(one: &[f64], other: &[f64], share: f64) -> bool {
    let greatest = one.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    one.iter().zip(other).any(|(a, b)| (a - b).abs() > share * greatest)
}
