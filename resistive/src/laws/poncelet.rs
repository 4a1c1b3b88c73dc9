//! Poncelet's law: a drag and a resistance, constant or functions of depth.

use crate::{Account, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::math::Vec3;
use engine::params::ParamSpec;
use engine::units::Dimension;

use super::coefficients::OfDepth;
use super::registry::{ResistanceEntry, Role};
use super::two_term_vector::ACCOUNTS;

/// M a = M g − h(z) v² − β(z), along the motion   (N)
///
/// h (kg/m) and β (N) are numbers or expressions of `depth` (m).
///
/// Source: the three-shape manuscript, eq. 18; its closed forms (eqs 20–22) are checked for constant h, β.
struct Poncelet {
    inertial: OfDepth,
    resistance: OfDepth,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "poncelet",
    role: Role::Baseline,
    summary: "Poncelet's law: a drag with the square of the speed and a resistance, constant or of depth.",
    formula: "M a = M g - h(z) v^2 - beta(z)",
    signature: "depth grows with the logarithm of the impact energy",
    source: "Poncelet, Cours de mecanique industrielle (1829); three-shape manuscript, eqs 18-22",
    params: &[
        ParamSpec::required(
            "inertial",
            Dimension::MASS_PER_LENGTH,
            "h, the factor of the squared speed; a number, or an expression of depth",
        )
        .usual(1e-3, 10.0),
        ParamSpec::required(
            "resistance",
            Dimension::FORCE,
            "beta, the resistance; a number, or an expression of depth",
        )
        .usual(1e-2, 1e3),
    ],
    forms: &[],
    variables: &["density", "angle", "depth"],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(Poncelet {
            inertial: given.of_depth("inertial"),
            resistance: given.of_depth("resistance"),
        })
    },
};

impl ResistanceLaw for Poncelet {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, motion: &Motion, _: &Surroundings, load: &mut Load) {
        let loaded = at.loaded_area / at.frontal_area;
        let drag = self.inertial.at(at.depth) * at.drag_factor * loaded * motion.speed;
        load.dynamic.x -= drag * at.sideways_drag * motion.velocity.x;
        load.dynamic.z -= drag * motion.velocity.z;
        let limit = self.resistance.at(at.effective_depth) * at.friction_factor * loaded;
        load.friction += Vec3::new(limit * at.sideways_friction, 0.0, limit);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::super::{Coefficients, Expression};
    use super::*;
    use engine::params::ParamTable;

    #[test]
    fn a_resistance_that_is_an_expression_follows_the_depth() {
        let numbers = ParamTable::from_iter([("inertial", 0.3)]);
        let beta = Expression::parse("2 + 40 * depth", &["depth"]).unwrap();
        let law = (ENTRY.build)(&Coefficients::new(numbers).with_function("resistance", beta));
        let mut load = Load::default();
        law.act(&SPHERE.at(0.05), &sinking(2.0), &surroundings(), &mut load);
        assert!((load.friction.z - 4.0).abs() < 1e-14);
        assert!((load.dynamic.z - 0.3 * 4.0).abs() < 1e-14);
    }
}
