//! Drag and friction of each component by itself, as fitted to impacts of discs.

use crate::{Account, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::params::{ParamSpec, Range};
use engine::units::Dimension;

use super::registry::{ResistanceEntry, Role};
use super::two_term_vector::ACCOUNTS;

/// F_x = −α_x |v_x| v_x − f_x z sign(v_x),  F_z = −m g − α_z |v_z| v_z − f_z z sign(v_z)   (N)
///
/// z here is the depth; α is in kg/m and f in N/m. The article prints no units; with a mass of 32.2 g
/// these give stopping times near its own. Each component comes to rest by itself and is held there.
///
/// Source: Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), eqs 8 and 9, Table 3.
struct TwoTermComponents {
    drag: [f64; 2],
    friction: [f64; 2],
}

const fn coefficient(
    key: &'static str,
    dimension: Dimension,
    plausible: Range,
    meaning: &'static str,
) -> ParamSpec {
    let allowed = Range::NOT_NEGATIVE;
    ParamSpec::required(key, dimension, meaning).allowed(allowed).plausible(plausible)
}

const DRAG: Range = Range::closed(1e-3, 10.0);
const FRICTION: Range = Range::closed(0.1, 1000.0);

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "two-term-components",
    role: Role::Baseline,
    summary: "Inertial drag and depth-proportional friction, of each component of the motion by itself.",
    formula: "F_x = -alpha_x v_x^2 - f_x z, F_z = -m g + alpha_z v_z^2 + f_z z",
    signature: "each component stops by itself; the later one is the stopping time",
    source: "Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), eqs 8-9",
    params: &[
        coefficient("drag_x", Dimension::MASS_PER_LENGTH, DRAG, "horizontal drag alpha_x"),
        coefficient("friction_x", Dimension::STIFFNESS, FRICTION, "horizontal friction f_x"),
        coefficient("drag_z", Dimension::MASS_PER_LENGTH, DRAG, "vertical drag alpha_y"),
        coefficient("friction_z", Dimension::STIFFNESS, FRICTION, "vertical friction f_y"),
    ],
    forms: &[],
    variables: &["density", "angle"],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(TwoTermComponents {
            drag: [given.get("drag_x"), given.get("drag_z")],
            friction: [given.get("friction_x"), given.get("friction_z")],
        })
    },
};

impl ResistanceLaw for TwoTermComponents {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn holds_components(&self) -> bool {
        true
    }

    fn act(&self, at: &Immersion, motion: &Motion, _: &Surroundings, load: &mut Load) {
        // The coefficients contain the frontal area.
        let loaded = at.loaded_area / at.frontal_area;
        let drag = at.drag_factor * loaded;
        let (x, z) = (motion.velocity.x, motion.velocity.z);
        load.dynamic.x -= self.drag[0] * drag * at.sideways_drag * motion.sense[0] * x * x;
        load.dynamic.z -= self.drag[1] * drag * motion.sense[1] * z * z;
        let depth = at.friction_factor * loaded * at.effective_depth;
        load.gripping = true;
        for (grip, friction) in load
            .grip
            .iter_mut()
            .zip([self.friction[0] * at.sideways_friction * depth, self.friction[1] * depth])
        {
            grip.positive += friction;
            grip.negative += friction;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;
    use crate::FrictionLimits;

    #[test]
    fn the_vertical_force_is_that_of_the_article() {
        let law = TwoTermComponents { drag: [0.1, 0.2706], friction: [1.2, 4.506] };
        let mut load = Load::default();
        law.act(&SPHERE.at(0.05), &sinking(2.0), &surroundings(), &mut load);
        assert!((load.dynamic.z - 0.2706 * 4.0).abs() < 1e-14);
        assert!(load.dynamic.x.abs() < 1e-14);
        assert_eq!(load.grip[1], FrictionLimits { positive: 4.506 * 0.05, negative: 4.506 * 0.05 });
    }
}
