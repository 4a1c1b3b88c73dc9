//! Hertz–Mindlin with damping that sets the restitution.

use engine::contact::Partner;
use engine::lanes::Lanes;
use engine::params::{ParamDefault, ParamSpec, ParamTable, Range};

use crate::hertz::{self, Damping, Elastic, damping_ratio, params};
use crate::registry::{ActsOn, LawEntry};

/// Hertz's normal force, Mindlin's tangential spring, a Coulomb limit, and damping with which grains
/// rebound with the same restitution at every speed.
///
/// F_n = max(0, 4/3 E* a δ + 2 √(5/6) β √(S_n m*) dδ/dt)   (N), a = √(R* δ), S_n = 2 E* a
///
/// F_t = −(k_t ξ + 2 √(5/6) β √(k_t m*) v_t), k_t = 8 G* a, |F_t| ≤ μ F_n
///
/// E*, G*, β and μ belong to the pair: grains, walls and the intruder may be of three materials.
///
/// It never attracts, and β is the one with which the rebound, so cut off, has the restitution asked for.
/// For spring and limit see [`hertz::act`]. `tangential_damping` multiplies the viscous part of F_t.
///
/// Valid for δ ≪ R* and no yield. A softened E is safe while δ/R* stays below about 1 %.
///
/// Channels: `normal`, `tangential` (stored); `normal-damping`, `tangential-damping`, `sliding`,
/// `stiffness-change` (dissipated, the last one of either sign).
///
/// Source: Johnson, Contact Mechanics (1985); Mindlin (1949); Tsuji, Tanaka & Ishida, Powder Technol.
/// 71, 239 (1992). Differs from the last in β, which there lets the end of a rebound attract.
pub(crate) type HertzMindlin = hertz::Law<Restitution>;

/// Damping as √(stiffness · mass).
#[derive(Clone, Copy)]
pub(crate) struct Restitution {
    /// 2 √(5/6) β √(2 E*), 2 √(5/6) β √(8 G*).
    factors: [f64; 2],
}

impl Damping for Restitution {
    const NAME: &'static str = "hertz-mindlin";

    fn of(elastic: &Elastic, values: &ParamTable, partner: Partner) -> Self {
        let restitution = values.get(restitution_key(partner));
        let ratio = 2.0 * (5.0_f64 / 6.0).sqrt() * damping_ratio(restitution);
        let tangential = values.get("tangential_damping");
        let factors = [
            ratio * elastic.normal_stiffness(1.0).sqrt(),
            tangential * ratio * elastic.tangential_stiffness(1.0).sqrt(),
        ];
        Self { factors }
    }

    #[inline(always)]
    fn coefficients<R: Lanes>(&self, contact_radius: R, mass_eff: R) -> [R; 2] {
        let root = (contact_radius * mass_eff).simd_sqrt();
        self.factors.map(|factor| R::splat(factor) * root)
    }
}

/// The parameter that holds the restitution of contacts of grains with `partner`.
pub const fn restitution_key(partner: Partner) -> &'static str {
    match partner {
        Partner::Grain => "restitution",
        Partner::Wall => "wall_restitution",
        Partner::Intruder => "intruder_restitution",
    }
}

const RESTITUTION: ParamSpec =
    ParamSpec::number("restitution", "e, speed of a head-on rebound over that of the impact")
        .allowed(Range { min: 0.0, max: 1.0, includes_min: false })
        .usual(0.1, 1.0);

const PARAMS: &[ParamSpec] = &params::with_two_more(
    params::specs(
        RESTITUTION,
        ParamSpec {
            default: ParamDefault::Value(1.0),
            meaning: "factor on the viscous part of the tangential force; 0 leaves friction alone",
            ..params::TANGENTIAL_DAMPING
        },
    ),
    [
        RESTITUTION
            .named(restitution_key(Partner::Wall), "e between grains and walls")
            .same_as("restitution"),
        RESTITUTION
            .named(restitution_key(Partner::Intruder), "e between grains and the intruder")
            .same_as("restitution"),
    ],
);

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactBase,
    summary: "Hertz and Mindlin springs from elastic constants, damped to a given restitution.",
    formula: "F_n = max(0, 4/3 E* a δ + 2√(5/6) β √(S_n m*) dδ/dt);  F_t = −(8 G* a ξ + c_t v_t), \
              |F_t| ≤ μ F_n;  a = √(R* δ)",
    signature: "The base law of a bed; μ sets the depth-linear friction, e the rebound of the bed.",
    source: "Johnson (1985), eq. 4.23; Mindlin (1949); Tsuji, Tanaka & Ishida, Powder Technol. 71, \
             239 (1992)",
    params: PARAMS,
    ..LawEntry::of::<HertzMindlin>()
};

#[cfg(test)]
mod tests {
    use engine::contact::{Contact, ContactLaw, Partner};
    use engine::lanes::Record;

    use super::*;
    use crate::hertz::tests::{MODULUS, OVERLAP, RADIUS_EFF, acted, beads, close, contact};
    use crate::registry::FromParams;

    fn pair(restitution: f64) -> hertz::Pair<Restitution> {
        let more = [
            ("restitution", restitution),
            ("wall_restitution", restitution),
            ("intruder_restitution", restitution),
            ("tangential_damping", 1.0),
        ];
        HertzMindlin::from_params(&beads(&more)).pair(Partner::Grain)
    }

    #[test]
    fn damping_is_the_ratio_times_the_root_of_stiffness_and_mass() {
        let approaching = Contact { overlap_rate: 1e-3, ..contact() };
        let mut history = Record::zero();
        let (response, _) = acted::<HertzMindlin>(&pair(0.5), &approaching, &mut history);
        let stiffness = 2.0 * MODULUS * (RADIUS_EFF * OVERLAP).sqrt();
        let elastic = 2.0 / 3.0 * stiffness * OVERLAP;
        let damping = 2.0
            * (5.0_f64 / 6.0).sqrt()
            * damping_ratio(0.5)
            * (stiffness * approaching.mass_eff()).sqrt()
            * 1e-3;
        assert!(close(response.normal_force, elastic + damping));
    }

    #[test]
    fn a_contact_that_opens_fast_does_not_attract() {
        let parting = Contact { overlap_rate: -100.0, ..contact() };
        let mut history = Record::zero();
        let (response, _) = acted::<HertzMindlin>(&pair(0.1), &parting, &mut history);
        assert_eq!(response.normal_force.to_bits(), 0.0_f64.to_bits());
    }
}
