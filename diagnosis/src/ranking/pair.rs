//! Two effects at once, for when no single one is enough.

use rayon::prelude::*;

use crate::fit::broyden::{Extended, extend};
use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::Candidate;
use crate::ranking::score::{Ranking, Score, by_chance, signatures};
use crate::ranking::signature::Signature;

/// How many of all pairs are refitted, those with the largest fall of χ² to first order.
const REFITTED: usize = 6;

/// How many of the best singles are refitted with each other effect that promises to help them.
const FIRST: usize = 2;

/// How many such effects.
const SECOND: usize = 4;

/// Effects more alike than this cannot both be seen.
const ALIKE: f64 = 0.995;

/// Two effects, fitted together under their own noise.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// The fit with both.
    pub(crate) fitted: Fitted,
    /// Probability by chance of each, given the other; the larger of the two.
    pub(crate) p: f64,
}

/// Indices of the two of `candidates` that together explain most of what `baseline` leaves over, if any pair does.
///
/// # Errors
/// If a pair cannot be fitted.
pub fn best_two(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    candidates: &[usize],
    seed: u64,
) -> Result<Option<Vec<usize>>, FitError> {
    let singles = Ranking::of(problem, baseline, candidates, seed);
    let pair = best_pair(problem, baseline, &singles, seed)?;
    Ok(pair.map(|pair| pair.fitted.fit.point.effects.iter().map(|&(index, _)| index).collect()))
}

/// The best pair of the effects of `singles`, which add to `baseline`.
pub(crate) fn best_pair(
    problem: &FitProblem<'_>,
    baseline: &Fitted,
    singles: &Ranking,
    seed: u64,
) -> Result<Option<Pair>, FitError> {
    let data = problem.data(&baseline.weights);
    let mut tried: Vec<Extended> = promising(singles, problem)
        .par_iter()
        .map(|[a, b]| {
            extend(&data, &baseline.fit, &[(a.candidate, &a.slope), (b.candidate, &b.slope)])
        })
        .collect();
    for first in singles.scores.iter().take(FIRST) {
        let Ok(fit) = data.fit(&first.point) else { continue };
        let with_first = Fitted { fit, ..baseline.clone() };
        let others = singles.scores.iter().map(Score::candidate);
        let others: Vec<usize> = others.filter(|&other| other != first.candidate()).collect();
        let second = promising_beside(problem, &with_first, &others).into_par_iter();
        tried
            .par_extend(second.map(|second| {
                extend(&data, &with_first.fit, &[(second.candidate, &second.slope)])
            }));
    }
    let best = tried.into_iter().min_by(|a, b| a.chi2.total_cmp(&b.chi2));
    let Some(best) = best else { return Ok(None) };
    let fitted = match problem.fit_once(&best.point, &baseline.noise) {
        // A pair around which the model cannot be integrated explains nothing.
        Err(FitError::Predict(_)) => return Ok(None),
        other => other?,
    };
    let mut candidates: Vec<usize> = singles.scores.iter().map(Score::candidate).collect();
    candidates.sort_unstable();
    let data = problem.data(&fitted.weights);
    let mut p = 0.0_f64;
    for member in 0..2 {
        // The model without one member, under the weights of the pair; what does it explain?
        let mut alone = fitted.fit.point.clone();
        let (removed, _) = alone.effects.remove(member);
        // The amplitude that goes with the other may be too much for one.
        let fit = data.fit(&alone).or_else(|_| {
            alone.effects[0].1 = 0.0;
            data.fit(&alone)
        })?;
        let fall = fit.chi2 - fitted.fit.chi2;
        let without_it = Fitted { fit, ..fitted.clone() };
        let others: Vec<usize> =
            candidates.iter().copied().filter(|&other| other != alone.effects[0].0).collect();
        p = p.max(by_chance(problem, &without_it, &others, (removed, fall), seed));
    }
    Ok(Some(Pair { fitted, p }))
}

/// The pairs that lower χ² most to first order.
fn promising<'a>(singles: &'a Ranking, problem: &FitProblem<'_>) -> Vec<[&'a Signature; 2]> {
    let scores = &singles.scores;
    let mut pairs = Vec::new();
    for (at, a) in scores.iter().enumerate() {
        for b in &scores[at + 1..] {
            let members = [&a.signature, &b.signature];
            pairs.extend(fall(members, problem).map(|fall| (fall, members)));
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs.into_iter().take(REFITTED).map(|(_, members)| members).collect()
}

/// The effects of `others` that lower the χ² of `fitted` most to first order.
fn promising_beside(problem: &FitProblem<'_>, fitted: &Fitted, others: &[usize]) -> Vec<Signature> {
    let (mut signatures, _) = signatures(problem, fitted, others);
    signatures.sort_by(|a, b| b.score.abs().total_cmp(&a.score.abs()));
    signatures.truncate(SECOND);
    signatures
}

/// The fall of χ² by both of `members` to first order, within the ranges of their amplitudes; `None`
/// for two that look the same, or of which one would have to be absent.
fn fall(members: [&Signature; 2], problem: &FitProblem<'_>) -> Option<f64> {
    let [a, b] = members;
    let cosine = a.unit.dot(&b.unit);
    if cosine.abs() > ALIKE {
        return None;
    }
    let own = 1.0 - cosine * cosine;
    let along = [(a.score - cosine * b.score) / own, (b.score - cosine * a.score) / own];
    let candidates = problem.forward.candidates();
    let within: [f64; 2] = std::array::from_fn(|at| {
        let Signature { candidate, norm, .. } = members[at];
        let Candidate { min, max, .. } = candidates[*candidate];
        (along[at] / norm).clamp(min, max) * norm
    });
    let [x, y] = within;
    let fall = 2.0 * (x * a.score + y * b.score) - (x * x + y * y + 2.0 * cosine * x * y);
    (x != 0.0 && y != 0.0).then_some(fall)
}
