//! How strong a hidden effect is: by how much it shifts the resting points.

use argmin::core::{CostFunction, Executor, State};
use argmin::solver::brent::BrentRoot;

use super::design::Design;
use super::hidden::Hidden;
use super::laboratory::{Nature, coarse_resting_points};
use super::path::WorldError;

/// Strengths are met to this share of themselves.
const TOLERANCE: f64 = 1e-3;

/// A shift that no amplitude is asked for: that of a world which stops no sphere.
const BEYOND: f64 = 10.0;

/// The amplitude with the sign of `sign` at which `hidden` shifts resting points by `strength`, the
/// coefficients of `nature` held fixed: root mean square over the conditions of the length of the shift
/// over that of the resting point without it.
///
/// # Errors
/// If no amplitude in the range of the effect does.
pub fn amplitude(
    design: &Design,
    nature: &Nature,
    (hidden, sign): (Hidden, f64),
    strength: f64,
) -> Result<f64, WorldError> {
    let plain = Nature { hidden: Vec::new(), ..nature.clone() };
    let rest = coarse_resting_points(design, &plain)?;
    let search = Search { design, plain, rest, hidden, sign, strength };
    let form = hidden.form();
    let (mut low, mut high) = (0.0, form.small);
    while search.excess(high) < 0.0 {
        if high >= form.most {
            return Err(WorldError::TooStrong(form.id));
        }
        (low, high) = (high, (2.0 * high).min(form.most));
    }
    let solver = BrentRoot::new(low, high, TOLERANCE * 0.1 * high);
    let found = Executor::new(search, solver)
        .configure(|state| state.param(0.5 * (low + high)).max_iters(50))
        .run()
        .map_err(|_| WorldError::TooStrong(form.id))?;
    let size = found.state().get_best_param().copied().unwrap_or(high);
    Ok(sign * size)
}

struct Search<'a> {
    design: &'a Design,
    plain: Nature,
    rest: Vec<[f64; 2]>,
    hidden: Hidden,
    sign: f64,
    strength: f64,
}

impl Search<'_> {
    /// Shift at amplitude `size` less what is asked for.
    fn excess(&self, size: f64) -> f64 {
        let hidden = vec![(self.hidden, self.sign * size)];
        let nature = Nature { hidden, ..self.plain.clone() };
        let shift = match coarse_resting_points(self.design, &nature) {
            Ok(shifted) => shift(&self.rest, &shifted).min(BEYOND),
            Err(_) => BEYOND,
        };
        shift - self.strength
    }
}

impl CostFunction for Search<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, size: &f64) -> Result<f64, argmin::core::Error> {
        Ok(self.excess(*size))
    }
}

/// Root mean square over conditions of the relative shift.
pub(super) fn shift(from: &[[f64; 2]], to: &[[f64; 2]]) -> f64 {
    let square = |([x, z], [x1, z1]): (&[f64; 2], &[f64; 2])| {
        ((x1 - x).powi(2) + (z1 - z).powi(2)) / (x * x + z * z)
    };
    (from.iter().zip(to).map(square).sum::<f64>() / from.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::laboratory::resting_points;
    use super::*;

    #[test]
    fn every_effect_shifts_the_resting_points_by_the_strength_that_is_asked_for() {
        let design = Design::full();
        let nature = Nature { drag: 1.2, friction: 12.0, hidden: Vec::new() };
        let rest = resting_points(&design, &nature).expect("it stops");
        for hidden in Hidden::listed().chain(Hidden::unlisted()) {
            let sign = hidden.form().signs[0];
            for strength in [0.03, 0.06] {
                let q = amplitude(&design, &nature, (hidden, sign), strength)
                    .unwrap_or_else(|error| panic!("{error}"));
                let hiding = Nature { hidden: vec![(hidden, q)], ..nature.clone() };
                let shifted = resting_points(&design, &hiding).expect("it stops");
                // Coarse paths are off by micrometres, a thousandth of 3 % of a depth of 2 cm.
                let found = shift(&rest, &shifted);
                assert!((found / strength - 1.0).abs() < 0.01, "{}: {found}", hidden.id());
            }
        }
    }

    #[test]
    fn the_scale_of_a_camera_shifts_by_itself() {
        let design = Design::full();
        let nature = Nature { drag: 1.0, friction: 10.0, hidden: Vec::new() };
        let q = amplitude(&design, &nature, (Hidden::CameraScale, -1.0), 0.06).expect("in range");
        // The tolerance of the search.
        assert!((q + 0.06).abs() < 1e-4, "{q}");
    }
}
