//! Two effects at once, for when no single one is enough.

use crate::bench::{Bench, BenchError, Fitted};
use crate::score::{Ranking, Score, by_chance};

/// How many first members are tried, best singles first.
const FIRST: usize = 3;

/// How many second members are tried with each.
const SECOND: usize = 4;

/// Two effects, fitted together under their own noise.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// The fit with both.
    pub(crate) fitted: Fitted,
    /// Probability by chance of each, given the other; the larger of the two.
    pub(crate) p: f64,
}

/// The best pair with a member among the best of `singles`, which add to `baseline`.
pub(crate) fn best_pair(
    bench: &Bench<'_>,
    baseline: &Fitted,
    singles: &Ranking,
    seed: u64,
) -> Result<Option<Pair>, BenchError> {
    let mut candidates: Vec<usize> = singles.scores.iter().map(Score::candidate).collect();
    candidates.sort_unstable();
    let mut best: Option<(f64, Score)> = None;
    for first in singles.scores.iter().take(FIRST) {
        // Under the weights that the singles were ranked with, so that all pairs compare.
        let fit = bench.data(&baseline.weights).fit(&first.point)?;
        let with_first = Fitted { fit, ..baseline.clone() };
        let others = without(&candidates, first.candidate());
        for score in Ranking::best_of(bench, &with_first, &others, SECOND)? {
            let chi2 = bench.data(&baseline.weights).residual(&score.point)?.norm_squared();
            if best.as_ref().is_none_or(|(least, _)| chi2 < *least) {
                best = Some((chi2, score));
            }
        }
    }
    let Some((_, best)) = best else { return Ok(None) };
    let fitted = bench.fit_from(&best.point, &baseline.noise)?;
    let mut p = 0.0_f64;
    for member in 0..2 {
        // The model without one member, under the weights of the pair; what does it explain?
        let mut alone = fitted.fit.point.clone();
        let (removed, _) = alone.effects.remove(member);
        let fit = bench.data(&fitted.weights).fit(&alone)?;
        let fall = fit.chi2 - fitted.fit.chi2;
        let without_it = Fitted { fit, ..fitted.clone() };
        let others = without(&candidates, alone.effects[0].0);
        p = p.max(by_chance(bench, &without_it, &others, (removed, fall), seed));
    }
    Ok(Some(Pair { fitted, p }))
}

fn without(candidates: &[usize], one: usize) -> Vec<usize> {
    candidates.iter().copied().filter(|&other| other != one).collect()
}
