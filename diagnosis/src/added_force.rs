//! The force that a named effect adds along the ways of the bodies.

use serde::Serialize;

use crate::bench::Bench;
use crate::fit::Fit;
use crate::forward::{Moment, Request, Scatter};
use crate::rounding::six_digits;

/// Moments of each condition at which the force is asked for.
const MOMENTS: usize = 200;

/// What an effect adds to the force of the model that it is a part of, the other coefficients as fitted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AddedForce {
    /// Where it is greatest, against the motion (N); negative where the effect weakens the resistance.
    #[serde(serialize_with = "six_digits")]
    pub greatest: f64,
    /// Force of the model with the effect at that moment (N).
    #[serde(serialize_with = "six_digits")]
    pub of: f64,
    /// Name of the condition of that moment.
    pub condition: String,
    /// Depth of the lowest point at that moment (m).
    #[serde(serialize_with = "six_digits")]
    pub depth: f64,
    /// Speed at that moment (m/s).
    #[serde(serialize_with = "six_digits")]
    pub speed: f64,
    /// Work of the effect over that of the model with it, in all conditions that were fitted to.
    #[serde(serialize_with = "six_digits")]
    pub share_of_work: f64,
}

/// What each effect of `fit` adds. `None` of models that are no force law, of effects that are no force against the
/// motion, and where the model cannot be integrated so far.
pub(crate) fn added_forces(bench: &Bench<'_>, fit: &Fit) -> Vec<Option<AddedForce>> {
    let effects = &fit.point.effects;
    let Some(passages) = passages(bench, fit) else { return vec![None; effects.len()] };
    (0..effects.len()).map(|place| added_force(bench, &passages, place)).collect()
}

/// What bodies go through in each condition, and what they would meet without each effect.
fn passages(bench: &Bench<'_>, fit: &Fit) -> Option<Vec<(usize, Vec<Moment>)>> {
    let by = bench.forward.by_formulas().filter(|_| !fit.point.effects.is_empty())?;
    let scatter = Scatter {
        coefficients: vec![0.0; bench.forward.n_scattering_coefficients()],
        ..Scatter::default()
    };
    let (parameters, effects) = (fit.point.parameters.as_slice(), fit.point.effects.as_slice());
    let without: Vec<Vec<(usize, f64)>> = (0..effects.len())
        .map(|place| {
            let mut others = effects.to_vec();
            others[place].1 = 0.0;
            others
        })
        .collect();
    let at = |effects| Request { parameters, effects, scatter: &scatter };
    let without: Vec<Request<'_>> = without.iter().map(|effects| at(effects)).collect();
    let of = |&condition: &usize| {
        let moments = by.passage(condition, &at(effects), &without, MOMENTS).ok()?;
        Some((condition, moments))
    };
    bench.observed.fit.iter().map(of).collect()
}

fn added_force(
    bench: &Bench<'_>,
    passages: &[(usize, Vec<Moment>)],
    place: usize,
) -> Option<AddedForce> {
    let added = |moment: &Moment| moment.force - moment.others[place];
    let all = passages
        .iter()
        .flat_map(|(condition, moments)| moments.iter().map(move |moment| (*condition, moment)));
    let (condition, most) = all.max_by(|a, b| added(a.1).abs().total_cmp(&added(b.1).abs()))?;
    let works = passages.iter().flat_map(|(_, moments)| moments.windows(2)).map(|pair| {
        let (a, b) = (&pair[0], &pair[1]);
        let way = 0.5 * (a.speed + b.speed) * (b.time - a.time).max(0.0);
        [0.5 * (added(a) + added(b)) * way, 0.5 * (a.force + b.force) * way]
    });
    let [work, of_model] = works.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    (added(most) != 0.0 && of_model != 0.0).then(|| AddedForce {
        greatest: added(most),
        of: most.force,
        condition: bench.set.conditions[condition].id.clone(),
        depth: most.depth,
        speed: most.speed,
        share_of_work: work / of_model,
    })
}
