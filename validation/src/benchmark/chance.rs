//! Random numbers of the world: every set has its own, whichever others are drawn.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A source of random numbers.
#[derive(Clone, Debug)]
pub struct Chance(Pcg64);

impl Chance {
    /// The source with number `seed`.
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// Another source, of which this one draws nothing.
    pub fn apart(&self) -> Self {
        let mut copy = self.0.clone();
        Self::new(copy.random::<u64>() ^ 0x9e37_79b9_7f4a_7c15)
    }

    /// Evenly between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// A normal number with mean 0 and variance 1 (polar method; Marsaglia & Bray 1964, SIAM Rev. 6, 260).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (u, v) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            let square = u * u + v * v;
            if square > 0.0 && square < 1.0 {
                return u * (-2.0 * libm::log(square) / square).sqrt();
            }
        }
    }

    /// One of `0..n`, for an `n` above 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.0.random::<f64>() * n as f64) as usize).min(n.saturating_sub(1))
    }
}

/// A normal number with mean 0 and variance 1, of other sources (Box & Muller 1958, Ann. Math. Stat. 29, 610).
pub fn normal(random: &mut impl Rng) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - random.random::<f64>())).sqrt();
    radius * libm::cos(std::f64::consts::TAU * random.random::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_mean_0_and_variance_1() {
        let mut chance = Chance::new(5);
        let numbers: Vec<f64> = (0..40_000).map(|_| chance.normal()).collect();
        let mean = numbers.iter().sum::<f64>() / 4e4;
        let variance = numbers.iter().map(|x| x * x).sum::<f64>() / 4e4 - mean * mean;
        // Four standard errors: 1/√40000 = 0.005 of the mean, √2 times that of the variance.
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.03, "{mean} {variance}");
    }
}
