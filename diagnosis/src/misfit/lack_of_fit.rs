//! Whether a fitted model leaves something behind that is not noise.
//!
//! The residual is held against changes of the force over depth, against the motion and normal to it:
//! smooth and sharp ones, coherent over conditions and free in every one (`directions`); craters are held
//! against changes of their size. How
//! large noise alone makes each is learned by resampling the deviations of runs within conditions
//! (`redraw`); a theoretical distribution with one pooled scale rejects too many true models.
//! The smallest of their probabilities is held against the smallest of every resampled residual, so
//! that looking in several ways costs no more than it must (Westfall & Young 1993).

use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::fit::problem::{FitError, FitProblem, Fitted};
use crate::forward::observable::Layout;
use crate::forward::sensitivity::{Direction, force_response};
use crate::misfit::directions::Directions;
use crate::misfit::redraw::Redraw;
use crate::noise::NoiseSource;

/// Resampled sets of means.
const DRAWS: usize = 1999;

/// Bounds of the number of nodes of depth: fewer let a layer slip through, more find nothing new.
const NODES: (usize, usize) = (10, 24);

/// Spacing of the nodes where the path is long enough (m), if the grains are finer.
const SPACING: f64 = 3e-3;

/// A parameter that the measurements know to less than this share of its prior is free.
const OWN_SHARE: f64 = 0.5;

/// Spacing in grains.
const GRAINS: f64 = 4.0;

/// Probability of a lack of fit at least as large, if `fitted` were true; `None` where as much is free
/// as was measured, so that nothing is left to judge by.
pub fn lack_of_fit(
    problem: &FitProblem<'_>,
    fitted: &Fitted,
    seed: u64,
) -> Result<Option<f64>, FitError> {
    let observed = problem.observed;
    let whole = &fitted.fit.residual;
    if whole.len() <= fitted.fit.n_free() {
        return Ok(None);
    }
    if fitted.noise.source != NoiseSource::Repeats {
        let freedom = (whole.len() - fitted.fit.n_free()) as f64;
        return Ok(at_least(fitted.fit.chi2, freedom));
    }
    let reach = observed.fit.iter().fold(0.0_f64, |r, &c| r.max(observed.conditions[c].reach));
    let grain = problem.set.coarsest_grains();
    let (least, most) = NODES;
    let nodes = ((reach / SPACING.max(GRAINS * grain)).ceil() as usize + 1).clamp(least, most);

    let mut looked = Vec::with_capacity(observed.fit.len());
    for (&condition, weight) in observed.fit.iter().zip(&fitted.weights) {
        let response = |direction, nodes| {
            let point = &fitted.fit.point;
            force_response(point, problem.forward, condition, direction, (nodes, reach))
        };
        let along = response(Direction::Along, nodes)?;
        let sideways = response(Direction::Sideways, nodes.div_ceil(2))?;
        let craters = crater_sizes(&observed.conditions[condition].layout);
        looked.push([along, sideways, craters].map(|change| weight.whiten_columns(&change)));
    }
    let measured = problem.data(&fitted.weights).measured();
    let residual = whole.rows(0, measured).into_owned();
    let imitated = imitated(problem, fitted);
    let directions = Directions::new(problem, &imitated, &looked);
    let mut noise = Redraw::new(problem, fitted, &directions, seed);
    let drawn: Vec<Vec<f64>> = (0..DRAWS).map(|_| directions.sizes(&noise.draw())).collect();
    let measured = directions.sizes(&directions.of(&residual));
    Ok(Some(smallest_probability(&measured, &drawn)))
}

/// A column for the size of each crater: craters come last in `layout`.
fn crater_sizes(layout: &Layout) -> DMatrix<f64> {
    let first = layout.len() - layout.craters();
    DMatrix::from_fn(layout.len(), layout.craters(), |row, column| {
        f64::from(u8::from(row == first + column))
    })
}

