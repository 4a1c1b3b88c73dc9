//! The ranking as a diagnosis shows it: every effect, and why some have no place.

use serde_json::{Map, Value, json};

use crate::fit::problem::FitProblem;
use crate::forward::sensitivity::Point;
use crate::forward::{Candidate, Forward, ParameterKind};
use crate::ranking::score::{Ranking, Score};
use crate::rounding::rounded;
use crate::verdict::{RankedEffect, Status};

/// Value and unit of every parameter of the model at `point`.
fn values(forward: &dyn Forward, point: &Point) -> Map<String, Value> {
    let each = forward.parameters().iter().zip(&point.parameters);
    let of_the_model = each.filter(|(parameter, _)| parameter.kind == ParameterKind::Model);
    of_the_model
        .map(|(parameter, value)| {
            let entry = json!({ "value": rounded(parameter.told(*value)), "unit": parameter.unit });
            (parameter.name.clone(), entry)
        })
        .collect()
}

/// The ranked effects, best first, then those that were not ranked.
pub(crate) fn ranked(problem: &FitProblem<'_>, ranking: Option<&Ranking>) -> Vec<RankedEffect> {
    let candidates = problem.forward.candidates();
    let scores = ranking.map_or(&[][..], |ranking| &ranking.scores);
    let mut list: Vec<RankedEffect> = scores
        .iter()
        .map(|score| {
            let candidate = &candidates[score.candidate()];
            let (q, se) = (score.amplitude(), score.standard_error);
            let at_bound = candidate.bound_at(q);
            RankedEffect {
                id: candidate.id.clone(),
                form: candidate.form.iter().copied().collect(),
                q: Some(q),
                se: se.filter(|_| at_bound.is_none()),
                at_bound,
                usual_range: candidate.usual,
                unusual: candidate.is_unusual(q, se),
                unit: candidate.unit.clone(),
                delta: Some(score.delta),
                predicted_top1: Some(score.ranked_first),
                status: Status::Ranked,
                testable: true,
                detection_limit: Some(score.signature.detection_limit()),
                parameters: values(problem.forward, &score.point),
                note: candidate.separable_from.clone(),
                point: Some(score.point.clone()),
            }
        })
        .collect();
    let not_ranked = (0..candidates.len())
        .filter(|&index| {
            let Candidate { id, form, .. } = &candidates[index];
            let is_it = |score: &Score| candidates[score.candidate()].id == *id;
            form.is_empty() && !scores.iter().any(is_it)
        })
        .map(|index| {
            let (status, note) = why_not(&candidates[index], ranking, index);
            RankedEffect::not_ranked(&candidates[index], status, note)
        });
    list.extend(not_ranked);
    list
}

/// Why `candidate`, which is number `index`, was not ranked.
fn why_not(candidate: &Candidate, ranking: Option<&Ranking>, index: usize) -> (Status, String) {
    if let Some(why) = &candidate.not_testable {
        return (Status::NotTestable, why.clone());
    }
    let Some(ranking) = ranking else { return (Status::NotTested, "not tested".to_owned()) };
    match ranking.failed.iter().find(|(candidate, _)| *candidate == index) {
        Some((_, error)) => (Status::NotIntegrated, error.to_string()),
        None => {
            let why = "in these data the parameters of the model do the same".to_owned();
            (Status::Imitated, why)
        }
    }
}
