//! Only what is in the bed is loaded.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::{ParamSpec, Range};

use super::facts::{Facts, Kind};
use super::registry::{OtherForm, ResistanceEntry, Role, amplitude};

/// A → A + q (A_i − A)   (m², planar m)
///
/// in every force that acts on the frontal area A; A_i is that of the immersed part alone. Grains that a body pushes aside
/// load it later than its depth below the undisturbed surface says: with a reach r > 0,
///
/// A_i = A (1 − exp(−z/(r D)))
///
/// The areas of a link are those of its immersed part already, and a reach acts on them too.
///
/// Source: geometry: a cap of depth z of a sphere shows π z (D − z).
struct ImmersedArea {
    q: f64,
    reach: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "immersion",
    role: Role::Effect(Facts { kind: Kind::Physics, unit: "1", visible: &[], separable_from: &[] }),
    summary: "Loads act on the immersed part of the frontal area, not on all of it.",
    formula: "A -> A + q (A_i - A), A_i of the immersed cap, or A (1 - exp(-z/(r D)))",
    signature: "a softer entry: slow impacts go deeper, fast ones hardly",
    source: "area of the immersed cap",
    params: &[
        amplitude(
            Range::closed(0.0, 1.0),
            Range::closed(0.0, 1.0),
            "share of the frontal area that is loaded only when it is immersed",
        ),
        ParamSpec::number(
            "reach",
            "depth over which the load comes, over the diameter: 0 for that of the immersed cap",
        )
        .or(0.0)
        .allowed(Range::closed(0.0, 10.0))
        .plausible(Range::closed(0.0, 2.0)),
    ],
    forms: &[OtherForm { values: &[("reach", 0.5)], needs: &[] }],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(ImmersedArea { q: given.get("q"), reach: given.get("reach") }),
};

impl ResistanceLaw for ImmersedArea {
    fn expose(&self, at: &mut Immersion, _: &Motion, _: &Surroundings) {
        let loaded = match self.reach > 0.0 {
            true => at.frontal_area * -libm::expm1(-at.depth.max(0.0) / (self.reach * at.diameter)),
            false => at.immersed_area,
        };
        at.loaded_area += self.q * (loaded - at.frontal_area);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn a_sphere_at_a_quarter_of_its_diameter_is_loaded_on_three_quarters_of_its_area() {
        let mut at = SPHERE.at(0.0254 / 4.0);
        ImmersedArea { q: 1.0, reach: 0.0 }.expose(&mut at, &sinking(1.0), &surroundings());
        assert!((at.loaded_area / SPHERE.frontal_area() - 0.75).abs() < 1e-14);
        let mut deep = SPHERE.at(0.03);
        ImmersedArea { q: 1.0, reach: 0.0 }.expose(&mut deep, &sinking(1.0), &surroundings());
        assert!((deep.loaded_area / SPHERE.frontal_area() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn over_a_reach_the_load_comes_as_the_exponential_of_depth() {
        // At ln 2 reaches of depth, half of the area is loaded, and of half a share three quarters.
        let mut at = SPHERE.at(0.5 * 0.0254 * std::f64::consts::LN_2);
        ImmersedArea { q: 0.5, reach: 0.5 }.expose(&mut at, &sinking(1.0), &surroundings());
        assert!((at.loaded_area / SPHERE.frontal_area() - 0.75).abs() < 1e-14);
    }
}
