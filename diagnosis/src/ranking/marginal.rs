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
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rand_pcg::Pcg64;

use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::sensitivity::Point;
use crate::forward::{Candidate, PredictError};
use crate::noise::{Noise, log_determinant};
use crate::random::{Purpose, normal, scale_of_noise, stream};

/// Amplitudes of either sign between which the best is searched.
const GRID: u32 = 12;

/// Amplitudes of either sign, and widths, at which drawn measurements are judged.
const COARSE: u32 = 5;
const COARSE_WIDTHS: [f64; 6] = [0.0, 0.1, 0.4, 1.6, 6.4, 25.6];

/// Variances by which conditions may differ beyond their runs, in that of a run of the model: zero, then powers of two
/// from the smallest.
const LEAST_WIDTH: f64 = 0.03;
const WIDTHS: i32 = 13;

/// Where the search for the best amplitude ends: share of it, and of its range.
const TOLERANCE: (f64, f64) = (1e-3, 1e-5);

/// Drawn measurements at most; once so many of them have reached the fall of the measured ones, more would change
/// nothing (Besag & Clifford 1991, Biometrika 78, 301).
const DRAWS: usize = 499;
const REACHED: usize = 20;

/// Share of the largest diagonal number that keeps a parameter on which nothing depends from having no inverse.
const RIDGE: f64 = 1e-12;

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
    /// What conditions differ by with it, as in [`Noise::between`].
    pub(crate) between: f64,
}

/// Those of all candidates.
pub(crate) struct Marginals {
    pub(crate) best: Vec<Marginal>,
    /// Candidates with which the model cannot be integrated, and why.
    pub(crate) failed: Vec<(usize, PredictError)>,
    /// What conditions differ by without any, as in [`Noise::between`].
    pub(crate) between: f64,
    /// Probability of the largest fall, or a larger one, where nothing is missing.
    pub(crate) p: f64,
}

impl Marginals {
    /// The noise `noise`, with what conditions differ by beside `candidate`.
    pub(crate) fn noise_with(&self, noise: &Noise, candidate: usize) -> Noise {
        let own = self.best.iter().find(|one| one.candidate == candidate);
        Noise { between: own.map_or(self.between, |one| one.between), ..*noise }
    }
}

/// The best of every one of `candidates` beside `fitted`; `None` for a model that says exactly what effects
/// do.
///
/// # Errors
/// If the model cannot be weighed as it is.
pub(crate) fn marginals(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    candidates: &[usize],
    seed: u64,
) -> Result<Option<Marginals>, FitError> {
    let Some(problem) = Problem::of(problem, fitted)? else { return Ok(None) };
    let (bare, between) = problem.profiled(&problem.changed(&[])?, &[])?;
    let mut all = Marginals { best: Vec::new(), failed: Vec::new(), between, p: 1.0 };
    for &candidate in candidates {
        let profile = Profile { problem: &problem, candidate };
        match profile.best(bare) {
            Ok(best) => all.best.push(best),
            Err(FitError::Predict(why)) => all.failed.push((candidate, why)),
            Err(other) => return Err(other),
        }
    }
    let ranked: Vec<usize> = all.best.iter().map(|one| one.candidate).collect();
    all.p = problem.by_chance(&ranked, between, seed)?;
    Ok(Some(all))
}

/// The variance between conditions that explains best what `fitted` leaves over, as in [`Noise::between`]; 0 for a model
/// without runs of its own.
///
/// # Errors
/// If the model cannot be weighed.
pub(crate) fn between(problem: &FitProblem<'_>, fitted: &Fitted) -> Result<f64, FitError> {
    let Some(problem) = Problem::of(problem, fitted)? else { return Ok(0.0) };
    Ok(problem.profiled(&problem.changed(&[])?, &[])?.1)
}

