//! Liquid bridges between wet grains.

use std::f64::consts::{PI, TAU};

use engine::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use engine::lanes::Lanes;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable, Range};
use engine::units::Dimension;

use crate::adhesion::{Bond, Energy, Pull};
use crate::candidate::{Candidacy, Candidate, Need};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// The pull of a pendular bridge of liquid, from the first touch until it ruptures.
///
/// F = 2π R γ cos θ/(1 + 1.05 s + 2.5 s²), s = S √(R/V)   (N), R = 2 R*
///
/// S (m) is the gap, zero while the bodies overlap; R (m) is the radius of equal grains and twice the
/// radius at a wall. Every contact has the same volume V. The bridge ruptures at S = (1 + θ/2) V^{1/3}.
/// It is taken to be slow: its viscosity is left out. Friction is not affected by it.
///
/// Channels: `capillary-bridge`, stored: ∫ F dS from touch on, in closed form; dissipated: what is stored
/// at rupture, and of either sign the share of a step in which the force jumps.
///
/// Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000), eq. 12; rupture: Lian, Thornton &
/// Adams, J. Colloid Interface Sci. 161, 138 (1993).
pub(crate) struct CapillaryBridge {
    surface_tension: f64,
    contact_angle: f64,
    liquid_volume: f64,
}

/// The law, the same for every partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    /// 2π γ cos θ (N/m).
    pull_per_radius: f64,
    /// V (m³).
    volume: f64,
    rupture_gap: f64,
}

/// The coefficients of s and s².
const LINEAR: f64 = 1.05;
const SQUARE: f64 = 2.5;

impl Pair {
    fn pull<R: Lanes>(&self, overlap: R, radius_eff: R) -> Pull<R> {
        let [linear, square] = [LINEAR, SQUARE].map(R::splat);
        let radius = radius_eff + radius_eff;
        let touch = R::splat(self.pull_per_radius) * radius;
        let scale = (radius / R::splat(self.volume)).simd_sqrt();
        let s = (-overlap).simd_max(R::zero()) * scale;
        let force = touch / (R::one() + s * (linear + square * s));
        let done = touch * (s.map_lanes(work) / scale - overlap.simd_max(R::zero()));
        Pull { force: -force, adhesive_force: force, stored: done }
    }
}

/// ∫ ds/(1 + 1.05 s + 2.5 s²) from 0.
fn work(s: f64) -> f64 {
    let root = (4.0 * SQUARE - LINEAR * LINEAR).sqrt();
    // The difference of two arc tangents, as one.
    let slope = 2.0 * SQUARE * s * root / (root * root + LINEAR * (2.0 * SQUARE * s + LINEAR));
    2.0 / root * libm::atan(slope)
}

impl ContactLaw for CapillaryBridge {
    const NAME: &'static str = "capillary-bridge";
    const SLOT: Slot = Slot::Normal;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Bond<R>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, _: Partner) -> Pair {
        Pair {
            pull_per_radius: TAU * self.surface_tension * libm::cos(self.contact_angle),
            volume: self.liquid_volume,
            rupture_gap: (1.0 + 0.5 * self.contact_angle) * libm::cbrt(self.liquid_volume),
        }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut Bond<R>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        let in_reach = contact.overlap.simd_gt(R::splat(-pair.rupture_gap));
        let holds = contact.overlaps() | history.is_bound() & in_reach;
        let pull = pair.pull(contact.overlap, contact.radius_eff());
        history.act((holds, pull), contact, response, energy);
    }

    /// Half a swing in a spring as stiff as the bridge is where it is stiffest, at the touch.
    fn collision_time(pair: &Pair, encounter: &Encounter) -> Option<f64> {
        let radius = 2.0 * encounter.radius_eff;
        let stiffness = LINEAR * pair.pull_per_radius * radius * (radius / pair.volume).sqrt();
        (stiffness > 0.0).then(|| PI * (encounter.mass_eff / stiffness).sqrt())
    }

    fn reach(pair: &Pair, _radius_eff: f64) -> f64 {
        pair.rupture_gap
    }
}

impl FromParams for CapillaryBridge {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            surface_tension: params.get("surface_tension"),
            contact_angle: params.get("contact_angle"),
            liquid_volume: params.get("liquid_volume"),
        }
    }
}

