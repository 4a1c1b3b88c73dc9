//! Refits of a model with one more effect, and which of them the measurements tell apart.

use rayon::prelude::*;

use crate::fit::Fit;
use crate::fit::broyden::{extend, improve};
use crate::fit::problem::{FitProblem, Fitted};
use crate::forward::PredictError;
use crate::forward::sensitivity::Point;
use crate::noise::NoiseSource;
use crate::ranking::marginal::Marginals;
use crate::ranking::signature::{Signature, collinearity, signature, variance_along};
use crate::ranking::significance::{NullScores, leads_again};

/// How many of the best, with their forms, are refitted with derivatives of their own.
const POLISHED: usize = 3;

/// Fall of χ² by which another form of an effect has to be better than the one that is listed: odds of 10 to 1.
const OTHER_FORM: f64 = 4.6;

/// Fall of χ² by which a fit from another start has to be better to be another minimum, and not the same one again.
const OTHER_MINIMUM: f64 = 0.1;

/// Confounders whose signatures have at least this cosine are one force under these conditions.
const SAME: f64 = 0.999;

/// A model with one more effect.
#[derive(Clone, Debug)]
pub(crate) struct Score {
    pub(crate) signature: Signature,
    /// Parameters and amplitudes, that of the effect last.
    pub(crate) point: Point,
    /// Standard error of its amplitude, enlarged as the fall of χ² is reduced; none at a bound.
    pub(crate) standard_error: Option<f64>,
    /// Fall of χ², or of twice the negative logarithm of a likelihood, over the variance that the repeats show along the
    /// signature of the best effect, where that is larger than one.
    pub(crate) delta: f64,
    /// Amplitude in standard errors.
    strength: f64,
    /// Predicted probability that it is ranked first, if it is there as fitted.
    pub(crate) ranked_first: f64,
}

impl Score {
    /// Index of the candidate.
    pub(crate) fn candidate(&self) -> usize {
        self.signature.candidate
    }

    /// Takes the place of `fit`, where χ² is `before` without the effect.
    fn take(&mut self, before: f64, fit: Fit) {
        self.delta = (before - fit.chi2).max(0.0);
        self.standard_error = fit.standard_error(fit.covariance.nrows() - 1);
        self.point = fit.point;
    }

    /// Fitted amplitude.
    pub(crate) fn amplitude(&self) -> f64 {
        self.point.effects.last().map_or(0.0, |(_, q)| *q)
    }

    /// Whether it changes nothing.
    pub(crate) fn is_nil(&self) -> bool {
        self.amplitude().abs() < f64::MIN_POSITIVE
    }
}

/// All effects that could be added, best first.
pub(crate) struct Ranking {
    pub(crate) scores: Vec<Score>,
    /// Probability that the best falls so far by chance.
    pub(crate) p: f64,
    null: NullScores,
    /// Candidates with which the model cannot be integrated, and why.
    pub(crate) failed: Vec<(usize, PredictError)>,
}

impl Ranking {
    /// Adds each of `candidates` (indices) to `fitted` and refits, under its weights.
    pub(crate) fn of(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        candidates: &[usize],
        seed: u64,
    ) -> Self {
        let (signatures, failed) = signatures(problem, fitted, candidates);
        let mut scores: Vec<Score> =
            signatures.into_par_iter().map(|signature| refit(problem, fitted, signature)).collect();
        scores.par_iter_mut().for_each(|score| start_over(problem, fitted, score));
        let id = |score: &Score| &problem.forward.candidates()[score.candidate()].id;
        let (mut leaders, mut rows) = (Vec::new(), Vec::new());
        for row in best_first(&scores) {
            if !leaders.contains(&id(&scores[row])) {
                leaders.push(id(&scores[row]));
            }
            if leaders.len() > POLISHED || scores[row].delta <= 0.0 {
                break;
            }
            rows.push(row);
        }
        let polished = |&row: &usize| (row, polished(problem, fitted, &scores[row]));
        for (row, fit) in rows.par_iter().map(polished).collect::<Vec<_>>() {
            if let Some(fit) = fit {
                scores[row].take(fitted.fit.chi2, fit);
            }
        }
        start_from_best_form(problem, fitted, &mut scores, &rows);
        Self::ranked(problem, fitted, scores, failed, seed)
    }

