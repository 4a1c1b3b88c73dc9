//! The resistive force on a slender round link that enters at an angle.

use crate::{Account, Flow, FrictionLimits, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamDefault, ParamSpec, Range};
use engine::units::Dimension;

use super::registry::{ResistanceEntry, Role};

/// F = −η_d ρ A_r |v| v, and static forces against each component of v:
///
/// horizontal η_h g ρ z² d, vertical η_v (z/l)^λ g ρ V   (N)
///
/// at the centroid of the immersed part, which moves with v. z is the depth of the tip, V the immersed
/// volume, A_r the area that the immersed part turns towards the motion, so that a link moving along
/// its axis has no drag; `end_face` adds that share of the end's area πd²/4. η_v and λ differ between
/// plunging and withdrawing. l is `depth_scale` times the diameter d.
///
/// Source: Marghitu & Lee, Sci. World J. 2013, 808574, eqs 4–8; the two-link article of the same
/// group, eqs 1–16, whose printed formulas are lost; vertical coefficients after Hill, Yeung & Koehler
/// (2005). The length l is printed once as the length and once as the lateral size of the link; with
/// the length the force would be about the buoyancy, so it is the lateral size here.
struct Link {
    drag: f64,
    end_face: f64,
    horizontal: f64,
    plunging: Vertical,
    withdrawing: Vertical,
    depth_scale: f64,
}

/// η_v and λ.
#[derive(Clone, Copy)]
struct Vertical {
    coefficient: f64,
    exponent: f64,
}

const fn number(
    key: &'static str,
    default: ParamDefault,
    range: Range,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec {
        key,
        dimension: Dimension::NONE,
        default,
        allowed: Range::NOT_NEGATIVE,
        plausible: range,
        meaning,
    }
}

const ACCOUNTS: &[Account] = &[
    Account {
        channel: Channel { name: "dynamic-resistance", kind: ChannelKind::Dissipated },
        flow: Flow::Dynamic,
    },
    Account {
        channel: Channel { name: "static-resistance", kind: ChannelKind::Dissipated },
        flow: Flow::Static,
    },
];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "link",
    role: Role::Baseline,
    summary: "Dynamic and static resistance of a slender round link, at the centroid of its immersed part.",
    formula: "F = -eta_d rho A_r |v| v, F_h = eta_h g rho z^2 d, F_v = eta_v (z/l)^lambda g rho V",
    signature: "depth rises and stopping time falls with speed; the static part is all that is left at the stop",
    source: "Marghitu & Lee, Sci. World J. 2013, 808574, eqs 4-8",
    params: &[
        number(
            "drag",
            ParamDefault::Required,
            Range::closed(0.5, 10.0),
            "eta_d, on the area that faces the motion",
        ),
        number("horizontal", ParamDefault::Required, Range::closed(1.0, 20.0), "eta_h, horizontal"),
        number(
            "plunging",
            ParamDefault::Value(10.0),
            Range::closed(2.0, 70.0),
            "eta_v, vertical, while sinking",
        ),
        number(
            "plunging_exponent",
            ParamDefault::Value(1.4),
            Range::closed(0.8, 1.8),
            "lambda, vertical, while sinking",
        ),
        number(
            "withdrawing",
            ParamDefault::Value(0.5),
            Range::closed(0.1, 10.0),
            "eta_v, vertical, while rising",
        ),
        number(
            "withdrawing_exponent",
            ParamDefault::Value(1.7),
            Range::closed(0.8, 2.5),
            "lambda, vertical, while rising",
        ),
        number(
            "depth_scale",
            ParamDefault::Value(1.0),
            Range::closed(0.5, 50.0),
            "the length l of the vertical law, in diameters",
        ),
        number(
            "end_face",
            ParamDefault::Value(0.0),
            Range::closed(0.0, 1.0),
            "share of the end's area that drags",
        ),
    ],
    forms: &[],
    variables: &["density", "angle"],
    accounts: ACCOUNTS,
    build: |given| {
        let vertical = |coefficient, exponent| Vertical {
            coefficient: given.get(coefficient),
            exponent: given.get(exponent),
        };
        Box::new(Link {
            drag: given.get("drag"),
            end_face: given.get("end_face"),
            horizontal: given.get("horizontal"),
            plunging: vertical("plunging", "plunging_exponent"),
            withdrawing: vertical("withdrawing", "withdrawing_exponent"),
            depth_scale: given.get("depth_scale"),
        })
    },
};

impl ResistanceLaw for Link {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn holds_components(&self) -> bool {
        true
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let density = bed.bulk_density;
        let area = at.reference_area + self.end_face * at.end_area;
        let drag = self.drag * at.drag_factor * density * area * motion.speed;
        load.dynamic.x -= drag * at.sideways_drag * motion.velocity.x;
        load.dynamic.z -= drag * motion.velocity.z;

        let weight = density * bed.gravity * at.friction_factor;
        let depth = at.effective_depth;
        let horizontal =
            self.horizontal * weight * depth * depth * at.diameter * at.sideways_friction;
        let ratio = depth / (self.depth_scale * at.diameter);
        let vertical =
            |law: Vertical| law.coefficient * libm::pow(ratio, law.exponent) * weight * at.volume;
        load.gripping = true;
        let [across, along] = &mut load.grip;
        *across = FrictionLimits {
            positive: across.positive + horizontal,
            negative: across.negative + horizontal,
        };
        *along = FrictionLimits {
            positive: along.positive + vertical(self.withdrawing),
            negative: along.negative + vertical(self.plunging),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    fn law() -> Link {
        Link {
            drag: 3.0,
            end_face: 0.0,
            horizontal: 5.0,
            plunging: Vertical { coefficient: 10.0, exponent: 1.4 },
            withdrawing: Vertical { coefficient: 0.5, exponent: 1.7 },
            depth_scale: 1.0,
        }
    }

    #[test]
    fn static_forces_are_those_of_the_article() {
        let bed = surroundings();
        let at = SPHERE.at(0.02);
        let mut load = Load::default();
        law().act(&at, &sinking(1.0), &bed, &mut load);
        let weight = bed.bulk_density * bed.gravity;
        let across = 5.0 * weight * 0.02 * 0.02 * at.diameter;
        assert!((load.grip[0].positive - across).abs() < 1e-12);
        let plunging = 10.0 * libm::pow(0.02 / at.diameter, 1.4) * weight * at.volume;
        assert!((load.grip[1].negative - plunging).abs() < 1e-12);
        assert!(load.grip[1].positive < 0.1 * plunging, "withdrawing is easier");
    }

    #[test]
    fn the_end_face_drags_only_when_it_is_asked_for() {
        let bed = surroundings();
        let at = Immersion { reference_area: 0.0, end_area: 1e-4, ..SPHERE.at(0.02) };
        let (mut without, mut with) = (Load::default(), Load::default());
        law().act(&at, &sinking(2.0), &bed, &mut without);
        Link { end_face: 1.0, ..law() }.act(&at, &sinking(2.0), &bed, &mut with);
        assert!(without.dynamic.norm() < 1e-15);
        assert!((with.dynamic.z - 3.0 * bed.bulk_density * 1e-4 * 4.0).abs() < 1e-12);
    }
}
