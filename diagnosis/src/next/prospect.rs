//! What several hypotheses expect of conditions, and what measuring them tells.
//!
//! Every hypothesis expects a normal vector: the noise of the mean, and what its fit leaves open. What
//! measurements tell about which hypothesis holds is the mutual information of the two, an expectation over
//! draws of every hypothesis (Lindley 1956, Ann. Math. Stat. 27, 986; of a mixture of normal vectors, Ryan et
//! al. 2016, Int. Stat. Rev. 84, 128).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::hypothesis::{Expectation, Hypothesis};
use crate::forward::Forward;
use crate::forward::sensitivity::Sensitivity;
use crate::noise::weights::{Weight, with_stop_error};
use crate::noise::{Noise, log_determinant};
use crate::observed::ObservedCondition;
use crate::random::{Purpose, normal, stream};

/// Draws of each hypothesis.
const DRAWS: usize = 100;

/// What all hypotheses expect of one condition.
#[derive(Clone, Debug)]
pub(super) struct Prospect {
    pub(super) expectations: Vec<Expectation>,
    pub(super) weight: Weight,
}

impl Prospect {
    /// Of condition `condition` of `forward`, measured like `observed`, under `noise` along the first of
    /// `hypotheses`. `None` if one of them cannot be integrated there.
    pub(super) fn of(
        (forward, condition): (&dyn Forward, usize),
        observed: &ObservedCondition,
        noise: &Noise,
        hypotheses: &[Hypothesis],
    ) -> Option<Self> {
        let point = hypotheses.first()?.before(forward)?.point;
        let sensitivity = Sensitivity::at(&point, forward, condition, observed.reach).ok()?;
        let own = forward.own_covariance(condition, &point.effects);
        let own = with_stop_error(own, observed, forward.stop_error(condition));
        let weight = Weight::new(observed, &sensitivity, noise, own)?;
        let expects = |hypothesis: &Hypothesis| {
            hypothesis.before(forward)?.expects(forward, condition, &weight).ok()
        };
        let expectations = hypotheses.iter().map(expects).collect::<Option<_>>()?;
        Some(Self { expectations, weight })
    }

    /// Expected difference of χ² between hypotheses `k` and `l`.
    pub(super) fn delta(&self, k: usize, l: usize) -> Option<f64> {
        let [one, other] = [k, l].map(|at| &self.expectations[at]);
        let difference = &one.mean - &other.mean;
        let mut covariance = DMatrix::identity(difference.len(), difference.len());
        for open in [&one.shared, &one.own, &other.shared, &other.own] {
            if open.ncols() > 0 {
                covariance += open * open.transpose();
            }
        }
        let delta = difference.dot(&Cholesky::new(covariance)?.solve(&difference));
        delta.is_finite().then_some(delta)
    }
}

/// What one hypothesis expects of several conditions together.
struct Joint {
    mean: DVector<f64>,
    open: DMatrix<f64>,
    /// One and the square of `open`: noise and what is open are independent.
    inner: Cholesky<f64, Dyn>,
    log_determinant: f64,
}

impl Joint {
    /// `None` if numbers are not finite.
    fn of(parts: &[&Expectation]) -> Option<Self> {
        let rows = parts.iter().map(|part| part.mean.len()).sum();
        let shared = parts.first()?.shared.ncols();
        let own: usize = parts.iter().map(|part| part.own.ncols()).sum();
        let (mut mean, mut open) = (DVector::zeros(rows), DMatrix::zeros(rows, shared + own));
        let (mut row, mut column) = (0, shared);
        for part in parts {
            let n = part.mean.len();
            mean.rows_mut(row, n).copy_from(&part.mean);
            open.view_mut((row, 0), (n, shared)).copy_from(&part.shared);
            open.view_mut((row, column), part.own.shape()).copy_from(&part.own);
            row += n;
            column += part.own.ncols();
        }
        let inner = open.tr_mul(&open) + DMatrix::identity(shared + own, shared + own);
        let inner = Cholesky::new(inner)?;
        let log_determinant = log_determinant(&inner);
        log_determinant.is_finite().then_some(Self { mean, open, inner, log_determinant })
    }

    /// Square of the distance of `values` in standard deviations.
    fn chi2(&self, values: &DVector<f64>) -> f64 {
        let off = values - &self.mean;
        let mut onto = self.open.tr_mul(&off);
        // The diagonal of a Cholesky factor is positive, so there is a solution.
        self.inner.l_dirty().solve_lower_triangular_mut(&mut onto);
        off.norm_squared() - onto.norm_squared()
    }

    /// Logarithm of the density of `values`, but for a constant.
    fn log_density(&self, values: &DVector<f64>) -> f64 {
        -0.5 * (self.chi2(values) + self.log_determinant)
    }

    fn draw(&self, seed: u64, draw: usize) -> DVector<f64> {
        let mut random = stream(seed, Purpose::Prospect, draw);
        let mut number = |_, _| normal(&mut random);
        let open = DVector::from_fn(self.open.ncols(), &mut number);
        &self.mean + &self.open * open + DVector::from_fn(self.mean.len(), &mut number)
    }
}

