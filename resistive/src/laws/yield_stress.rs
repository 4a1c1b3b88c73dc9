//! A resistance that is there at any depth and speed: cohesion.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::{ParamSpec, Range};

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{OtherForm, ResistanceEntry, Role, amplitude};

/// F = −q ρ g A D (D/D₀)^(n − 1) v̂ in the bed, D₀ = 25 mm   (N)
///
/// With n = 0 it is a stress that is the same for every body: a bearing factor N_c of 5 to 9 times a cohesion c (Pa) gives
/// q = N_c c/(ρ g D₀).
///
/// Source: constant term of the resistance law, with n = 1; Terzaghi, Theoretical Soil Mechanics (1943), §46, for N_c c.
struct YieldStress {
    q: f64,
    size_exponent: f64,
}

/// D₀ (m).
const REFERENCE: f64 = 0.025;

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "yield-stress", kind: ChannelKind::Dissipated },
    flow: Flow::Static,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "yield-stress",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[Confounder {
            effect: "rail-friction",
            any_of: &[Needs::FramesBeforeImpact, Needs::Diameters],
        }],
    }),
    summary: "A constant resistance in the bed, against the motion: cohesion.",
    formula: "F = -q rho g A D (D/25 mm)^(n - 1) v/|v|",
    signature: "largest at low speed: the intruder stops sooner and less deep, hardly at high speed",
    source: "constant term of the resistance law; bearing factor times cohesion",
    params: &[
        amplitude(
            Range::closed(0.0, 200.0),
            Range::closed(0.0, 50.0),
            "resistance in units of rho g A D",
        ),
        ParamSpec::number(
            "size_exponent",
            "power n of the diameter in the stress: 0 for a cohesion, 1 for a weight of grains",
        )
        .or(1.0)
        .allowed(Range::closed(0.0, 2.0))
        .plausible(Range::closed(0.0, 1.0)),
    ],
    forms: &[OtherForm { values: &[("size_exponent", 0.0)], needs: &[Needs::Diameters] }],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(YieldStress { q: given.get("q"), size_exponent: given.get("size_exponent") })
    },
};

impl ResistanceLaw for YieldStress {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        let weight = bed.bulk_density * bed.gravity * at.loaded_area * at.diameter;
        let size = libm::pow(at.diameter / REFERENCE, self.size_exponent - 1.0);
        load.friction += Vec3::new(1.0, 0.0, 1.0) * (self.q * weight * size);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn the_limit_does_not_depend_on_depth_or_speed() {
        let bed = surroundings();
        let (mut here, mut there) = (Load::default(), Load::default());
        YieldStress { q: 2.0, size_exponent: 1.0 }.act(
            &SPHERE.at(0.01),
            &sinking(1.0),
            &bed,
            &mut here,
        );
        YieldStress { q: 2.0, size_exponent: 1.0 }.act(
            &SPHERE.at(0.02),
            &sinking(3.0),
            &bed,
            &mut there,
        );
        let limit = 2.0 * bed.bulk_density * bed.gravity * SPHERE.frontal_area() * 0.0254;
        assert!((here.friction.z - limit).abs() < 1e-12);
        assert_eq!(here, there);
    }

    #[test]
    fn a_cohesion_is_the_same_stress_for_every_body() {
        let bed = surroundings();
        let small = SPHERE.at(0.01);
        let large = Immersion { diameter: 3.0 * small.diameter, ..small };
        let stress = |at: &Immersion, size_exponent| {
            let mut load = Load::default();
            YieldStress { q: 2.0, size_exponent }.act(at, &sinking(1.0), &bed, &mut load);
            load.friction.z / at.loaded_area
        };
        assert!((stress(&large, 0.0) / stress(&small, 0.0) - 1.0).abs() < 1e-12);
        assert!((stress(&large, 1.0) / stress(&small, 1.0) - 3.0).abs() < 1e-12);
        let cohesion = 2.0 * bed.bulk_density * bed.gravity * REFERENCE;
        assert!((stress(&small, 0.0) / cohesion - 1.0).abs() < 1e-12);
    }
}
