//! The bottom of the container, felt from above.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = −q ρ g A D e^(−(H−z)/D) v̂   (N)
///
/// in a bed of depth H (m); nothing where that is not known.
///
/// Source: resistance near a wall falls off over a length of the order of the intruder (Stone, Barry,
/// Bernstein, Pelc, Tsui & Schiffer, Phys. Rev. E 70, 041301 (2004)).
struct BottomWall {
    q: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "bottom-wall", kind: ChannelKind::Dissipated },
    flow: Flow::Static,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "bottom-wall",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::BedDepth],
        separable_from: &[Confounder { effect: "depth-exponent", any_of: &[Needs::BedDepths] }],
    }),
    summary: "A resistance that grows as the intruder nears the bottom of the bed.",
    formula: "F = -q rho g A D exp(-(H-z)/D) v/|v|",
    signature: "only deep impacts feel it: less deep, a much shorter stopping time, a large force at the end",
    source: "Stone et al., Phys. Rev. E 70, 041301 (2004): an exponential rise near the floor",
    params: &[amplitude(
        Range::closed(0.0, 1000.0),
        Range::closed(0.0, 50.0),
        "resistance at the bottom in units of rho g A D",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(BottomWall { q: given.get("q") }),
};

impl ResistanceLaw for BottomWall {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        let Some(bottom) = bed.bed_depth else { return };
        let weight = bed.bulk_density * bed.gravity * at.loaded_area * at.diameter;
        let nearness = libm::exp(-(bottom - at.depth) / at.diameter);
        load.friction += Vec3::new(1.0, 0.0, 1.0) * (self.q * weight * nearness);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn at_one_diameter_above_the_bottom_it_is_a_share_of_1_over_e() {
        let bed = Surroundings { bed_depth: Some(0.1), ..surroundings() };
        let mut load = Load::default();
        BottomWall { q: 2.0 }.act(&SPHERE.at(0.1 - 0.0254), &sinking(1.0), &bed, &mut load);
        // 2 × 1520 kg/m³ × 9.8 m/s² × 5.067e-4 m² × 0.0254 m × 0.36788.
        assert!((load.friction.z - 0.141_056).abs() < 1e-5, "{}", load.friction.z);
    }

    #[test]
    fn a_bed_of_unknown_depth_has_no_bottom() {
        let mut load = Load::default();
        BottomWall { q: 2.0 }.act(&SPHERE.at(0.05), &sinking(1.0), &surroundings(), &mut load);
        assert_eq!(load, Load::default());
    }
}
