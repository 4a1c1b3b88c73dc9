//! Estimates how much conditions differ from each other by more than their repeats show.
//!
//! Beds that are poured anew, and days, differ in their coefficients without any effect. Where a set states no sessions, the
//! scatter of the coefficients between conditions is a variance component. It is estimated from the residuals by restricted
//! likelihood (Patterson & Thompson, Biometrika 58, 545 (1971)), with a prior that favours small values.

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::fit::Fit;
use crate::noise::between::Between;
use crate::noise::log_determinant;
use crate::noise::weights::Weight;

/// Relative and absolute tolerance of the search, the latter in standard deviations of what is known beforehand.
const TOLERANCE: (f64, f64) = (1e-3, 1e-3);

/// Most evaluations of the likelihood.
const EVALUATIONS: u64 = 60;

/// One condition, in units of the standard deviations of its mean under the weights of the fit.
struct Term {
    /// Derivative of the mean by the logarithm of each coefficient.
    slope: DMatrix<f64>,
    residual: DVector<f64>,
    /// Derivative of the prediction by the unknowns of the fit.
    jacobian: DMatrix<f64>,
}

/// The restricted likelihood of the residuals of one fit.
struct Likelihood {
    terms: Vec<Term>,
    /// What priors add to JᵀJ and to Jᵀr.
    known: (DMatrix<f64>, DVector<f64>),
    /// The scatter that the weights hold already.
    held: f64,
    /// Standard deviation of what is known of the scatter beforehand.
    sigma: f64,
}

/// The most likely scatter in the residuals of `fit` under `weights`, which hold a scatter of `held`, where it is
/// `sigma` or so beforehand and `most` at most. `slopes` are derivatives of the means by the logarithm of each coefficient, one for each
/// weight.
pub(crate) fn between(
    fit: &Fit,
    weights: &[Weight],
    slopes: &[DMatrix<f64>],
    (held, sigma, most): (f64, f64, f64),
) -> Between {
    let Some(likelihood) = Likelihood::of(fit, weights, slopes, (held, sigma)) else {
        return Between::default();
    };
    let nothing = Between { sigma, ..Between::default() };
    let Some(none) = likelihood.at(0.0) else { return nothing };
    let (relative, absolute) = TOLERANCE;
    let solver = BrentOpt::new(0.0, most).set_tolerance(relative, absolute * sigma);
    let run = Executor::new(likelihood, solver);
    let found = run.configure(|state| state.max_iters(EVALUATIONS)).run().ok();
    let best = found.and_then(|found| {
        let state = found.state();
        Some((*state.get_best_param()?, state.get_best_cost()))
    });
    match best {
        Some((sd, cost)) if cost < none => Between { sd, gain: none - cost, sigma },
        _ => nothing,
    }
}

impl Likelihood {
    /// `None` where no coefficient scatters.
    fn of(
        fit: &Fit,
        weights: &[Weight],
        slopes: &[DMatrix<f64>],
        (held, sigma): (f64, f64),
    ) -> Option<Self> {
        if slopes.iter().all(|slope| slope.ncols() == 0) {
            return None;
        }
        let mut start = 0;
        let terms = weights.iter().zip(slopes).map(|(weight, slope)| {
            let rows = slope.nrows();
            let term = Term {
                slope: weight.whiten_columns(slope),
                residual: fit.residual.rows(start, rows).into_owned(),
                jacobian: fit.jacobian.rows(start, rows).into_owned(),
            };
            start += rows;
            term
        });
        let terms = terms.collect();
        let rest = fit.residual.len() - start;
        let priors = fit.jacobian.rows(start, rest);
        let known = (priors.tr_mul(&priors), priors.tr_mul(&fit.residual.rows(start, rest)));
        Some(Self { terms, known, held, sigma })
    }