fn joints(prospects: &[&Prospect], hypotheses: usize) -> Option<Vec<Joint>> {
    let of = |at: usize| {
        let parts: Vec<&Expectation> =
            prospects.iter().map(|prospect| &prospect.expectations[at]).collect();
        Joint::of(&parts)
    };
    (0..hypotheses).map(of).collect()
}

/// What remains unknown where hypotheses have these probabilities (bits).
pub(super) fn entropy(probabilities: &[f64]) -> f64 {
    let positive = probabilities.iter().filter(|p| **p > 0.0);
    positive.map(|p| -p * libm::log2(*p)).sum()
}

/// What measuring all of `prospects` is expected to tell about which hypothesis holds (bits); `None` if numbers are
/// not finite.
pub(super) fn information(
    prospects: &[&Prospect],
    probabilities: &[f64],
    seed: u64,
) -> Option<f64> {
    let joints = joints(prospects, probabilities.len())?;
    let mut left = 0.0;
    for (at, &probability) in probabilities.iter().enumerate() {
        for draw in 0..DRAWS {
            let values = joints[at].draw(seed, draw);
            left += probability * entropy(&posterior_of(&joints, &values, probabilities));
        }
    }
    let told = entropy(probabilities) - left / DRAWS as f64;
    told.is_finite().then_some(told.max(0.0))
}

/// Probabilities of the hypotheses after `measured`, one vector for each of `prospects` in the units of what is
/// measured, and χ² of all of it under each; `None` if numbers are not finite.
pub(super) fn posterior(
    prospects: &[&Prospect],
    measured: &[&DVector<f64>],
    probabilities: &[f64],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let joints = joints(prospects, probabilities.len())?;
    let each = prospects.iter().zip(measured);
    let white: Vec<DVector<f64>> = each.map(|(one, mean)| one.weight.whiten(mean)).collect();
    let numbers = white.iter().flat_map(|white| white.iter().copied());
    let white = DVector::from_vec(numbers.collect());
    let after = posterior_of(&joints, &white, probabilities);
    let chi2 = joints.iter().map(|joint| joint.chi2(&white)).collect();
    after.iter().all(|p| p.is_finite()).then_some((after, chi2))
}

fn posterior_of(joints: &[Joint], values: &DVector<f64>, probabilities: &[f64]) -> Vec<f64> {
    let logs: Vec<f64> = joints
        .iter()
        .zip(probabilities)
        .map(|(joint, p)| libm::log(*p) + joint.log_density(values))
        .collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let shares: Vec<f64> = logs.iter().map(|log| libm::exp(log - most)).collect();
    let sum: f64 = shares.iter().sum();
    shares.iter().map(|share| share / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expectation(mean: f64, shared: f64, own: f64) -> Expectation {
        let one = |value| DMatrix::from_element(1, 1, value);
        Expectation { mean: DVector::from_element(1, mean), shared: one(shared), own: one(own) }
    }

    fn joint(mean: f64, shared: f64) -> Joint {
        Joint::of(&[&expectation(mean, shared, 0.0)]).expect("it is finite")
    }

    /// Of two hypotheses `apart` standard deviations from each other.
    fn between(apart: f64, open: f64) -> f64 {
        let joints = [joint(0.0, open), joint(apart, open)];
        let half = [0.5, 0.5];
        let mut left = 0.0;
        for joint in &joints {
            for draw in 0..DRAWS {
                left += entropy(&posterior_of(&joints, &joint.draw(7, draw), &half));
            }
        }
        1.0 - left / (2 * DRAWS) as f64
    }

    #[test]
    fn two_alike_tell_nothing_and_two_far_apart_all() {
        assert!(between(0.0, 0.0).abs() < 1e-12);
        assert!(between(20.0, 0.0) > 0.999);
        // The capacity of a binary channel with normal noise, amplitude 1 over deviation 1: 0.486 bit.
        let told = between(2.0, 0.0);
        assert!((told - 0.486).abs() < 0.06, "{told}");
    }

    #[test]
    fn what_the_fits_leave_open_does_not_tell() {
        // Amplitude 1 over deviation √(1 + 3²).
        let told = between(2.0, 3.0);
        assert!(told > 0.0 && told < 0.12, "{told}");
    }

    #[test]
    fn an_open_unknown_that_conditions_share_cancels_between_them() {
        // Both conditions are off by the same unknown; their difference tells the hypotheses apart.
        let parts =
            |difference: f64| [expectation(0.0, 50.0, 0.0), expectation(difference, 50.0, 0.0)];
        let joint =
            |parts: &[Expectation; 2]| Joint::of(&[&parts[0], &parts[1]]).expect("it is finite");
        let joints = [joint(&parts(0.0)), joint(&parts(20.0))];
        let after = posterior_of(&joints, &DVector::from_vec(vec![5.0, 25.0]), &[0.5, 0.5]);
        assert!(after[1] > 0.999, "{after:?}");
        let one = Joint::of(&[&parts(20.0)[1]]).expect("it is finite");
        let other = Joint::of(&[&parts(0.0)[1]]).expect("it is finite");
        let alone = posterior_of(&[other, one], &DVector::from_vec(vec![25.0]), &[0.5, 0.5]);
        assert!((alone[1] - 0.5).abs() < 0.1, "{alone:?}");
    }
}
