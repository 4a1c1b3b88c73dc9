//! Whether the signature of a candidate is clearer than that of one that does nothing.

use nalgebra::{Cholesky, DMatrix, DVector, Matrix2};
use rand_pcg::Pcg64;

use super::baseline::Baseline;
use super::response::{BetweenDraws, Response};
use crate::projection::Basis;
use crate::random::{Purpose, normal, stream};

/// Candidates that do nothing and are drawn, and the share of them that a signature has to exceed.
const NOTHING: usize = 200;
const RARE: f64 = 0.98;

/// Why the `responses` to the amplitude `q`, found by so many `runs`, cannot be told from those of a candidate that does
/// nothing; `None` where they can. Candidates that do nothing are drawn, as many draws of a bed as were run, and go through
/// the same formula.
pub(super) fn lost(
    (responses, q): (&[Option<Response>], f64),
    baseline: &Baseline,
    runs: usize,
) -> Option<String> {
    let clear = clearness((responses, q), baseline);
    let mut random = stream(runs as u64, Purpose::Signature, 0);
    let mut nothing: Vec<f64> = (0..NOTHING)
        .map(|_| clearness((&of_nothing((responses, q), baseline, &mut random), q), baseline))
        .collect();
    nothing.sort_by(f64::total_cmp);
    let seen = nothing[(RARE * NOTHING as f64) as usize];
    (clear <= seen).then(|| not_seen(clear.max(0.0) / seen.max(f64::MIN_POSITIVE), runs))
}

/// By how much the responses to the amplitude `q` stand out of what is not known of them, along the modes of the scatter,
/// in standard deviations of that.
fn clearness((responses, q): (&[Option<Response>], f64), baseline: &Baseline) -> f64 {
    let (mut signal, mut freedom) = (0.0, 0.0_f64);
    let known = baseline.spread.iter().zip(&baseline.modes.columns);
    for (response, (spread, modes)) in responses.iter().zip(known) {
        let Some(response) = response else { continue };
        if let Some(factor) = Cholesky::new(response.covariance_at(q, spread)) {
            let white = |mut of: DMatrix<f64>| {
                // The diagonal of a Cholesky factor is positive, so there is a solution.
                factor.l_dirty().solve_lower_triangular_mut(&mut of);
                of
            };
            let modes = Basis::of(&white(modes.clone()));
            let change = white(DMatrix::from_columns(&[response.at(q)]));
            let change = change.column(0).into_owned();
            signal += change.norm_squared() - modes.rest(&change).norm_squared();
            freedom += modes.len() as f64;
        }
    }
    (signal - freedom) / (2.0 * freedom).sqrt().max(1.0)
}

/// Responses to the amplitude `q` of a candidate that does nothing, known from as many draws as `responses` are.
fn of_nothing(
    (responses, q): (&[Option<Response>], f64),
    baseline: &Baseline,
    random: &mut Pcg64,
) -> Vec<Option<Response>> {
    let mut between = BetweenDraws::default();
    let drawn = responses.iter().zip(&baseline.spread).map(|(response, spread)| {
        let response = response.as_ref()?;
        let factor = Cholesky::new(spread.clone())?.l();
        let n = response.deviations.len().max(1);
        let size = (response.variance_at(q).max(0.0) * n as f64).sqrt();
        let one = |_| {
            let white = DVector::from_fn(spread.nrows(), |_, _| normal(random));
            size * (&factor * white)
        };
        let each: Vec<DVector<f64>> = (0..n).map(one).collect();
        let mean =
            each.iter().fold(DVector::zeros(spread.nrows()), |sum, one| sum + one) / n as f64;
        let none = mean.map(|_| 0.0);
        let deviations = match response.deviations.len() {
            0 => Vec::new(),
            _ => each.iter().map(|one| [(one - &mean) / q, none.clone()]).collect(),
        };
        between.learn(&deviations, spread);
        let variance = [[response.variance_at(q) / (q * q), 0.0], [0.0, 0.0]];
        Some(Response { slope: mean / q, curvature: none, variance, deviations })
    });
    let mut drawn: Vec<Option<Response>> = drawn.collect();
    for response in drawn.iter_mut().flatten().filter(|one| !one.deviations.is_empty()) {
        let expected = Matrix2::new(response.variance[0][0], 0.0, 0.0, 0.0);
        response.variance = between.of_mean(expected, response.deviations.len());
    }
    drawn
}

/// Why a candidate cannot be tested whose signature is `clear` times as clear as that of one that does nothing may be.
fn not_seen(clear: f64, runs: usize) -> String {
    let factor = 1.0 / clear.max(0.25);
    format!(
        "what it changes is lost in the scatter of beds; about {:.0} impacts of screening would show it \
         (these were {runs})",
        factor * runs as f64
    )
}