    /// Twice the negative logarithm of the likelihood of the scatter `sd`, up to a constant; `None` where a covariance
    /// has no inverse.
    fn at(&self, sd: f64) -> Option<f64> {
        let more = sd * sd - self.held * self.held;
        let (mut normal, mut pull) = self.known.clone();
        let mut cost = (sd / self.sigma).powi(2);
        for Term { slope, residual, jacobian } in &self.terms {
            let n = residual.len();
            let covariance = DMatrix::identity(n, n) + more * (slope * slope.transpose());
            let factor = Cholesky::new(covariance)?;
            let lower = factor.l_dirty();
            let (mut residual, mut jacobian) = (residual.clone(), jacobian.clone());
            lower.solve_lower_triangular_mut(&mut residual);
            lower.solve_lower_triangular_mut(&mut jacobian);
            cost += residual.norm_squared() + log_determinant(&factor);
            normal += jacobian.tr_mul(&jacobian);
            pull += jacobian.tr_mul(&residual);
        }
        // The parameters follow every scatter.
        let factor = Cholesky::new(normal)?;
        Some(cost + log_determinant(&factor) - pull.dot(&factor.solve(&pull)))
    }
}

impl CostFunction for Likelihood {
    type Param = f64;
    type Output = f64;

    fn cost(&self, sd: &Self::Param) -> Result<Self::Output, argmin::core::Error> {
        Ok(self.at(*sd).unwrap_or(f64::INFINITY))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, normal, stream};

    /// Conditions of one number each, of unit noise, that answer to their coefficient by `slope`; one parameter is their
    /// mean.
    fn likelihood(n: usize, slope: f64, sd: f64, held: f64) -> Likelihood {
        let mut random = stream(3, Purpose::Simulation, 0);
        // In units of a standard deviation that holds the scatter `held` already.
        let unit = (1.0 + (held * slope).powi(2)).sqrt();
        let number = |value: f64| DMatrix::from_element(1, 1, value / unit);
        let terms = (0..n).map(|_| Term {
            slope: number(slope),
            residual: number(normal(&mut random) + slope * sd * normal(&mut random))
                .column(0)
                .into(),
            jacobian: number(1.0),
        });
        let terms = terms.collect();
        let known = (DMatrix::zeros(1, 1), DVector::zeros(1));
        Likelihood { terms, known, held, sigma: 1.0 }
    }

    /// The scatter at which the likelihood is greatest, on a fine grid.
    fn best(likelihood: &Likelihood) -> f64 {
        let at = |k: i32| f64::from(k) * 1e-3;
        let cost = |k: &i32| likelihood.at(at(*k)).expect("every covariance has an inverse");
        at((0..500).min_by(|a, b| cost(a).total_cmp(&cost(b))).expect("a grid"))
    }

    #[test]
    fn the_variance_of_conditions_beyond_their_noise_is_found() {
        let all = likelihood(400, 50.0, 0.08, 0.0);
        // The sample variance of one-number conditions less that of noise is the estimate in closed form; the prior is
        // wide.
        let values: Vec<f64> = all.terms.iter().map(|term| term.residual[0]).collect();
        let mean = values.iter().sum::<f64>() / 400.0;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 399.0;
        let expected = ((variance - 1.0) / 2500.0).sqrt();
        assert!((best(&all) - expected).abs() < 1.1e-3, "{} {expected}", best(&all));
        assert!((expected - 0.08).abs() < 0.01, "{expected}");
    }

    #[test]
    fn weights_that_hold_a_scatter_already_change_nothing() {
        let [without, with] = [0.0, 0.2].map(|held| best(&likelihood(100, 50.0, 0.08, held)));
        assert!((without - with).abs() < 1.1e-3, "{without} {with}");
    }

    #[test]
    fn noise_alone_scatters_nothing_or_little() {
        // A variance from 400 numbers is known to 7 % of that of their noise: 0.0053 for this slope; here two of those.
        assert!(best(&likelihood(400, 50.0, 0.0, 0.0)) < 0.0075);
    }
}