const CHANNELS: &[Channel] = &[
    Channel { name: "capillary-bridge", kind: ChannelKind::Stored },
    Channel { name: "capillary-bridge", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[
    ParamSpec::required(
        "surface_tension",
        Dimension::SURFACE_ENERGY,
        "γ of the liquid; 0.072 N/m is water's",
    )
    .or(0.072)
    .usual(0.01, 0.5),
    ParamSpec::required("contact_angle", Dimension::ANGLE, "θ of the liquid on the grains")
        .or(0.0)
        .allowed(Range::closed(0.0, std::f64::consts::FRAC_PI_2))
        .usual(0.0, 1.2),
    ParamSpec::required(
        "liquid_volume",
        Dimension::VOLUME,
        "V, the liquid of one bridge; valid while it is small against the grains",
    )
    .allowed(Range::POSITIVE)
    .usual(1e-16, 1e-7),
];

/// Volume of a bridge that is looked for, in that of a grain: a bed that is wet by about a per cent.
const WET: f64 = 0.01;

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "Cohesion of wet grains: pendular bridges that form at touch and rupture.",
    formula: "F = 2π R γ cos θ/(1 + 1.05 s + 2.5 s²), s = S √(R/V), R = 2 R*, until \
              S = (1 + θ/2) V^(1/3)",
    signature: "A constant resistance at low water content, with loss at every rupture.",
    source: "Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "pull of a bridge over the weight of a mean grain",
        screen: 5.0,
        range: (0.0, 100.0),
        separable_from: "from cohesion-dmt: grains that are pulled apart; from friction: slow impacts",
        alike_below: &["rail-friction"],
        needs: &[Need::Gravity],
        params: |grain, q| {
            let surface_tension = q * grain.weight / (TAU * grain.radius);
            vec![("surface_tension", surface_tension), ("liquid_volume", WET * grain.volume)]
        },
    }),
    ..LawEntry::of::<CapillaryBridge>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::tests::{OVERLAP, RADIUS_EFF, acted, close, contact};
    use engine::lanes::Record;

    const VOLUME: f64 = 1e-12;

    fn pair() -> Pair {
        let law =
            CapillaryBridge { surface_tension: 0.072, contact_angle: 0.5, liquid_volume: VOLUME };
        law.pair(Partner::Grain)
    }

    #[test]
    fn grains_that_touch_pull_with_two_pi_r_gamma_cos_theta() {
        let mut bond = Record::zero();
        let (response, energy) = acted::<CapillaryBridge>(&pair(), &contact(), &mut bond);
        let touch = 2.0 * PI * (2.0 * RADIUS_EFF) * 0.072 * libm::cos(0.5);
        assert!(close(response.normal_force, -touch) && close(response.adhesive_force, touch));
        assert!(response.holds && close(energy.stored, -touch * OVERLAP));
    }

    #[test]
    fn a_bridge_forms_at_touch_and_ruptures_where_it_should() {
        let (pair, mut bond) = (pair(), Record::zero());
        let rupture = 1.25 * libm::cbrt(VOLUME);
        let at = |share: f64| Contact { overlap: -share * rupture, ..contact() };
        assert!(!acted::<CapillaryBridge>(&pair, &at(0.5), &mut bond).0.holds);
        acted::<CapillaryBridge>(&pair, &contact(), &mut bond);
        let (stretched, held) = acted::<CapillaryBridge>(&pair, &at(1.0 - 1e-12), &mut bond);
        assert!(stretched.holds && stretched.normal_force < 0.0);
        let (broken, lost) = acted::<CapillaryBridge>(&pair, &at(1.0 + 1e-12), &mut bond);
        assert!(!broken.holds && broken.normal_force.abs() < 1e-300);
        assert!(close(lost.dissipated, held.stored) && held.stored > 0.0);
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let pair = pair();
        for gap in [1e-6, 2e-5, 1e-4] {
            let h = 1e-4 * gap;
            let stored = |gap: f64| pair.pull(-gap, RADIUS_EFF).stored;
            let slope = (stored(gap + h) - stored(gap - h)) / (2.0 * h);
            let force = -pair.pull(-gap, RADIUS_EFF).force;
            // A central difference is good to (h/gap)² and round-off over h.
            assert!((slope / force - 1.0).abs() < 1e-7, "{gap:e}: {slope} {force}");
        }
    }
}