/// Measured means beside a model whose parameters act linearly: an error of the apparatus, a change of the preparation.
struct Problem<'a> {
    problem: &'a FitProblem<'a>,
    fitted: &'a Fitted,
    /// Covariance of the measured mean of each condition.
    measured: Vec<DMatrix<f64>>,
    /// Derivative of each prediction by the parameters.
    columns: Vec<DMatrix<f64>>,
    /// One over the variance of what is known of each parameter beforehand; 0 for nothing.
    precision: DVector<f64>,
    /// What is known of it beforehand, less where it is.
    pull: DVector<f64>,
}

/// Residuals under one covariance, ready to be weighed.
struct Cell {
    factors: Vec<Cholesky<f64, Dyn>>,
    /// Whitened derivatives by the parameters.
    columns: Vec<DMatrix<f64>>,
    inner: Cholesky<f64, Dyn>,
    log_determinant: f64,
}

impl<'a> Problem<'a> {
    /// `None` for a model without a covariance of its own.
    fn of(problem: &'a FitProblem<'a>, fitted: &'a Fitted) -> Result<Option<Self>, FitError> {
        let fit = &problem.observed.fit;
        let has_own =
            fit.first().is_some_and(|&c| problem.forward.own_covariance(c, &[]).is_some());
        if !has_own {
            return Ok(None);
        }
        let point = &fitted.fit.point;
        let parameters = problem.forward.parameters();
        let (mut measured, mut columns) = (Vec::new(), Vec::new());
        for &condition in fit {
            let observed = &problem.observed.conditions[condition];
            let sensitivity = problem.sensitivity(point, condition)?;
            let runs = observed.runs.len().max(1) as f64;
            measured.push(fitted.noise.covariance(observed, &sensitivity) / runs);
            let base = point.predict(problem.forward, condition)?;
            let mut slopes = DMatrix::zeros(base.len(), parameters.len());
            for (at, parameter) in parameters.iter().enumerate() {
                let range = (parameter.max - parameter.min).min(1.0);
                let step = parameter.prior.map_or(1e-2 * range, |prior| prior.sigma);
                let mut moved = point.clone();
                moved.parameters[at] += step;
                let slope = (moved.predict(problem.forward, condition)? - &base) / step;
                slopes.set_column(at, &slope);
            }
            columns.push(slopes);
        }
        let priors = || parameters.iter().zip(&point.parameters);
        let precision = priors().map(|(one, _)| one.prior.map_or(0.0, |p| p.sigma.powi(-2)));
        let pull = priors().map(|(one, value)| one.prior.map_or(0.0, |prior| prior.mean - value));
        let (precision, pull) = (precision.collect::<Vec<_>>(), pull.collect::<Vec<_>>());
        Ok(Some(Self {
            problem,
            fitted,
            measured,
            columns,
            precision: precision.into(),
            pull: pull.into(),
        }))
    }

    /// Measured less predicted with `effects`, the parameters as they are.
    fn changed(&self, effects: &[(usize, f64)]) -> Result<Vec<DVector<f64>>, PredictError> {
        let point = Point {
            effects: effects.to_vec(),
            parameters: self.fitted.fit.point.parameters.clone(),
        };
        let one = |&condition: &usize| {
            let mean = &self.problem.observed.conditions[condition].mean;
            Ok(mean - point.predict(self.problem.forward, condition)?)
        };
        self.problem.observed.fit.iter().map(one).collect()
    }

