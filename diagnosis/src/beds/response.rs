//! How the observables answer to the amplitude of a candidate, and how well a few draws of a bed tell.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// How the observables of one condition answer to the amplitude q of a candidate: slope q + curvature q².
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Response {
    pub(super) slope: DVector<f64>,
    pub(super) curvature: DVector<f64>,
    /// Covariance of the two, in that of one run.
    pub(super) variance: [[f64; 2]; 2],
    /// Deviations of both, draw by draw, from their mean; none where draws were not looked at one by one.
    pub(super) deviations: Vec<[DVector<f64>; 2]>,
}

impl Response {
    /// At the amplitude `q`.
    pub(super) fn at(&self, q: f64) -> DVector<f64> {
        q * &self.slope + (q * q) * &self.curvature
    }

    /// Variance at the amplitude `q`, in that of one run.
    pub(super) fn variance_at(&self, q: f64) -> f64 {
        let [[a, b], [_, c]] = self.variance;
        q * q * (a + 2.0 * b * q + c * q * q)
    }

    /// Covariance at the amplitude `q`, where runs scatter by `spread`: half as if responses differed in what
    /// runs differ in, half as those few that were seen did, which alone would leave most directions out.
    pub(super) fn covariance_at(&self, q: f64, spread: &DMatrix<f64>) -> DMatrix<f64> {
        let like_runs = self.variance_at(q) * spread;
        let n = self.deviations.len() as f64;
        if n < 2.0 {
            return like_runs;
        }
        let at_q = self.deviations.iter().map(|[slope, curvature]| q * slope + q * q * curvature);
        let seen = DMatrix::from_columns(&at_q.collect::<Vec<_>>());
        0.5 * like_runs + (0.5 / (n * (n - 1.0))) * &seen * seen.transpose()
    }
}

/// slope q + curvature q² through differences.
pub(super) struct Line {
    /// Slope and curvature.
    pub(super) terms: [DVector<f64>; 2],
    /// Of the normal equations: covariance of the two where differences scatter by one.
    pub(super) inverse: Matrix2<f64>,
}

impl Line {
    /// Straight where there is one amplitude, none where there is nothing.
    pub(super) fn through(found: &[(f64, DVector<f64>)]) -> Option<Self> {
        let first = &found.first()?.1;
        let mut gram = Matrix2::zeros();
        let (mut once, mut twice) = (DVector::zeros(first.len()), DVector::zeros(first.len()));
        for (q, difference) in found {
            let powers = Vector2::new(*q, q * q);
            gram += powers * powers.transpose();
            once += *q * difference;
            twice += (q * q) * difference;
        }
        let several = found.iter().any(|(q, _)| q.to_bits() != found[0].0.to_bits());
        let Some(inverse) = gram.try_inverse().filter(|_| several) else {
            let inverse = Matrix2::new(1.0 / gram[(0, 0)], 0.0, 0.0, 0.0);
            return Some(Self { terms: [once * inverse[(0, 0)], first.map(|_| 0.0)], inverse });
        };
        let mix = |row: usize| inverse[(row, 0)] * &once + inverse[(row, 1)] * &twice;
        Some(Self { terms: [mix(0), mix(1)], inverse })
    }
}

/// Slopes and curvatures of `each` draw less their means.
pub(super) fn deviations(each: &[Line]) -> Vec<[DVector<f64>; 2]> {
    let mean = |term: usize| {
        let terms: Vec<&DVector<f64>> = each.iter().map(|line| &line.terms[term]).collect();
        let first = terms.first()?;
        let sum = terms.iter().fold(first.map(|_| 0.0), |sum, one| sum + *one);
        Some(sum / terms.len() as f64)
    };
    let (Some(slope), Some(curvature)) = (mean(0), mean(1)) else { return Vec::new() };
    each.iter().map(|line| [&line.terms[0] - &slope, &line.terms[1] - &curvature]).collect()
}

/// How much slope and curvature differ from draw to draw: a bed that is stiffer by a tenth answers less to
/// everything, however much two runs on it have in common.
#[derive(Default)]
pub(super) struct BetweenDraws {
    /// Sum of squares and products of deviations, in units of the scatter of a run.
    squares: Matrix2<f64>,
    /// Of how many independent deviations, in numbers of a run.
    freedom: f64,
}

