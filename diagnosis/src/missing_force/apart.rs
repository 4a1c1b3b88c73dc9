//! How far the force on each condition lies from the one that all share.
//!
//! A force that depends on more than depth, speed and angle (on time, on the way forward, on the impact speed, on the
//! order of the runs) has no single value there. What the shared process leaves over is seen as a force that each condition
//! has on its own, normal beforehand around zero. Its size and its length are averaged by their evidence; one of the sizes
//! is none.

use nalgebra::{DMatrix, DVector};

use super::process::{Averaged, Process, factor, setting};
use super::response::Response;
use crate::field::Grid;

/// Sizes over that of the model's force, and lengths over the extent of each axis, that are tried.
const SIZES: [f64; 5] = [0.0, 0.01, 0.03, 0.1, 0.3];
const LENGTHS: [f64; 2] = [0.12, 0.5];

/// What measurements say of the forces apart, in units of ρ g A D.
pub(super) struct Apart {
    /// Fitted condition and node.
    places: Vec<(usize, usize)>,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Answers of the measurements to each, parameters as they are.
    pub(super) answers: DMatrix<f64>,
}

impl Apart {
    /// What `process` leaves over of `response` on `grid`; `unit` is the size of the model's force in units of ρ g A D. `None`
    /// where nothing can be told.
    pub(super) fn of(
        (response, process): (&Response, &Process),
        grid: &Grid,
        unit: f64,
    ) -> Option<Self> {
        let places = response.by_condition();
        let answers = response.of_places(&places);
        let beside = response.rest_of(&answers);
        let near = DVector::from_iterator(
            response.nodes.len(),
            response.nodes.iter().map(|&node| process.mean[node]),
        );
        let gram = beside.tr_mul(&beside);
        let pull = beside.tr_mul(&response.left_by(&near));
        let (mut factors, mut settings) = (Vec::new(), Vec::new());
        for length in LENGTHS {
            let factor = factor_of_each(&places, grid, length)?;
            let inner = factor.tr_mul(&(&gram * &factor));
            let seen = factor.tr_mul(&pull);
            let sizes = SIZES.iter().map(|size| size * unit);
            let tried = sizes.filter_map(|size| setting(&factor, &inner, &seen, size));
            settings.extend(tried.map(|one| (factors.len(), one)));
            factors.push(factor);
        }
        let Averaged { mean, covariance, log_odds } = Averaged::over(&factors, &settings);
        log_odds.is_finite().then_some(Self { places, mean, covariance, answers })
    }

    /// Adds `share` of the node to the weight of the force that the fitted condition `at` has on its own there.
    pub(super) fn weigh(&self, weights: &mut DVector<f64>, (at, node): (usize, usize), share: f64) {
        if let Ok(place) = self.places.binary_search(&(at, node)) {
            weights[place] += share;
        }
    }

    /// Mean and variance of the sum of the forces times `weights`.
    pub(super) fn sum(&self, weights: &DVector<f64>) -> (f64, f64) {
        (weights.dot(&self.mean), weights.dot(&(&self.covariance * weights)).max(0.0))
    }
}

/// Factor of the covariance of forces of size 1 that no two conditions share.
fn factor_of_each(places: &[(usize, usize)], grid: &Grid, length: f64) -> Option<DMatrix<f64>> {
    let mut whole = DMatrix::zeros(places.len(), places.len());
    let mut from = 0;
    for own in places.chunk_by(|a, b| a.0 == b.0) {
        let scaled: Vec<[f64; 4]> = own.iter().map(|&(_, node)| grid.scaled(node)).collect();
        let part = factor(&scaled, [length; 4])?;
        whole.view_mut((from, from), part.shape()).copy_from(&part);
        from += own.len();
    }
    Some(whole)
}