    /// Weights with `effects`, where conditions differ by `between`.
    fn cell(&self, effects: &[(usize, f64)], between: f64) -> Result<Cell, FitError> {
        let noise = Noise { between, ..self.fitted.noise };
        let (mut factors, mut columns) = (Vec::new(), Vec::new());
        let n = self.precision.len();
        let (mut inner, mut log) = (DMatrix::from_diagonal(&self.precision), 0.0);
        let each = self.problem.observed.fit.iter().zip(&self.measured).zip(&self.columns);
        for ((&condition, measured), slopes) in each {
            let own = self.problem.own_covariance(condition, effects, &noise);
            let whole = own.map_or_else(|| measured.clone(), |own| own + measured);
            let factor = Cholesky::new(whole).ok_or_else(|| FitError::Singular {
                id: self.problem.observed.conditions[condition].id.clone(),
            })?;
            let mut white = slopes.clone();
            // The diagonal of a Cholesky factor is positive, so there is a solution.
            factor.l_dirty().solve_lower_triangular_mut(&mut white);
            inner += white.tr_mul(&white);
            log += log_determinant(&factor);
            factors.push(factor);
            columns.push(white);
        }
        let ridge = RIDGE * inner.diagonal().amax().max(1.0);
        inner += DMatrix::identity(n, n) * ridge;
        let inner = Cholesky::new(inner)
            .ok_or_else(|| FitError::Singular { id: "of the parameters".to_owned() })?;
        log += if n > 0 { log_determinant(&inner) } else { 0.0 };
        Ok(Cell { factors, columns, inner, log_determinant: log })
    }

    /// The least cost of `residuals` over the variance between conditions, and that variance.
    fn profiled(
        &self,
        residuals: &[DVector<f64>],
        effects: &[(usize, f64)],
    ) -> Result<(f64, f64), FitError> {
        let has_width = self
            .problem
            .observed
            .fit
            .iter()
            .any(|&condition| self.problem.forward.spread_of_runs(condition).is_some());
        let widths = if has_width { WIDTHS } else { 1 };
        let mut best = (f64::INFINITY, 0.0);
        for at in 0..widths {
            let between = if at == 0 { 0.0 } else { LEAST_WIDTH * f64::from(1 << (at - 1)) };
            let cost = self.cell(effects, between)?.cost(residuals, &self.precision, &self.pull);
            if cost < best.0 {
                best = (cost, between);
            }
        }
        Ok(best)
    }

    /// Probability that the largest fall of `candidates` is reached by measurements of the model as it is, whose
    /// conditions differ by `between`: the same falls of drawn measurements.
    fn by_chance(&self, candidates: &[usize], between: f64, seed: u64) -> Result<f64, FitError> {
        let mut bare = Vec::new();
        for width in COARSE_WIDTHS {
            bare.push((self.changed(&[])?, self.cell(&[], width)?));
        }
        let mut with = Vec::new();
        for &candidate in candidates {
            for q in amplitudes(&self.problem.forward.candidates()[candidate], COARSE) {
                let effects = [(candidate, q)];
                // Too much of an effect may be no impact.
                let Ok(residuals) = self.changed(&effects) else { continue };
                for width in COARSE_WIDTHS {
                    with.push((residuals.clone(), self.cell(&effects, width)?));
                }
            }
        }
        let here = self.changed(&[])?;
        let fall = |drawn: &[DVector<f64>]| {
            let least = |cells: &[(Vec<DVector<f64>>, Cell)]| {
                let cost = |(residuals, cell): &(Vec<DVector<f64>>, Cell)| {
                    let moved = residuals.iter().zip(&here).zip(drawn);
                    let moved: Vec<_> = moved.map(|((own, bare), new)| own - bare + new).collect();
                    cell.cost(&moved, &self.precision, &self.pull)
                };
                cells.iter().map(cost).fold(f64::INFINITY, f64::min)
            };
            least(&bare) - least(&with)
        };
        let measured = fall(&here);
        if measured <= 0.0 {
            return Ok(1.0);
        }
        let null = self.cell(&[], between)?;
        let freedom = self.problem.observed.freedom();
        let mut random = stream(seed, Purpose::Family, 1);
        let (mut reached, mut drawn) = (0, 0);
        while drawn < DRAWS && reached < REACHED {
            drawn += 1;
            let scale = scale_of_noise(freedom.min(1e6), &mut random);
            let errors = self.errors(&null, scale, &mut random);
            reached += usize::from(fall(&errors) >= measured);
        }
        Ok((1 + reached) as f64 / (1 + drawn) as f64)
    }

