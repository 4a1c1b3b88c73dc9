//! How far the force on each condition lies from the one that all share.
//!
//! A force that depends on more than depth, speed, angle and diameter (on time, on the impact speed, on the order of the
//! runs) has no single value there. Each condition also has a force of its own, which explains what the shared one leaves
//! over. It is normal beforehand around zero. Its size and its length are averaged by their evidence, size zero included.

use nalgebra::{DMatrix, DVector};

use super::process::{Averaged, Process, alike};
use super::response::Response;
use crate::fit::Fit;
use crate::forward::field::{Grid, Scaled};

/// Sizes over that of the model's force, and lengths over the extent of each axis, that are tried.
const SIZES: [f64; 5] = [0.0, 0.01, 0.03, 0.1, 0.3];
const LENGTHS: [f64; 2] = [0.12, 0.5];

/// What measurements say of the forces apart, in units of ρ g A D.
pub(super) struct Apart {
    /// Fitted condition and node.
    places: Vec<(usize, usize)>,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// By how much the parameters follow each.
    follow: DMatrix<f64>,
}

impl Apart {
    /// What `process` leaves over of `response`, which is around `fit`, on `grid`; `unit` is the size of the model's force
    /// in units of ρ g A D. `None` where nothing can be told.
    pub(super) fn of(
        (response, fit, process): (&Response, &Fit, &Process),
        grid: &Grid,
        unit: f64,
    ) -> Option<Self> {
        let places = response.by_condition();
        if places.is_empty() {
            return None;
        }
        let answers = response.of_places(&places);
        let beside = response.rest_of(&answers);
        let gram = beside.transpose() * &beside;
        let pull = beside.tr_mul(&response.left_by(&process.mean));
        let covariances = LENGTHS.map(|length| of_each(&places, grid, length));
        let sizes = SIZES.map(|size| size * unit);
        let averaged = Averaged::over(&covariances, &sizes, (&gram, &pull))?;
        let covariance = averaged.covariance();
        let mean = averaged.mean;
        let follow = fit.free_covariance() * fit.jacobian.tr_mul(&answers);
        Some(Self { places, mean, covariance, follow })
    }

    /// Mean (N) and variance (N²) of what the force that the fitted condition `condition` has on its own adds to the
    /// missing one: at nodes with `shares`, in `unit` (N), and by the parameters that follow, `slope` being the derivative
    /// of the model's force by them.
    pub(super) fn force(
        &self,
        condition: usize,
        (shares, unit): (&[(usize, f64)], f64),
        slope: &DVector<f64>,
    ) -> (f64, f64) {
        let mut weights = -self.follow.tr_mul(slope);
        for &(node, share) in shares {
            if let Ok(place) = self.places.binary_search(&(condition, node)) {
                weights[place] += unit * share;
            }
        }
        (weights.dot(&self.mean), weights.dot(&(&self.covariance * &weights)).max(0.0))
    }
}

/// The covariance of forces of size 1 that no two conditions share.
fn of_each(places: &[(usize, usize)], grid: &Grid, length: f64) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(places.len(), places.len());
    let mut from = 0;
    for own in places.chunk_by(|a, b| a.0 == b.0) {
        let scaled: Vec<Scaled> = own.iter().map(|&(_, node)| grid.scaled(node)).collect();
        let part = alike(&scaled, [length; 4]);
        whole.view_mut((from, from), part.shape()).copy_from(&part);
        from += own.len();
    }
    whole
}
