//! What an effect explains where a model knows what effects do from a few runs of its own.
//!
//! Such a prediction has a covariance that grows with the amplitude. Under weights without it, differences
//! that hardly scatter would veto a true effect at its amplitude, and under the weights of another effect
//! it would be judged by what is known of that one. So every amplitude is judged under the weights that it
//! has itself, and their determinant is what a wider covariance costs: what an effect does is a normal
//! vector, and this is the likelihood with it integrated out (Rasmussen & Williams 2006, Gaussian Processes
//! for Machine Learning, §2.7).

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentOpt;

use crate::bench::{Bench, BenchError, Fitted};
use crate::forward::{Candidate, PredictError};
use crate::sensitivity::Point;

/// Amplitudes of either sign between which the best is searched.
const GRID: u32 = 12;

/// Where the search for the best amplitude ends: share of it, and of its range.
const TOLERANCE: (f64, f64) = (1e-3, 1e-5);

/// The best of one candidate.
pub(crate) struct Marginal {
    /// Index of the candidate.
    pub(crate) candidate: usize,
    /// Parameters and amplitude.
    pub(crate) point: Point,
    /// Standard error of the amplitude; none at a bound.
    pub(crate) standard_error: Option<f64>,
    /// Fall of twice the negative logarithm of the likelihood.
    pub(crate) fall: f64,
}

/// Those of all candidates.
pub(crate) struct Marginals {
    pub(crate) best: Vec<Marginal>,
    /// Candidates with which the model cannot be integrated, and why.
    pub(crate) failed: Vec<(usize, PredictError)>,
}

/// The best of every one of `candidates` beside `fitted`; `None` for a model that says exactly what effects
/// do.
///
/// # Errors
/// If the model cannot be weighed as it is.
pub(crate) fn marginals(
    bench: &Bench<'_>,
    fitted: &Fitted,
    candidates: &[usize],
) -> Result<Option<Marginals>, BenchError> {
    let Some(&first) = bench.observed.fit.first() else { return Ok(None) };
    if bench.forward.own_covariance(first, &[]).is_none() {
        return Ok(None);
    }
    let bare = cost(bench, fitted, &fitted.fit.point)?;
    let mut all = Marginals { best: Vec::new(), failed: Vec::new() };
    for &candidate in candidates {
        let profile = Profile { bench, fitted, candidate };
        match profile.best(bare) {
            Ok(best) => all.best.push(best),
            Err(BenchError::Predict(why)) => all.failed.push((candidate, why)),
            Err(other) => return Err(other),
        }
    }
    Ok(Some(all))
}

/// Twice the negative logarithm of the likelihood with the effects of `point`, the parameters fitted.
fn cost(bench: &Bench<'_>, fitted: &Fitted, point: &Point) -> Result<f64, BenchError> {
    let weights = bench.weights(point, &fitted.noise, &bench.observed.fit)?;
    let chi2 = bench.data(&weights).fit_parameters(point)?.chi2;
    Ok(chi2 + weights.iter().map(|weight| weight.log_determinant()).sum::<f64>())
}

/// The likelihood along the amplitude of one candidate.
struct Profile<'a> {
    bench: &'a Bench<'a>,
    fitted: &'a Fitted,
    candidate: usize,
}

impl Profile<'_> {
    fn point(&self, q: f64) -> Point {
        let mut point = self.fitted.fit.point.clone();
        point.effects.push((self.candidate, q));
        point
    }

    fn cost_at(&self, q: f64) -> Result<f64, BenchError> {
        cost(self.bench, self.fitted, &self.point(q))
    }

    /// The best amplitude, where `bare` is the cost without.
    fn best(&self, bare: f64) -> Result<Marginal, BenchError> {
        let &Candidate { min, max, .. } = &self.bench.forward.candidates()[self.candidate];
        // Closer to each other where they are small: of a strong effect a tenth more is soon found.
        let share = |k: u32| (f64::from(k) / f64::from(GRID)).powi(2);
        let below = (1..=GRID).rev().map(|k| min * share(k)).filter(|q| *q < 0.0);
        let above = (1..=GRID).map(|k| max * share(k)).filter(|q| *q > 0.0);
        let grid: Vec<f64> = below.chain([0.0]).chain(above).collect();
        let mut costs = Vec::with_capacity(grid.len());
        for &q in &grid {
            // Too much of an effect may be no impact; too little of it always is one.
            costs.push(if q == 0.0 { bare } else { self.cost_at(q).unwrap_or(f64::INFINITY) });
        }
        let least = (0..grid.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
        let (low, high) = (grid[least.saturating_sub(1)], grid[(least + 1).min(grid.len() - 1)]);
        let (eps, share) = TOLERANCE;
        let solver = BrentOpt::new(low, high).set_tolerance(eps, share * (max - min));
        let found = Executor::new(Along(self), solver).configure(|state| state.max_iters(40)).run();
        let polished = found.ok().and_then(|found| {
            let state = found.state();
            Some((*state.get_best_param()?, state.get_best_cost()))
        });
        let (q, least) = polished
            .filter(|(_, cost)| *cost < costs[least])
            .unwrap_or((grid[least], costs[least]));
        let point = self.point(q);
        let weights = self.bench.weights(&point, &self.fitted.noise, &self.bench.observed.fit)?;
        let fit = self.bench.data(&weights).fit(&point)?;
        Ok(Marginal {
            candidate: self.candidate,
            standard_error: fit.standard_error(fit.point.parameters.len()),
            point: fit.point,
            fall: (bare - least).max(0.0),
        })
    }
}

