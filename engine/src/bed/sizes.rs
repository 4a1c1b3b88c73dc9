//! How the sizes of grains are spread.

use rand::{Rng, RngExt};

/// Halvings that find a diameter from its place in the distribution, to the last digits.
const HALVINGS: usize = 60;

/// A distribution of grain diameters by number.
#[derive(Clone, Debug, PartialEq)]
pub enum SizeDistribution {
    /// All equal (m).
    Equal(f64),
    /// Every diameter between two as likely.
    Uniform {
        /// Smallest (m).
        min: f64,
        /// Largest (m).
        max: f64,
    },
    /// The logarithm of the diameter is normal, between two limits.
    Lognormal {
        /// Median of the distribution without its limits (m).
        median: f64,
        /// Standard deviation of ln d without the limits (–), above zero.
        sigma: f64,
        /// Smallest (m).
        min: f64,
        /// Largest (m).
        max: f64,
    },
    /// Some diameters, each with its share.
    List {
        /// (m).
        diameters: Vec<f64>,
        /// Share by number of each (–), in any unit; not all zero.
        weights: Vec<f64>,
    },
}

impl SizeDistribution {
    /// Standard deviations of ln d to which a lognormal distribution without limits of its own reaches.
    pub const LOGNORMAL_REACH: f64 = 3.0;

    /// The logarithm of the diameter is normal about that of `median` (m), with the standard deviation `sigma`.
    pub fn lognormal(median: f64, sigma: f64) -> Self {
        let limit = |reach: f64| median * libm::exp(reach * sigma);
        let [min, max] = [-Self::LOGNORMAL_REACH, Self::LOGNORMAL_REACH].map(limit);
        Self::Lognormal { median, sigma, min, max }
    }

    /// The smallest diameter that may be drawn (m).
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Uniform { min, .. } | Self::Lognormal { min, .. } => *min,
            Self::List { .. } => self.listed().fold(f64::INFINITY, |least, (d, _)| least.min(d)),
        }
    }

    /// The largest diameter that may be drawn (m).
    pub fn largest(&self) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Uniform { max, .. } | Self::Lognormal { max, .. } => *max,
            Self::List { .. } => self.listed().fold(0.0, |most, (d, _)| most.max(d)),
        }
    }

    /// The mean of dⁿ (mⁿ).
    pub fn moment(&self, n: i32) -> f64 {
        match self {
            Self::Equal(diameter) => diameter.powi(n),
            // (max^(n+1) − min^(n+1)) / ((n+1)(max − min)), without the difference.
            Self::Uniform { min, max } => {
                let terms = (0..=n).map(|k| max.powi(k) * min.powi(n - k));
                terms.sum::<f64>() / f64::from(n + 1)
            }
            Self::Lognormal { median, sigma, min, max } => {
                let shift = f64::from(n) * sigma;
                let [low, high] = [min, max].map(|d| libm::log(d / median) / sigma);
                let share = between(low, high);
                if share > 0.0 {
                    let whole = median.powi(n) * libm::exp(0.5 * shift * shift);
                    whole * between(low - shift, high - shift) / share
                } else {
                    min.powi(n)
                }
            }
            Self::List { .. } => {
                let (sum, weight) = self.listed().fold((0.0, 0.0), |(sum, total), (d, weight)| {
                    (sum + weight * d.powi(n), total + weight)
                });
                sum / weight
            }
        }
    }

    /// Draws one diameter (m). Equal grains take no number from `rng`, others one.
    pub fn draw(&self, rng: &mut impl Rng) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Uniform { min, max } => min + (max - min) * rng.random::<f64>(),
            Self::Lognormal { median, sigma, min, max } => {
                let [mut low, mut high] = [min, max].map(|d| libm::log(d / median) / sigma);
                let (from, place) = (low, rng.random::<f64>() * between(low, high));
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if between(from, middle) < place {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                (median * libm::exp(sigma * 0.5 * (low + high))).clamp(*min, *max)
            }
            Self::List { .. } => {
                let total: f64 = self.listed().map(|(_, weight)| weight).sum();
                let mut left = total * rng.random::<f64>();
                let mut drawn = self.smallest();
                for (diameter, weight) in self.listed() {
                    drawn = diameter;
                    left -= weight;
                    if left < 0.0 {
                        break;
                    }
                }
                drawn
            }
        }
    }

    /// Diameters (m) with a share above zero, and these shares; none but of a list.
    fn listed(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let (diameters, weights): (&[f64], &[f64]) = match self {
            Self::List { diameters, weights } => (diameters, weights),
            _ => (&[], &[]),
        };
        let pairs = diameters.iter().copied().zip(weights.iter().copied());
        pairs.filter(|(_, weight)| *weight > 0.0)
    }
}