    /// Of the `marginals` of candidates, which have weights of their own; those of `fitted` say how alike the
    /// candidates are.
    pub(crate) fn by_likelihood(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        marginals: &Marginals,
        seed: u64,
    ) -> Self {
        let mut failed = marginals.failed.clone();
        let mut scores = Vec::with_capacity(marginals.best.len());
        for marginal in &marginals.best {
            match signature(problem, fitted, marginal.candidate) {
                Ok(signature) => scores.extend(signature.map(|signature| Score {
                    delta: marginal.fall,
                    point: marginal.point.clone(),
                    standard_error: marginal.standard_error,
                    signature,
                    strength: 0.0,
                    ranked_first: 0.0,
                })),
                Err(why) => failed.push((marginal.candidate, why)),
            }
        }
        let mut ranking = Self::ranked(problem, fitted, scores, failed, seed);
        // Falls under covariances of their own are no squares of normal scores.
        ranking.p = marginals.p;
        // How alike effects are under one covariance says too little of those that have each their own.
        let falls: Vec<f64> = ranking.scores.iter().map(|score| score.delta).collect();
        for (place, score) in ranking.scores.iter_mut().enumerate() {
            let rival =
                if place == 0 { falls.get(1).copied().unwrap_or(0.0) } else { falls[place] };
            score.ranked_first = leads_again(falls[0] - rival);
        }
        ranking
    }

    /// All falls of χ² are measured in the variance that the repeats show along the signature of the
    /// best: each in its own would rank by how well that variance happens to be known.
    fn ranked(
        problem: &FitProblem<'_>,
        fitted: &Fitted,
        mut scores: Vec<Score>,
        failed: Vec<(usize, PredictError)>,
        seed: u64,
    ) -> Self {
        let signatures: Vec<&Signature> = scores.iter().map(|score| &score.signature).collect();
        let null = NullScores::new(collinearity(&signatures), freedom(problem, fitted), seed);
        let rows = best_first(&scores);
        let scale = rows.first().map_or(1.0, |&best| {
            variance_along(problem, fitted, &scores[best].signature.unit).max(1.0)
        });
        for score in &mut scores {
            score.delta /= scale;
            score.standard_error = score.standard_error.map(|se| se * scale.sqrt());
            score.strength = score.amplitude().abs() * score.signature.norm / scale.sqrt();
        }
        let rows = one_form_each(problem, &scores, &rows);
        let effect = |row: usize| &problem.forward.candidates()[scores[row].candidate()].id;
        let first = rows.iter().map(|&row| {
            null.ranked_first(row, scores[row].strength, |other| effect(other) == effect(row))
        });
        let first: Vec<f64> = first.collect();
        rows.iter().zip(first).for_each(|(&row, first)| scores[row].ranked_first = first);
        let mut scores: Vec<Option<Score>> = scores.into_iter().map(Some).collect();
        let scores: Vec<Score> = rows.iter().filter_map(|&row| scores[row].take()).collect();
        let p = scores.first().map_or(1.0, |best| null.family_wise_p(best.delta));
        Self { scores, p, null, failed }
    }

    /// Takes the best out, since the model cannot be integrated around its fit.
    pub(crate) fn give_up_first(&mut self, why: PredictError) {
        let first = self.scores.remove(0);
        self.failed.push((first.candidate(), why));
        self.p = self.scores.first().map_or(1.0, |best| self.null.family_wise_p(best.delta));
    }

    /// Places of the effects that cannot be told from the best, itself included: those that help, and whose fall is
    /// within the odds of the model. A confounder farther behind, which the data lack the means to tell from the best, is
    /// one of them only where both are one force under these conditions and no end of its range holds it back:
    /// what explains less by more than the odds is told apart by that.
    pub(crate) fn not_separable(&self, problem: &FitProblem<'_>) -> Vec<usize> {
        let candidates = problem.forward.candidates();
        let Some(best) = self.scores.first() else { return Vec::new() };
        let confounders = &candidates[best.candidate()].unresolved;
        let within = problem.forward.separation();
        let confused = |other: &Score| {
            let candidate = &candidates[other.candidate()];
            let is_same = || {
                confounders.contains(&candidate.id)
                    && candidate.bound_at(other.amplitude()).is_none()
                    && best.signature.unit.dot(&other.signature.unit).abs() >= SAME
            };
            other.delta > 0.0 && !other.is_nil() && (best.delta - other.delta < within || is_same())
        };
        let others = (1..self.scores.len()).filter(|&place| confused(&self.scores[place]));
        std::iter::once(0).chain(others).collect()
    }
}

/// Probability that the best of `candidates` lowers the χ² of `fitted` by `fall` or more by chance,
/// where `candidate` is the one that does; 1 if the parameters do the same as it.
pub(crate) fn by_chance(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    candidates: &[usize],
    (candidate, fall): (usize, f64),
    seed: u64,
) -> f64 {
    let (signatures, _) = signatures(problem, fitted, candidates);
    let Some(own) = signatures.iter().find(|signature| signature.candidate == candidate) else {
        return 1.0;
    };
    let scale = variance_along(problem, fitted, &own.unit).max(1.0);
    let all: Vec<&Signature> = signatures.iter().collect();
    NullScores::new(collinearity(&all), freedom(problem, fitted), seed).family_wise_p(fall / scale)
}

