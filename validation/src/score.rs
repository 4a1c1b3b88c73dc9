//! Refits of a model with one more effect, and which of them the measurements tell apart.

use crate::bench::{Bench, BenchError, Fitted};
use crate::fit::Fit;
use crate::signature::{Signature, collinearity, signature, variance_along};
use crate::significance::NullScores;

/// Effects whose χ² falls by less than this behind the best are not told apart: odds 20 to 1.
const SEPARATE: f64 = 6.0;

/// Nor are those that would be mistaken for one another more often than once in twenty.
const CONFUSED: f64 = 0.95;

/// A model with one more effect.
#[derive(Clone, Debug)]
pub(crate) struct Score {
    pub(crate) signature: Signature,
    /// Fit with the effect, which is the last of its effects.
    pub(crate) fit: Fit,
    /// Fall of χ², over the variance that the repeats show along the signature where that is larger.
    pub(crate) delta: f64,
    /// Predicted probability that it is ranked first, if it is there as fitted.
    pub(crate) ranked_first: f64,
}

impl Score {
    /// Index of the candidate.
    pub(crate) fn candidate(&self) -> usize {
        self.signature.candidate
    }

    /// Fitted amplitude.
    pub(crate) fn amplitude(&self) -> f64 {
        self.fit.point.effects.last().map_or(0.0, |(_, q)| *q)
    }

    /// Its standard error; 0 at a bound.
    pub(crate) fn standard_error(&self) -> f64 {
        self.fit.standard_error(self.fit.covariance.nrows() - 1)
    }

    fn strength(&self) -> f64 {
        self.amplitude().abs() * self.signature.norm
    }
}

/// All effects that could be added, best first.
pub(crate) struct Ranking {
    pub(crate) scores: Vec<Score>,
    /// Probability that the best falls so far by chance.
    pub(crate) p: f64,
    /// Places in `scores` by rows of the null scores.
    rows: Vec<usize>,
    null: NullScores,
}

impl Ranking {
    /// Refits `fitted` with each of `candidates` (indices), under the weights of `fitted`.
    pub(crate) fn of(
        bench: &Bench<'_>,
        fitted: &Fitted,
        candidates: &[usize],
        seed: u64,
    ) -> Result<Self, BenchError> {
        let mut signatures = Vec::new();
        for &candidate in candidates {
            signatures.extend(signature(bench, fitted, candidate)?);
        }
        let null = NullScores::new(collinearity(&signatures), seed);
        let mut scores = Vec::with_capacity(signatures.len());
        for signature in signatures {
            scores.push(refit(bench, fitted, signature)?);
        }
        for (row, score) in scores.iter_mut().enumerate() {
            score.ranked_first = null.ranked_first(row, score.strength());
        }
        let mut rows: Vec<usize> = (0..scores.len()).collect();
        rows.sort_by(|&a, &b| scores[b].delta.total_cmp(&scores[a].delta));
        let mut scores: Vec<Option<Score>> = scores.into_iter().map(Some).collect();
        let scores: Vec<Score> = rows.iter().filter_map(|&row| scores[row].take()).collect();
        let p = scores.first().map_or(1.0, |best| null.family_wise_p(best.delta));
        Ok(Self { scores, p, rows, null })
    }

    /// The best few of `candidates`, judged by their first-order scores, refitted.
    pub(crate) fn best_of(
        bench: &Bench<'_>,
        fitted: &Fitted,
        candidates: &[usize],
        count: usize,
    ) -> Result<Vec<Score>, BenchError> {
        let mut signatures = Vec::new();
        for &candidate in candidates {
            signatures.extend(signature(bench, fitted, candidate)?);
        }
        signatures.sort_by(|a, b| b.score.abs().total_cmp(&a.score.abs()));
        signatures.truncate(count);
        signatures.into_iter().map(|signature| refit(bench, fitted, signature)).collect()
    }

    /// Probability that the best of all effects reaches the fall of χ² of `candidate` by chance; 1 if
    /// it was not ranked.
    pub(crate) fn p_of(&self, candidate: usize) -> f64 {
        let score = self.scores.iter().find(|score| score.candidate() == candidate);
        score.map_or(1.0, |score| self.null.family_wise_p(score.delta))
    }

    /// Places of the effects that cannot be told from the best, itself included.
    pub(crate) fn not_separable(&self) -> Vec<usize> {
        let Some(best) = self.scores.first() else { return Vec::new() };
        let confused = |place: usize| {
            best.delta - self.scores[place].delta < SEPARATE
                || self.null.beats(self.rows[0], self.rows[place], best.strength()) < CONFUSED
        };
        (0..self.scores.len()).filter(|&place| place == 0 || confused(place)).collect()
    }
}

fn refit(bench: &Bench<'_>, fitted: &Fitted, signature: Signature) -> Result<Score, BenchError> {
    let candidate = signature.candidate;
    let mut start = fitted.fit.point.clone();
    start.effects.push((candidate, signature.first_guess(&bench.forward.candidates()[candidate])));
    let data = bench.data(&fitted.weights);
    let mut fit = data.fit(&start)?;
    if fit.chi2 > fitted.fit.chi2 {
        // A first guess beyond what the effect is linear in; absent, it is no worse than before.
        if let Some(last) = start.effects.last_mut() {
            last.1 = 0.0;
        }
        fit = data.fit(&start)?;
    }
    let scale = variance_along(bench, fitted, &signature.unit).max(1.0);
    let delta = (fitted.fit.chi2 - fit.chi2).max(0.0) / scale;
    Ok(Score { signature, fit, delta, ranked_first: 0.0 })
}
