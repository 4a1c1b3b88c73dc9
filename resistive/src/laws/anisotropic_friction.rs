//! Friction that is another one sideways than downward.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F_x → (1 + q) F_x   (N)
///
/// of the friction; the vertical component is left as it is.
///
/// Source: coefficients of the horizontal and the vertical component differ and depend on the impact angle
/// (Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), Table 3).
struct AnisotropicFriction {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "anisotropic-friction",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::Oblique],
        separable_from: &[Confounder {
            effect: "buoyancy",
            any_of: &[Needs::ObliqueAngles, Needs::Masses],
        }],
    }),
    summary: "A friction that is another one sideways than downward.",
    formula: "F_x -> (1+q) F_x of the friction",
    signature: "oblique impacts stop sooner and less far along, or later and farther; vertical ones are unchanged",
    source: "Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), Table 3",
    params: &[amplitude(
        Range::closed(-0.95, 20.0),
        Range::closed(-0.8, 2.0),
        "relative excess of the horizontal friction",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(AnisotropicFriction { q: given.get("q") }),
};

impl ResistanceLaw for AnisotropicFriction {
    fn expose(&self, at: &mut Immersion, _: &Motion, _: &Surroundings) {
        at.sideways_friction *= 1.0 + self.q;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn only_the_horizontal_friction_is_multiplied() {
        let mut at = SPHERE.at(0.02);
        AnisotropicFriction { q: 0.25 }.expose(&mut at, &sinking(1.0), &surroundings());
        assert_eq!(at, Immersion { sideways_friction: 1.25, ..SPHERE.at(0.02) });
    }
}
