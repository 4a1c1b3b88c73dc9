//! Two effects at once, for when no single one is enough.

use crate::bench::{Bench, BenchError, Fitted};
use crate::chord::extend;
use crate::score::{Ranking, Score, by_chance};
use crate::sensitivity::Point;
use crate::signature::Signature;

/// How many of all pairs are refitted, those with the largest fall of χ² to first order.
const REFITTED: usize = 10;

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

/// The best pair of the effects of `singles`, which add to `baseline`.
pub(crate) fn best_pair(
    bench: &Bench<'_>,
    baseline: &Fitted,
    singles: &Ranking,
    seed: u64,
) -> Result<Option<Pair>, BenchError> {
    let data = bench.data(&baseline.weights);
    let mut best: Option<(f64, Point)> = None;
    for guess in promising(singles, bench) {
        let [a, b] = guess.members;
        let mut start = baseline.fit.point.clone();
        start
            .effects
            .extend([(a.candidate, guess.amplitudes[0]), (b.candidate, guess.amplitudes[1])]);
        let extended = extend(&data, &baseline.fit, &start, &[&a.slope, &b.slope]);
        let Ok(Some(extended)) = extended else { continue };
        if best.as_ref().is_none_or(|(least, _)| extended.chi2 < *least) {
            best = Some((extended.chi2, extended.point));
        }
    }
    let Some((_, best)) = best else { return Ok(None) };
    let fitted = bench.fit_once(&best, &baseline.noise)?;
    let mut candidates: Vec<usize> = singles.scores.iter().map(Score::candidate).collect();
    candidates.sort_unstable();
    let mut p = 0.0_f64;
    for member in 0..2 {
        // The model without one member, under the weights of the pair; what does it explain?
        let mut alone = fitted.fit.point.clone();
        let (removed, _) = alone.effects.remove(member);
        let fit = bench.data(&fitted.weights).fit(&alone)?;
        let fall = fit.chi2 - fitted.fit.chi2;
        let without_it = Fitted { fit, ..fitted.clone() };
        let others: Vec<usize> =
            candidates.iter().copied().filter(|&other| other != alone.effects[0].0).collect();
        p = p.max(by_chance(bench, &without_it, &others, (removed, fall), seed));
    }
    Ok(Some(Pair { fitted, p }))
}

/// Two effects with amplitudes to first order.
struct Guess<'a> {
    members: [&'a Signature; 2],
    amplitudes: [f64; 2],
    fall: f64,
}

/// The pairs that lower χ² most to first order, within the ranges of the amplitudes.
fn promising<'a>(singles: &'a Ranking, bench: &Bench<'_>) -> Vec<Guess<'a>> {
    let scores = &singles.scores;
    let mut guesses = Vec::new();
    for (at, a) in scores.iter().enumerate() {
        for b in &scores[at + 1..] {
            guesses.extend(guess([&a.signature, &b.signature], bench));
        }
    }
    guesses.sort_by(|a, b| b.fall.total_cmp(&a.fall));
    guesses.truncate(REFITTED);
    guesses
}

/// `None` for two that look the same, or of which one would have to be absent.
fn guess<'a>(members: [&'a Signature; 2], bench: &Bench<'_>) -> Option<Guess<'a>> {
    let [a, b] = members;
    let cosine = a.unit.dot(&b.unit);
    if cosine.abs() > ALIKE {
        return None;
    }
    let own = 1.0 - cosine * cosine;
    let along = [(a.score - cosine * b.score) / own, (b.score - cosine * a.score) / own];
    let candidates = bench.forward.candidates();
    let amplitudes: [f64; 2] = std::array::from_fn(|at| {
        let candidate = &candidates[members[at].candidate];
        (along[at] / members[at].norm).clamp(candidate.min, candidate.max)
    });
    if amplitudes.contains(&0.0) {
        return None;
    }
    let [x, y] = std::array::from_fn(|at| amplitudes[at] * members[at].norm);
    let fall = 2.0 * (x * a.score + y * b.score) - (x * x + y * y + 2.0 * cosine * x * y);
    Some(Guess { members, amplitudes, fall })
}