    /// Residuals of measurements of the model as it is.
    fn errors(&self, null: &Cell, scale: f64, random: &mut Pcg64) -> Vec<DVector<f64>> {
        let parameters = self.precision.iter().zip(&self.pull).map(|(precision, pull)| {
            let by = if *precision > 0.0 { normal(random) / precision.sqrt() } else { 0.0 };
            by + pull
        });
        let parameters = DVector::from_vec(parameters.collect::<Vec<_>>());
        let each = null.factors.iter().zip(&self.columns);
        each.map(|(factor, columns)| {
            let white = DVector::from_fn(columns.nrows(), |_, _| normal(random));
            scale * (factor.l() * white) + columns * &parameters
        })
        .collect()
    }
}

impl Cell {
    /// Twice the negative logarithm of the likelihood of `residuals`, the parameters integrated out.
    fn cost(
        &self,
        residuals: &[DVector<f64>],
        precision: &DVector<f64>,
        pull: &DVector<f64>,
    ) -> f64 {
        let mut onto = precision.component_mul(pull);
        let mut chi2 = onto.dot(pull);
        for ((factor, columns), residual) in self.factors.iter().zip(&self.columns).zip(residuals) {
            let mut white = residual.clone();
            factor.l_dirty().solve_lower_triangular_mut(&mut white);
            chi2 += white.norm_squared();
            onto += columns.tr_mul(&white);
        }
        chi2 - onto.dot(&self.inner.solve(&onto)) + self.log_determinant
    }
}

/// So many amplitudes of either sign of `candidate`, without zero, closer to each other where they are small: of a strong
/// effect a tenth more is soon found.
fn amplitudes(&Candidate { min, max, .. }: &Candidate, count: u32) -> Vec<f64> {
    let share = |k: u32| (f64::from(k) / f64::from(count)).powi(2);
    let below = (1..=count).rev().map(|k| min * share(k)).filter(|q| *q < 0.0);
    let above = (1..=count).map(|k| max * share(k)).filter(|q| *q > 0.0);
    below.chain(above).collect()
}

/// The likelihood along the amplitude of one candidate.
struct Profile<'a> {
    problem: &'a Problem<'a>,
    candidate: usize,
}

impl Profile<'_> {
    /// The least cost with the amplitude `q`, and the variance between conditions that goes with it.
    fn cost_at(&self, q: f64) -> Result<(f64, f64), FitError> {
        let effects = [(self.candidate, q)];
        self.problem.profiled(&self.problem.changed(&effects)?, &effects)
    }

    /// The best amplitude, where `bare` is the cost without.
    fn best(&self, bare: f64) -> Result<Marginal, FitError> {
        let Problem { problem, fitted, .. } = self.problem;
        let candidate = &problem.forward.candidates()[self.candidate];
        let mut grid = amplitudes(candidate, GRID);
        let zero = grid.partition_point(|q| *q < 0.0);
        grid.insert(zero, 0.0);
        let mut costs = Vec::with_capacity(grid.len());
        for &q in &grid {
            // Too much of an effect may be no impact; too little of it always is one.
            let cost = || self.cost_at(q).map_or(f64::INFINITY, |(cost, _)| cost);
            costs.push(if q == 0.0 { bare } else { cost() });
        }
        let least = (0..grid.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
        let (low, high) = (grid[least.saturating_sub(1)], grid[(least + 1).min(grid.len() - 1)]);
        let (eps, share) = TOLERANCE;
        let solver =
            BrentOpt::new(low, high).set_tolerance(eps, share * (candidate.max - candidate.min));
        let found = Executor::new(Along(self), solver).configure(|state| state.max_iters(40)).run();
        let polished = found.ok().and_then(|found| {
            let state = found.state();
            Some((*state.get_best_param()?, state.get_best_cost()))
        });
        let (q, least) = polished
            .filter(|(_, cost)| *cost < costs[least])
            .unwrap_or((grid[least], costs[least]));
        let (_, between) = self.cost_at(q)?;
        let mut point = fitted.fit.point.clone();
        point.effects.push((self.candidate, q));
        let noise = Noise { between, ..fitted.noise };
        let weights = problem.weights(&point, &noise, &problem.observed.fit)?;
        let fit = problem.data(&weights).fit(&point)?;
        Ok(Marginal {
            candidate: self.candidate,
            standard_error: fit.standard_error(fit.point.parameters.len()),
            point: fit.point,
            fall: (bare - least).max(0.0),
            between,
        })
    }
}

