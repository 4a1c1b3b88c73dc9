//! Hertz–Mindlin with a viscoelastic material.

use engine::contact::Partner;
use engine::lanes::Lanes;
use engine::params::{ParamDefault, ParamSpec, ParamTable};
use engine::units::Dimension;

use crate::hertz::{self, Damping, Elastic, params};
use crate::registry::{ActsOn, LawEntry};

/// Hertz's normal force, Mindlin's tangential spring, a Coulomb limit, and the damping of a viscoelastic
/// material, with which faster grains rebound less.
///
/// F_n = max(0, K_n δ^{3/2} + 3/2 A K_n √δ dδ/dt)   (N), K_n = 4/3 E* √R*
///
/// F_t = −(k_t ξ + f A k_t v_t), k_t = 8 G* √(R* δ), |F_t| ≤ μ F_n
///
/// For spring and limit see [`hertz::act`]. f is `tangential_damping`: the source writes a viscous part
/// of F_t in its eq. 2 and gives no formula for it, and says in §3 that friction alone dissipates. So f
/// is zero unless it is given; with f = 1 the material damps shear as it damps the normal motion.
///
/// Channels: as `hertz-mindlin`.
///
/// Source: eqs 1–4 of the three-shape manuscript; Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53,
/// 5382 (1996). Differs from the former in K_n, printed with 3/4, in G* = G/(2(2 − ν)), printed with
/// 1 − ν, and in that nothing attracts.
pub(crate) type HertzMindlinViscous = hertz::Law<Viscous>;

/// Damping as time · stiffness.
#[derive(Clone, Copy)]
pub(crate) struct Viscous {
    /// A 2 E*, f A 8 G*.
    factors: [f64; 2],
}

impl Damping for Viscous {
    const NAME: &'static str = "hertz-mindlin-viscous";

    fn of(elastic: &Elastic, values: &ParamTable, _: Partner) -> Self {
        let viscous_time = values.get("viscous_time");
        let tangential = values.get("tangential_damping");
        let factors = [
            viscous_time * elastic.normal_stiffness(1.0),
            tangential * viscous_time * elastic.tangential_stiffness(1.0),
        ];
        Self { factors }
    }

    #[inline(always)]
    fn coefficients<R: Lanes>(&self, contact_radius: R, _: R) -> [R; 2] {
        self.factors.map(|factor| R::splat(factor) * contact_radius)
    }
}

const PARAMS: &[ParamSpec] = &params::specs(
    ParamSpec::required(
        "viscous_time",
        Dimension::TIME,
        "A, damping force over stiffness and normal velocity",
    )
    .usual(1e-8, 1e-2),
    ParamSpec {
        default: ParamDefault::Value(0.0),
        meaning: "f, damping of shear over A k_t; 0 leaves it to friction, 1 damps it alike",
        ..params::TANGENTIAL_DAMPING
    },
);

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactBase,
    summary: "Hertz and Mindlin springs from elastic constants, with viscoelastic damping.",
    formula: "F_n = max(0, K δ^(3/2) + 3/2 A K √δ dδ/dt), K = 4/3 E* √R*;  F_t = −8 G* a (ξ + f A v_t), \
              |F_t| ≤ μ F_n;  a = √(R* δ)",
    signature: "The base law of a bed; faster contacts lose more, so early peak and rebound change.",
    source: "Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53, 5382 (1996); Mindlin (1949)",
    params: PARAMS,
    ..LawEntry::of::<HertzMindlinViscous>()
};

#[cfg(test)]
mod tests {
    use engine::contact::{Contact, ContactLaw, Partner};
    use engine::lanes::Record;

    use super::*;
    use crate::hertz::tests::{MODULUS, OVERLAP, RADIUS_EFF, acted, beads, close, contact};
    use crate::registry::FromParams;
    use engine::math::Vec3;

    const VISCOUS_TIME: f64 = 1e-6;

    fn pair(tangential_damping: f64) -> hertz::Pair<Viscous> {
        let more = [("viscous_time", VISCOUS_TIME), ("tangential_damping", tangential_damping)];
        HertzMindlinViscous::from_params(&beads(&more)).pair(Partner::Grain)
    }

    #[test]
    fn the_viscous_force_is_that_of_the_source_with_its_slips_put_right() {
        let approaching = Contact { overlap_rate: 1e-3, ..contact() };
        let mut history = Record::zero();
        let (response, _) = acted::<HertzMindlinViscous>(&pair(0.0), &approaching, &mut history);
        let k_n = 4.0 / 3.0 * MODULUS * RADIUS_EFF.sqrt();
        let elastic = k_n * OVERLAP * OVERLAP.sqrt();
        let viscous = 1.5 * VISCOUS_TIME * k_n * OVERLAP.sqrt() * 1e-3;
        assert!(close(response.normal_force, elastic + viscous));
    }

    #[test]
    fn shear_is_damped_only_on_request() {
        let shearing = Contact { slip_velocity: Vec3::x() * 1e-6, ..contact() };
        let force = |tangential_damping: f64| {
            let mut history = Record::zero();
            let pair = pair(tangential_damping);
            let (response, _) = acted::<HertzMindlinViscous>(&pair, &shearing, &mut history);
            response.tangential_force.x
        };
        let a = (RADIUS_EFF * OVERLAP).sqrt();
        let k_t = pair(0.0).elastic.tangential_stiffness(a);
        assert!(force(0.0).abs() < 1e-300);
        assert!(close(force(2.0), -2.0 * VISCOUS_TIME * k_t * 1e-6));
    }
}