struct Along<'a>(&'a Profile<'a>);

impl CostFunction for Along<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, q: &f64) -> Result<f64, argmin::core::Error> {
        Ok(self.0.cost_at(*q).unwrap_or(f64::INFINITY))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::forward::{Forward, Parameter, Request};
    use crate::observed::Observed;
    use crate::test_sets::{condition, scalar_run, set};
    use measurements::Kind;

    /// Depth and range go up by 10 and 8 mm per amplitude, which is known to `known` (m) of each; runs scatter
    /// in both together, and hardly against each other.
    struct Known {
        known: f64,
        ways: DMatrix<f64>,
        candidates: Vec<Candidate>,
    }

    const SIGNATURE: [f64; 2] = [0.010, 0.008];

    impl Known {
        fn to(known: f64) -> Self {
            let candidate = Candidate {
                id: "uncertain".to_owned(),
                unit: "1".to_owned(),
                min: 0.0,
                max: 4.0,
                usual: None,
                step: 1e-3,
                not_testable: None,
                separable_from: String::new(),
                unresolved: Vec::new(),
            };
            let ways = DMatrix::from_row_slice(2, 2, &[1e-3, 2e-5, 1e-3, -2e-5]);
            Self { known, ways, candidates: vec![candidate] }
        }
    }

    impl Forward for Known {
        fn parameters(&self) -> &[Parameter] {
            &[]
        }

        fn candidates(&self) -> &[Candidate] {
            &self.candidates
        }

        fn n_scattering_coefficients(&self) -> usize {
            0
        }

        fn predict(&self, _: usize, at: &Request<'_>) -> Result<Vec<f64>, PredictError> {
            let q: f64 = at.effects.iter().map(|(_, q)| q).sum();
            Ok(SIGNATURE.map(|slope| 0.03 + slope * q).to_vec())
        }

        fn own_covariance(&self, _: usize, effects: &[(usize, f64)]) -> Option<DMatrix<f64>> {
            let q: f64 = effects.iter().map(|(_, q)| q).sum();
            Some(DMatrix::identity(2, 2) * (q * self.known).powi(2))
        }

        fn ways_of_scatter(&self, _: usize) -> Option<&DMatrix<f64>> {
            Some(&self.ways)
        }
    }

    /// Ten runs of an impact that is 10 mm deeper and 11 mm farther than predicted.
    fn measured(scatter: &DMatrix<f64>) -> Observed {
        let runs = (0..10).map(|run| {
            let signs = [run % 2, (run / 2) % 2].map(|bit| if bit == 0 { 1.0 } else { -1.0 });
            let off = scatter * DVector::from_row_slice(&signs);
            scalar_run(0, [None, Some(0.040 + off[0]), Some(0.041 + off[1])])
        });
        Observed::of(&set(Kind::Scalar, vec![condition(1.0, 45.0)], runs.collect()))
    }

    /// The best by likelihood, and the fall of χ² and the amplitude under the weights of the model as it is.
    fn found(known: f64) -> (Marginal, f64, f64) {
        let forward = Known::to(known);
        let observed = measured(&forward.ways);
        let set = set(Kind::Scalar, vec![condition(1.0, 45.0)], Vec::new());
        let bench = Bench { set: &set, observed: &observed, forward: &forward };
        let start = Point { parameters: Vec::new(), effects: Vec::new() };
        let baseline = bench.fit(&start).unwrap();
        let best = marginals(&bench, &baseline, &[0]).unwrap().unwrap().best.remove(0);
        let with = Point { effects: vec![(0, 0.5)], ..start };
        let fit = bench.data(&baseline.weights).fit(&with).unwrap();
        (best, baseline.fit.chi2 - fit.chi2, fit.point.effects[0].1)
    }

    #[test]
    fn what_hardly_scatters_vetoes_no_effect_that_is_known_less_well() {
        let (Marginal { point, fall, standard_error, .. }, _, vetoed) = found(1.5e-3);
        // To depth and range alike, (10 x 10 + 11 x 8) / (10² + 8²), and known to 1.5 mm in 12.8.
        let q = point.effects[0].1;
        assert!((q - 1.146).abs() < 0.05, "{q}");
        let standard_error = standard_error.expect("no bound is near");
        assert!((0.09..0.16).contains(&standard_error), "{standard_error}");
        assert!(fall > 100.0, "{fall}");
        // Under the weights of the model as it is, the little that range gains on depth is all that counts.
        assert!(vetoed < 0.35, "{vetoed}");
    }

    #[test]
    fn without_uncertainty_the_likelihood_is_that_of_least_squares() {
        let (Marginal { fall, .. }, of_squares, _) = found(0.0);
        assert!((fall - of_squares).abs() < 1e-3 * (1.0 + of_squares), "{fall} {of_squares}");
    }
}