struct Along<'a>(&'a Profile<'a>);

impl CostFunction for Along<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, q: &f64) -> Result<f64, argmin::core::Error> {
        Ok(self.0.cost_at(*q).map_or(f64::INFINITY, |(cost, _)| cost))
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
        /// Covariance of that, in its square.
        shape: DMatrix<f64>,
        ways: DMatrix<f64>,
        candidates: Vec<Candidate>,
        /// What the candidate does per amplitude (m), and whether conditions may differ beyond their runs.
        signature: [f64; 2],
        spread: Option<DMatrix<f64>>,
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
                form: Vec::new(),
                unresolved: Vec::new(),
            };
            let ways = DMatrix::from_row_slice(2, 2, &[1e-3, 2e-5, 1e-3, -2e-5]);
            let candidates = vec![candidate];
            let shape = DMatrix::identity(2, 2);
            Self { known, shape, ways, candidates, signature: SIGNATURE, spread: None }
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
            Ok(self.signature.map(|slope| 0.03 + slope * q).to_vec())
        }

        fn own_covariance(&self, _: usize, effects: &[(usize, f64)]) -> Option<DMatrix<f64>> {
            let q: f64 = effects.iter().map(|(_, q)| q).sum();
            Some(&self.shape * (q * self.known).powi(2))
        }

        fn spread_of_runs(&self, _: usize) -> Option<&DMatrix<f64>> {
            self.spread.as_ref()
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
        let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
        let start = Point { parameters: Vec::new(), effects: Vec::new() };
        let baseline = problem.fit(&start).unwrap();
        let best = marginals(&problem, &baseline, &[0], 1).unwrap().unwrap().best.remove(0);
        let with = Point { effects: vec![(0, 0.5)], ..start };
        let fit = problem.data(&baseline.weights).fit(&with).unwrap();
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

    /// The fall by a candidate that does nothing, where the means of six conditions are off by three standard errors.
    fn fall_by_nothing(spread: Option<DMatrix<f64>>) -> (f64, f64) {
        let known = Known::to(1.5);
        // It is known as runs scatter, to one and a half of them.
        let shape = &known.ways * known.ways.transpose();
        let forward = Known { signature: [0.0; 2], spread, shape, ..known };
        let conditions: Vec<_> = (0..6).map(|_| condition(1.0, 45.0)).collect();
        let runs = (0..60).map(|run| {
            let (at, sign) = (run / 10, if run % 2 == 0 { 1e-3 } else { -1e-3 });
            let off = if at % 2 == 0 { 1e-3 } else { -1e-3 };
            let depth = 0.03 + off + sign;
            // Numbers across the common scatter are off as little as they scatter.
            scalar_run(at, [None, Some(depth), Some(depth + 0.01 * sign)])
        });
        let set = set(Kind::Scalar, conditions, runs.collect());
        let observed = Observed::of(&set);
        let problem = FitProblem { set: &set, observed: &observed, forward: &forward };
        let start = Point { parameters: Vec::new(), effects: Vec::new() };
        let baseline = problem.fit(&start).unwrap();
        let all = marginals(&problem, &baseline, &[0], 1).unwrap().unwrap();
        (all.best[0].fall, all.p)
    }

    #[test]
    fn no_candidate_is_credited_for_being_badly_known() {
        let (fall, p) = fall_by_nothing(None);
        assert!(fall > 10.0 && p < 0.01, "{fall} {p}");
        let ways = Known::to(0.0).ways;
        let (fall, p) = fall_by_nothing(Some(&ways * ways.transpose()));
        assert!(fall < 2.0 && p > 0.05, "{fall} {p}");
    }
}