/// Share of a standard normal distribution between two values.
fn between(low: f64, high: f64) -> f64 {
    // Where both lie far to one side, the tails have the digits.
    let tail = |x: f64| 0.5 * libm::erfc(x * std::f64::consts::FRAC_1_SQRT_2);
    if low > 0.0 { tail(low) - tail(high) } else { tail(-high) - tail(-low) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bed::random;

    fn distributions() -> [SizeDistribution; 5] {
        [
            SizeDistribution::Uniform { min: 1e-3, max: 3e-3 },
            SizeDistribution::Lognormal { median: 2e-3, sigma: 0.3, min: 0.8e-3, max: 4.9e-3 },
            SizeDistribution::Lognormal { median: 2e-3, sigma: 0.5, min: 1.9e-3, max: 3e-3 },
            SizeDistribution::List {
                diameters: vec![4e-3, 1e-3, 9e-3, 2e-3],
                weights: vec![1.0, 3.0, 0.0, 2.0],
            },
            SizeDistribution::Equal(2e-3),
        ]
    }

    #[test]
    fn drawn_sizes_have_the_moments_of_their_distribution_within_their_standard_errors() {
        const N: usize = 20_000;
        for sizes in distributions() {
            let mut rng = random(5, "sizes");
            let drawn: Vec<f64> = (0..N).map(|_| sizes.draw(&mut rng)).collect();
            assert!(drawn.iter().all(|d| (sizes.smallest()..=sizes.largest()).contains(d)));
            for n in 1..=3 {
                let mean = drawn.iter().map(|d| d.powi(n)).sum::<f64>() / N as f64;
                let expected = sizes.moment(n);
                let variance = sizes.moment(2 * n) - expected * expected;
                let error = (variance.max(0.0) / N as f64).sqrt();
                // Twelve means and their luck: three standard errors, and round-off for equal grains.
                let limit = 3.0 * error + 1e-12 * expected;
                assert!((mean - expected).abs() < limit, "{sizes:?}, {n}: {mean} {expected}");
            }
        }
    }

    #[test]
    fn a_list_gives_each_diameter_its_share_and_none_to_those_without() {
        let sizes = &distributions()[3];
        let limits = [sizes.smallest(), sizes.largest()].map(f64::to_bits);
        assert_eq!(limits, [1e-3, 4e-3].map(f64::to_bits));
        let mut rng = random(1, "sizes");
        let n = 6_000;
        let small = (0..n).filter(|_| sizes.draw(&mut rng) < 1.5e-3).count();
        // Half of them, within three times √(n/4).
        assert!(small.abs_diff(n / 2) < 120, "{small}");
    }

    #[test]
    fn limits_that_leave_one_size_give_that_size() {
        let sizes = SizeDistribution::Lognormal { median: 2e-3, sigma: 0.1, min: 3e-3, max: 3e-3 };
        // The logarithm and back cost a few roundings.
        assert!((sizes.draw(&mut random(1, "sizes")) / 3e-3 - 1.0).abs() < 1e-14);
        assert!((sizes.moment(3) / 27e-9 - 1.0).abs() < 1e-14);
    }
}