impl BetweenDraws {
    /// Takes the deviations of the draws of one condition into account.
    pub(super) fn learn(&mut self, deviations: &[[DVector<f64>; 2]], spread: &DMatrix<f64>) {
        for row in 0..spread.nrows() {
            let terms = deviations.iter().map(|one| Vector2::from_fn(|term, _| one[term][row]));
            let squares: Matrix2<f64> = terms.map(|term| term * term.transpose()).sum();
            // Before contact nothing can differ, and tells nothing.
            if squares.norm() > 0.0 {
                self.squares += squares / spread[(row, row)];
                self.freedom += (deviations.len() - 1) as f64;
            }
        }
    }

    /// Covariance of the mean of so many `draws`, which is taken for `expected` until seen.
    pub(super) fn of_mean(&self, expected: Matrix2<f64>, draws: usize) -> [[f64; 2]; 2] {
        let own = self.squares / (self.freedom * draws.max(1) as f64);
        let covariance = if self.freedom > 0.0 { own } else { expected };
        [0, 1].map(|row| [0, 1].map(|column| covariance[(row, column)]))
    }
}

/// Correlation of two numbers, from the scatter of their differences over `pairs`: it costs one degree of freedom less
/// than a coefficient of Pearson, and is below it where what is changed changes the scatter. None from fewer than three.
pub(super) fn correlation_of_pairs(pairs: &[[f64; 2]]) -> Option<f64> {
    if pairs.len() < 3 {
        return None;
    }
    let variance = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>()
    };
    let of = |at: usize| variance(pairs.iter().map(|pair| pair[at]).collect());
    let difference = variance(pairs.iter().map(|[a, b]| a - b).collect());
    let both = of(0) + of(1);
    (both > 0.0).then(|| 1.0 - difference / both)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_through_nothing_is_found_and_a_single_amplitude_gives_a_line() {
        let value = |q: f64| DVector::from_vec(vec![2.0 * q - q * q, -q]);
        let found: Vec<_> = [0.1, 0.2, 0.3, 0.1].iter().map(|&q| (q, value(q))).collect();
        let line = Line::through(&found).unwrap();
        // The normal equations of three amplitudes of 0.1 lose four digits.
        assert!((&line.terms[0] - DVector::from_vec(vec![2.0, -1.0])).amax() < 1e-11);
        assert!((&line.terms[1] - DVector::from_vec(vec![-1.0, 0.0])).amax() < 1e-10);
        let single = Line::through(&found[..1]).unwrap();
        assert!((single.terms[0][1] + 1.0).abs() < 1e-14 && single.terms[1].amax() < 1e-300);
        assert!((single.inverse[(0, 0)] - 100.0).abs() < 1e-11);
        assert!(Line::through(&[]).is_none());
    }

    /// Three draws that answer by 1, 2 and 3 in one of three numbers and by the same in the second; the third
    /// is before contact.
    fn draws() -> Vec<Line> {
        let line = |slope: f64| {
            Line::through(&[(2.0, DVector::from_vec(vec![2.0 * slope, 2.0, 0.0]))]).unwrap()
        };
        [1.0, 2.0, 3.0].map(line).into()
    }

    #[test]
    fn the_mean_of_draws_is_known_as_well_as_their_answers_agree() {
        let (deviations, spread) = (deviations(&draws()), DMatrix::identity(3, 3));
        let mut between = BetweenDraws::default();
        let expected = Matrix2::new(7.0, 0.0, 0.0, 0.0);
        assert!((between.of_mean(expected, 3)[0][0] - 7.0).abs() < 1e-15, "nothing was seen");
        between.learn(&deviations, &spread);
        // A variance of one among three draws, in the one number that differs.
        assert!((between.of_mean(expected, 3)[0][0] - 1.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn half_of_a_covariance_is_in_the_directions_that_were_seen() {
        let (slope, curvature) = (DVector::zeros(3), DVector::zeros(3));
        let variance = [[1.0 / 3.0, 0.0], [0.0, 0.0]];
        let spread = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 4.0, 9.0]));
        let response = Response { slope, curvature, variance, deviations: deviations(&draws()) };
        let covariance = response.covariance_at(2.0, &spread);
        let expected = [4.0 / 3.0, 0.5 * 16.0 / 3.0, 0.5 * 36.0 / 3.0];
        for (at, expected) in expected.into_iter().enumerate() {
            assert!((covariance[(at, at)] - expected).abs() < 1e-14, "{covariance}");
        }
    }
}
