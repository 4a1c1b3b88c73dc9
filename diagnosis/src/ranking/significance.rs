//! How large a score the best of many effects reaches by chance, and how often the right one wins.

use nalgebra::{Cholesky, DMatrix};

use crate::random::{Purpose, normal, scale_of_noise, stream};

/// Draws of the scores of all effects.
const DRAWS: usize = 10_000;

/// Keeps the collinearity of exact confounders positive definite; their scores then differ by 1e-4.
const JITTER: f64 = 1e-8;

/// Scores of all effects under noise alone, drawn with their collinearity.
pub(crate) struct NullScores {
    collinearity: DMatrix<f64>,
    draws: Vec<Vec<f64>>,
}

impl NullScores {
    /// Under noise whose size is known from `freedom` independent numbers.
    pub(crate) fn new(collinearity: DMatrix<f64>, freedom: f64, seed: u64) -> Self {
        let n = collinearity.nrows();
        let jittered = &collinearity + DMatrix::identity(n, n) * JITTER;
        // Without a factor (which rounding alone could cause) effects count as independent: cautious.
        let factor =
            Cholesky::new(jittered).map_or_else(|| DMatrix::identity(n, n), |factor| factor.l());
        let mut random = stream(seed, Purpose::Family, 0);
        let draw = |_| {
            let white: Vec<f64> = (0..n).map(|_| normal(&mut random)).collect();
            let scale =
                if freedom.is_finite() { scale_of_noise(freedom, &mut random) } else { 1.0 };
            let score = |i| (0..=i).map(|j| factor[(i, j)] * white[j]).sum::<f64>();
            (0..n).map(|i| scale * score(i)).collect()
        };
        Self { draws: (0..DRAWS).map(draw).collect(), collinearity }
    }

    /// Probability that the largest squared score reaches `delta` by chance: the error of naming any
    /// effect of the family when none is there.
    pub(crate) fn family_wise_p(&self, delta: f64) -> f64 {
        let reaches = |draw: &&Vec<f64>| draw.iter().any(|score| score * score >= delta);
        (1 + self.draws.iter().filter(reaches).count()) as f64 / (1 + DRAWS) as f64
    }

    /// Probability that effect `index` has the largest score if it is there at `strength` standard
    /// errors, itself or in another form (`is_form`).
    pub(crate) fn ranked_first(
        &self,
        index: usize,
        strength: f64,
        is_form: impl Fn(usize) -> bool,
    ) -> f64 {
        let wins = |draw: &&Vec<f64>| {
            let size = |&k: &usize| (draw[k] + strength * self.collinearity[(index, k)]).abs();
            let largest = (0..draw.len()).max_by(|j, k| size(j).total_cmp(&size(k)));
            largest.is_some_and(&is_form)
        };
        self.draws.iter().filter(wins).count() as f64 / DRAWS as f64
    }
}

/// Probability that an effect whose likelihood is ahead of another's by `lead` (in twice its logarithm) would be
/// ahead of it again, if it is there as fitted: the lead is normal, and its variance four times its mean.
pub(crate) fn leads_again(lead: f64) -> f64 {
    phi(0.5 * lead.max(0.0).sqrt())
}

/// The normal distribution function.
fn phi(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(cosine: f64) -> NullScores {
        let collinearity = DMatrix::from_row_slice(2, 2, &[1.0, cosine, cosine, 1.0]);
        NullScores::new(collinearity, f64::INFINITY, 1)
    }

    #[test]
    fn two_independent_effects_have_twice_the_chance_of_one() {
        // P(χ²₁ ≥ 6.635) = 0.01; the draws know 0.02 to ± 0.0014, here three of those.
        let p = pair(0.0).family_wise_p(6.635);
        assert!((p - 0.0199).abs() < 0.0042, "{p}");
        // Confounders are one effect.
        let p = pair(1.0).family_wise_p(6.635);
        assert!((p - 0.01).abs() < 0.003, "{p}");
    }

    #[test]
    fn a_likelihood_leads_again_as_often_as_it_does_in_draws() {
        let mut random = stream(1, Purpose::Family, 0);
        for lead in [0.5, 4.0, 9.2] {
            // Two effects √lead apart, in one direction of many; the first is there.
            let apart: f64 = f64::sqrt(lead);
            let draws = 20_000;
            let leads = (0..draws).filter(|_| {
                let x = normal(&mut random);
                (x - apart).powi(2) > x * x
            });
            let drawn = leads.count() as f64 / f64::from(draws);
            // Three standard errors of a half.
            assert!((drawn - leads_again(lead)).abs() < 0.011, "{lead}: {drawn}");
        }
    }

    /// Probability that an effect that is there at `strength` has a larger score than another at this cosine: the score
    /// of one exceeds that of the other in size where their sum and their difference have one sign, and those two are
    /// independent.
    fn beats(cosine: f64, strength: f64) -> f64 {
        let difference = phi(strength * (0.5 * (1.0 - cosine)).sqrt());
        let sum = phi(strength * (0.5 * (1.0 + cosine)).sqrt());
        difference * sum + (1.0 - difference) * (1.0 - sum)
    }

    #[test]
    fn an_effect_wins_in_any_of_its_forms() {
        let confounders = pair(1.0);
        assert!((confounders.ranked_first(0, 5.0, |k| k == 0) - 0.5).abs() < 0.03);
        assert!((confounders.ranked_first(0, 5.0, |_| true) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn drawn_and_computed_chances_of_winning_agree() {
        for (cosine, strength) in [(0.0, 2.0), (0.9, 5.0), (-0.8, 3.0)] {
            let drawn = pair(cosine).ranked_first(0, strength, |k| k == 0);
            let computed = beats(cosine, strength);
            // Three standard errors of 10⁴ draws at a half.
            assert!((drawn - computed).abs() < 0.015, "{cosine}: {drawn} {computed}");
        }
    }
}
