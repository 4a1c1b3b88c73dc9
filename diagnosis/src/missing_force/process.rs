//! A force as a Gaussian process over depth, speed, angle and diameter, seen through the answer of the measurements to it.
//!
//! The force at the nodes of a grid is normal beforehand, with a covariance that falls with the square of their distance
//! (Rasmussen & Williams 2006, Gaussian Processes for Machine Learning, eq. 2.31). Parameters of the model and errors of the
//! apparatus are projected out of the answer and of the residual. Its size and its four lengths are averaged over a
//! grid, weighed by the evidence of each (ibid., eq. 5.8).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use super::response::Response;
use crate::field::Grid;
use crate::noise::log_determinant;

/// Sizes of the force over that of the model, and lengths over the extent of each axis, that are tried.
const SIZES: [f64; 4] = [0.05, 0.15, 0.5, 1.5];
const LENGTHS: [f64; 3] = [0.12, 0.3, 1.0];
const ANGLES: [f64; 2] = [0.5, 2.0];
const DIAMETERS: [f64; 2] = [0.7, 4.0];

/// Lengths of the half of the variance that all nodes share: a force that only resists has a mean.
const LONG: [f64; 4] = [2.0; 4];

/// Share of the variance of each node that no other shares.
const OWN: f64 = 1e-6;

/// Settings less likely by this logarithm than the best do not count.
const NEGLIGIBLE: f64 = 8.0;

/// What measurements say of the force at the nodes, in units of ρ g A D.
#[derive(Clone, Debug)]
pub(super) struct Process {
    /// By node of the grid; nothing where no path comes near.
    pub(super) mean: DVector<f64>,
    /// Of the nodes that some path comes near.
    covariance: DMatrix<f64>,
    /// Logarithm of the odds of such a force against none.
    pub(super) log_odds: f64,
}

/// One size and four lengths.
struct Setting {
    log_odds: f64,
    mean: DVector<f64>,
    size: f64,
    solved: Cholesky<f64, Dyn>,
}

/// What settings say together, each weighed by its evidence.
pub(super) struct Averaged {
    /// Logarithm of the odds of such a force against none.
    pub(super) log_odds: f64,
    /// By node.
    pub(super) mean: DVector<f64>,
    /// Of the nodes.
    pub(super) covariance: DMatrix<f64>,
}

impl Averaged {
    /// Over `sizes` and over lengths, which `factors` are of; `gram` and `pull` are the product of the answers with
    /// themselves and with what they explain. `None` where nothing can be told.
    pub(super) fn over(
        factors: &[DMatrix<f64>],
        sizes: &[f64],
        (gram, pull): (&DMatrix<f64>, &DVector<f64>),
    ) -> Option<Self> {
        let tried = |factor: &'_ DMatrix<f64>| -> Vec<Setting> {
            // A product of matrices is several times as fast as one by a transpose that is not formed.
            let inner = factor.transpose() * (gram * factor);
            let seen = factor.tr_mul(pull);
            sizes.iter().filter_map(|&size| setting(factor, &inner, &seen, size)).collect()
        };
        let of_each: Vec<Vec<Setting>> = factors.par_iter().map(tried).collect();
        let settings: Vec<(&DMatrix<f64>, Setting)> = factors
            .iter()
            .zip(of_each)
            .flat_map(|(factor, all)| all.into_iter().map(move |one| (factor, one)))
            .collect();
        let all = || settings.iter().map(|(_, one)| one);
        let best = all().map(|one| one.log_odds).fold(f64::NEG_INFINITY, f64::max);
        let share = |one: &Setting| libm::exp(one.log_odds - best);
        let total: f64 = all().map(share).sum();
        let log_odds = best + libm::log(total / settings.len() as f64);
        let counts = |one: &&(&DMatrix<f64>, Setting)| one.1.log_odds > best - NEGLIGIBLE;
        let n = pull.len();
        let mut mean = DVector::zeros(n);
        for (_, one) in settings.iter().filter(counts) {
            mean.axpy(share(one) / total, &one.mean, 1.0);
        }
        let mut covariance = DMatrix::zeros(n, n);
        let counted: Vec<&(&DMatrix<f64>, Setting)> = settings.iter().filter(counts).collect();
        let own: Vec<DMatrix<f64>> =
            counted.par_iter().map(|(factor, one)| one.covariance(factor)).collect();
        for ((_, one), own) in counted.into_iter().zip(own) {
            let off = &one.mean - &mean;
            covariance += (own + &off * off.transpose()) * (share(one) / total);
        }
        log_odds.is_finite().then_some(Self { log_odds, mean, covariance })
    }
}

impl Setting {
    /// `factor` is that of its lengths.
    fn covariance(&self, factor: &DMatrix<f64>) -> DMatrix<f64> {
        factor * self.solved.inverse() * factor.transpose() * (self.size * self.size)
    }
}