/// Upper tail of the χ² distribution at `chi2`: only a large misfit is evidence against the model.
pub(crate) fn at_least(chi2: f64, freedom: f64) -> Option<f64> {
    ChiSquared::new(freedom).ok().map(|distribution| distribution.sf(chi2))
}

/// Whitened directions that do not count as lack of fit: those of the free parameters and amplitudes of `fitted`. A
/// parameter that its prior determines is left out, because the fit already uses all the freedom that the prior gives.
fn imitated(problem: &FitProblem<'_>, fitted: &Fitted) -> DMatrix<f64> {
    let measured = problem.data(&fitted.weights).measured();
    let parameters = problem.forward.parameters();
    let is_free = |unknown: usize| {
        let prior = parameters.get(unknown).and_then(|parameter| parameter.prior);
        let known = fitted.fit.standard_error(unknown).unwrap_or(f64::INFINITY);
        prior.is_none_or(|prior| known < OWN_SHARE * prior.sigma)
    };
    let free = fitted.fit.free().iter().enumerate();
    let columns: Vec<usize> =
        free.filter(|(_, unknown)| is_free(**unknown)).map(|(column, _)| column).collect();
    fitted.fit.jacobian.rows(0, measured).select_columns(&columns)
}

/// Probability that the smallest probability of several sizes is as small as that of `measured`,
/// where noise gives `drawn`.
fn smallest_probability(measured: &[f64], drawn: &[Vec<f64>]) -> f64 {
    let mut sorted = vec![Vec::with_capacity(drawn.len()); measured.len()];
    for sizes in drawn {
        for (column, size) in sorted.iter_mut().zip(sizes) {
            column.push(*size);
        }
    }
    for column in &mut sorted {
        column.sort_by(f64::total_cmp);
    }
    let rarest = |sizes: &[f64]| {
        let larger = sizes
            .iter()
            .zip(&sorted)
            .map(|(size, column)| column.len() - column.partition_point(|drawn| drawn < size));
        larger.min().unwrap_or(drawn.len())
    };
    let own = rarest(measured);
    // A drawn size is as large as itself, a measured one only as large as the drawn ones.
    let rarer = drawn.iter().filter(|sizes| rarest(sizes) <= own + 1).count();
    (1 + rarer) as f64 / (1 + drawn.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, normal, stream};

    #[test]
    fn looking_in_several_ways_rejects_no_more_than_looking_in_one() {
        let mut random = stream(1, Purpose::Resampling, 0);
        let mut sizes = || -> Vec<f64> {
            let shared = normal(&mut random);
            (0..4).map(|_| (shared + normal(&mut random)).powi(2)).collect()
        };
        let (sets, level) = (400, 0.05);
        let rejected = (0..sets).filter(|_| {
            let drawn: Vec<Vec<f64>> = (0..199).map(|_| sizes()).collect();
            smallest_probability(&sizes(), &drawn) <= level
        });
        // Twenty are expected; the standard deviation is 4.4, here three of those.
        let rejected = rejected.count();
        assert!((7..=33).contains(&rejected), "{rejected}");
    }

    #[test]
    fn a_misfit_is_as_rare_as_tables_of_chi_squared_say() {
        // Abramowitz & Stegun, table 26.8, to its digits.
        for (chi2, freedom, p) in
            [(3.84146, 1.0, 0.05), (18.3070, 10.0, 0.05), (2.55821, 10.0, 0.99)]
        {
            let found = at_least(chi2, freedom).expect("freedom is positive");
            assert!((found - p).abs() < 1e-5, "{chi2}: {found}");
        }
    }

    #[test]
    fn what_no_draw_reaches_is_as_rare_as_the_draws_can_say() {
        let drawn: Vec<Vec<f64>> = (0..99).map(|k| vec![f64::from(k), 0.5]).collect();
        assert!((smallest_probability(&[1e3, 0.0], &drawn) - 0.02).abs() < 1e-12);
        assert!(smallest_probability(&[-1.0, 0.0], &drawn) > 0.99);
    }
}