/// From how many numbers the size of the noise of `fitted` is known; infinite where it is stated.
fn freedom(problem: &FitProblem<'_>, fitted: &Fitted) -> f64 {
    match fitted.noise.source {
        NoiseSource::Repeats => problem.observed.freedom(),
        _ => f64::INFINITY,
    }
}

/// The signatures that exist, and the candidates whose failed.
pub(crate) fn signatures(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    candidates: &[usize],
) -> (Vec<Signature>, Vec<(usize, PredictError)>) {
    let each = candidates.par_iter().map(|&one| (one, signature(problem, fitted, one)));
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for (candidate, signature) in each.collect::<Vec<_>>() {
        match signature {
            Ok(signature) => found.extend(signature),
            Err(error) => failed.push((candidate, error)),
        }
    }
    (found, failed)
}

/// The fall of χ² by a refit with derivatives that are kept.
fn refit(problem: &FitProblem<'_>, fitted: &Fitted, signature: Signature) -> Score {
    let data = problem.data(&fitted.weights);
    let extended = extend(&data, &fitted.fit, &[(signature.candidate, &signature.slope)]);
    Score {
        delta: (fitted.fit.chi2 - extended.chi2).max(0.0),
        point: extended.point,
        standard_error: extended.standard_error,
        signature,
        strength: 0.0,
        ranked_first: 0.0,
    }
}

/// The same with derivatives of its own, from there, if the model can be integrated around it.
fn polished(problem: &FitProblem<'_>, fitted: &Fitted, score: &Score) -> Option<Fit> {
    problem.data(&fitted.weights).fit_as_listed(&score.point).ok()
}

/// The same from where parameters start, first with the apparatus as it is stated, if that explains more: around a fit
/// in which errors of the apparatus and a scatter between conditions make up for what the model lacks, derivatives say
/// little of what an effect would do.
fn start_over(problem: &FitProblem<'_>, fitted: &Fitted, score: &mut Score) {
    let data = problem.data(&fitted.weights);
    let least = fitted.fit.chi2 - score.delta - OTHER_MINIMUM;
    let Ok(stated) = data.fit_with_apparatus_as_stated(score.candidate(), &fitted.fit) else {
        return;
    };
    // Kept derivatives say at little cost whether a search can come this far.
    if improve(&data, &stated, fitted.fit.chi2).chi2 > least {
        return;
    }
    if let Some(fit) = data.fit_as_listed(&stated.point).ok().filter(|fit| fit.chi2 < least) {
        score.take(fitted.fit.chi2, fit);
    }
}

/// The other forms among `rows` of the effect that explains most, from the parameters of its best form, if that explains
/// more: each form may end in a minimum of its own, where errors of the apparatus make up for it.
fn start_from_best_form(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    scores: &mut [Score],
    rows: &[usize],
) {
    let id = |score: &Score| &problem.forward.candidates()[score.candidate()].id;
    let Some(best) =
        rows.iter().copied().max_by(|&a, &b| scores[a].delta.total_cmp(&scores[b].delta))
    else {
        return;
    };
    let parameters = scores[best].point.parameters.clone();
    let others = rows.iter().filter(|&&row| row != best && id(&scores[row]) == id(&scores[best]));
    let fits: Vec<(usize, Option<Fit>)> = others
        .map(|&row| {
            let start = Point { parameters: parameters.clone(), ..scores[row].point.clone() };
            (row, problem.data(&fitted.weights).fit_as_listed(&start).ok())
        })
        .collect();
    for (row, fit) in fits {
        if let Some(fit) = fit.filter(|fit| fitted.fit.chi2 - fit.chi2 > scores[row].delta) {
            scores[row].take(fitted.fit.chi2, fit);
        }
    }
}

/// Those of `rows`, best first, that are the form of their effect: the one that explains most, in its place; the one
/// that is listed unless another explains more by [`OTHER_FORM`].
fn one_form_each(problem: &FitProblem<'_>, scores: &[Score], rows: &[usize]) -> Vec<usize> {
    let candidate = |row: usize| &problem.forward.candidates()[scores[row].candidate()];
    let mut kept: Vec<usize> = Vec::new();
    for &row in rows {
        match kept.iter_mut().find(|&&mut other| candidate(other).id == candidate(row).id) {
            None => kept.push(row),
            Some(better) => {
                let behind = scores[*better].delta - scores[row].delta;
                if candidate(row).form.is_empty() && behind < OTHER_FORM {
                    *better = row;
                }
            }
        }
    }
    kept.sort_by(|&a, &b| scores[b].delta.total_cmp(&scores[a].delta));
    kept
}

fn best_first(scores: &[Score]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..scores.len()).collect();
    rows.sort_by(|&a, &b| scores[b].delta.total_cmp(&scores[a].delta));
    rows
}