impl Process {
    /// Of `response` on `grid`; `unit` is the size of the model's force in units of ρ g A D, and `misfit` the variance of
    /// what is left over in units of the noise: what no force that is near enough explains counts as noise.
    pub(super) fn of(response: &Response, grid: &Grid, unit: f64, misfit: f64) -> Option<Self> {
        let gram = response.beside.transpose() * &response.beside / misfit;
        let pull = response.beside.tr_mul(&response.residual) / misfit;
        let places: Vec<[f64; 4]> = response.nodes.iter().map(|&node| grid.scaled(node)).collect();
        let varied = |axis: usize, of: &'static [f64]| match grid.axes[axis].len() {
            1 => &of[..1],
            _ => of,
        };
        let tried = lengths(varied(2, &ANGLES), varied(3, &DIAMETERS)).into_par_iter();
        let factors: Vec<DMatrix<f64>> =
            tried.map(|lengths| factor(&places, lengths)).collect::<Option<_>>()?;
        let Averaged { log_odds, mean, covariance } =
            Averaged::over(&factors, &SIZES.map(|size| size * unit), (&gram, &pull))?;
        let mut whole = DVector::zeros(grid.len());
        response.nodes.iter().zip(mean.iter()).for_each(|(&node, value)| whole[node] = *value);
        Some(Self { mean: whole, covariance, log_odds })
    }

    /// Variance of the sum of the forces at the nodes that some path comes near, times `weights`.
    pub(super) fn variance(&self, weights: &DVector<f64>) -> f64 {
        weights.dot(&(&self.covariance * weights)).max(0.0)
    }
}

/// The lengths over depth, speed, angle and diameter that are tried.
fn lengths(angles: &[f64], diameters: &[f64]) -> Vec<[f64; 4]> {
    let mut all = Vec::new();
    for depth in LENGTHS {
        for speed in LENGTHS {
            for &angle in angles {
                all.extend(diameters.iter().map(|&diameter| [depth, speed, angle, diameter]));
            }
        }
    }
    all
}

/// Cholesky factor of the covariance of a force of size 1.
pub(super) fn factor(places: &[[f64; 4]], lengths: [f64; 4]) -> Option<DMatrix<f64>> {
    let covariance = DMatrix::from_fn(places.len(), places.len(), |a, b| {
        let alike = |lengths: [f64; 4]| {
            let apart = |axis: usize| (places[a][axis] - places[b][axis]) / lengths[axis];
            libm::exp(-0.5 * (0..4).map(|axis| apart(axis).powi(2)).sum::<f64>())
        };
        0.5 * (alike(lengths) + alike(LONG)) + if a == b { OWN } else { 0.0 }
    });
    Cholesky::new(covariance).map(|factor| factor.l())
}

/// What follows from a force of `size` whose covariance has `factor`.
fn setting(
    factor: &DMatrix<f64>,
    inner: &DMatrix<f64>,
    seen: &DVector<f64>,
    size: f64,
) -> Option<Setting> {
    let n = seen.len();
    let solved = Cholesky::new(DMatrix::identity(n, n) + inner * (size * size))?;
    let pulled = solved.solve(seen);
    let log_odds = 0.5 * (size * size * seen.dot(&pulled) - log_determinant(&solved));
    let mean = factor * pulled * (size * size);
    Some(Setting { log_odds, mean, size, solved })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_without_any_answer_is_what_it_was_beforehand() {
        let n = 4;
        let places: Vec<[f64; 4]> = (0..n).map(|k| [k as f64 / 3.0, 0.0, 0.0, 0.0]).collect();
        let factor = factor(&places, [0.25; 4]).expect("positive definite");
        let nothing = DMatrix::zeros(n, n);
        let one = setting(&factor, &nothing, &DVector::zeros(n), 2.0).expect("a setting");
        assert!(one.log_odds.abs() < 1e-12, "nothing is learned");
        assert!(one.mean.norm() < 1e-12);
        let sd = one.covariance(&factor)[(0, 0)].sqrt();
        assert!((sd - 2.0).abs() < 1e-5, "{sd}");
    }

    #[test]
    fn a_node_that_is_measured_exactly_has_the_force_that_was_measured() {
        let places = [[0.0; 4], [1.0, 0.0, 0.0, 0.0]];
        let factor = factor(&places, [0.12; 4]).expect("positive definite");
        // One reading of the first node, 3 with a standard deviation of 1e-3.
        let answer = DMatrix::from_row_slice(1, 2, &[1e3, 0.0]);
        let (gram, pull) = (answer.tr_mul(&answer), answer.tr_mul(&DVector::from_element(1, 3e3)));
        let (inner, seen) = (factor.tr_mul(&(&gram * &factor)), factor.tr_mul(&pull));
        let one = setting(&factor, &inner, &seen, 1.0).expect("a setting");
        assert!((one.mean[0] - 3.0).abs() < 1e-4, "{}", one.mean[0]);
        assert!((one.covariance(&factor)[(0, 0)].sqrt() / 1e-3 - 1.0).abs() < 1e-3);
        // Far away half of the variance is shared still, over a length of 2: exp(−1/8) of it at a distance of 1.
        let shared = 0.5 * libm::exp(-0.125);
        let there = one.covariance(&factor)[(1, 1)];
        assert!((there - (1.0 - shared * shared)).abs() < 1e-4, "{there}");
        assert!((one.mean[1] - 3.0 * shared).abs() < 1e-4, "{}", one.mean[1]);
        // Its odds are those of a normal of variance 1 + 1e-6 against one of 1e-6.
        let expected = 0.5 * (9e6 - 9.0 / (1.0 + 1e-6)) - 0.5 * libm::log(1.0 + 1e6);
        assert!((one.log_odds / expected - 1.0).abs() < 1e-5, "{} {expected}", one.log_odds);
    }
}
