//! A smooth random force multiplier along depth: what the grains of one bed happen to be.

use std::f64::consts::TAU;

use super::chance::Chance;

/// The correlation falls to 1/e over this depth (m): ten grains of 0.8 mm.
const CORRELATION_DEPTH: f64 = 8e-3;

/// Waves that a field is the sum of.
const WAVES: usize = 24;

/// Spacing of the table (m), a fifteenth of the correlation depth: a cubic between its entries is exact
/// to 1e-4 of the scatter.
const SPACING: f64 = 5e-4;

/// Depth of the table (m); deeper than any sphere here comes.
const DEPTH: f64 = 0.35;

/// A random function of depth with mean 0.
#[derive(Clone, Debug)]
pub(super) struct Field(Vec<f64>);

impl Field {
    /// Nothing anywhere.
    pub(super) fn none() -> Self {
        Self(Vec::new())
    }

    /// A sum of waves of random phase, whose wave numbers are normal: its correlation is a Gaussian.
    pub(super) fn drawn(deviation: f64, chance: &mut Chance) -> Self {
        let scale = std::f64::consts::SQRT_2 / CORRELATION_DEPTH;
        let amplitude = deviation * (2.0 / WAVES as f64).sqrt();
        let n = (DEPTH / SPACING) as usize + 3;
        let mut table = vec![0.0; n];
        for _ in 0..WAVES {
            let (number, phase) = (scale * chance.normal(), chance.between(0.0, TAU));
            // cos(a + b k) for all k by turning through b: one sine and one cosine for each wave.
            let (sin, cos) = libm::sincos(number * SPACING);
            let (mut im, mut re) = libm::sincos(phase);
            for entry in &mut table {
                *entry += amplitude * re;
                (re, im) = (re * cos - im * sin, re * sin + im * cos);
            }
        }
        Self(table)
    }

    /// At `depth` (m) of 0 or more, by the cubic through four entries (Catmull & Rom 1974).
    pub(super) fn at(&self, depth: f64) -> f64 {
        let n = self.0.len();
        if n < 4 {
            return 0.0;
        }
        let place = 1.0 + depth / SPACING;
        let k = (place as usize).clamp(1, n - 3);
        let s = (place - k as f64).min(1.0);
        let [a, b, c, d] = [self.0[k - 1], self.0[k], self.0[k + 1], self.0[k + 2]];
        let (rise, bend) = (c - a, 2.0 * a - 5.0 * b + 4.0 * c - d);
        b + 0.5 * s * (rise + s * (bend + s * (3.0 * (b - c) + d - a)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_have_the_deviation_and_the_correlation_that_they_are_drawn_with() {
        let mut chance = Chance::new(1);
        let (mut variance, mut covariance) = (0.0, 0.0);
        let n = 4000;
        for _ in 0..n {
            let field = Field::drawn(0.12, &mut chance);
            let (here, there) = (field.at(0.021), field.at(0.021 + CORRELATION_DEPTH));
            variance += here * here / f64::from(n);
            covariance += here * there / f64::from(n);
        }
        // Four standard errors of a variance from so many: 4 √(2/4000) = 9 %.
        assert!((variance / 0.0144 - 1.0).abs() < 0.09, "{variance}");
        assert!((covariance / 0.0144 - libm::exp(-1.0)).abs() < 0.09, "{covariance}");
    }

    #[test]
    fn a_field_has_no_corners() {
        let field = Field::drawn(1.0, &mut Chance::new(2));
        let slope = |depth: f64| (field.at(depth + 1e-7) - field.at(depth - 1e-7)) / 2e-7;
        for k in 3..100 {
            let node = f64::from(k) * SPACING;
            // Slopes are of the order of 1/5.7 mm = 180 per m; a corner would show at that size.
            assert!((slope(node + 1e-5) - slope(node - 1e-5)).abs() < 10.0);
        }
    }
}
