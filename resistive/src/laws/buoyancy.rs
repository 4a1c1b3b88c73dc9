//! The weight of the bed that the intruder displaces.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = q ρ g V(z), upward   (N)
///
/// Its work is held and comes back: a potential energy.
///
/// Source: Archimedes' law; granular beds multiply it by a factor of internal friction of order 10 to
/// 100 (Kang, Feng, Liu & Blumenfeld, Nature Commun. 9, 1101 (2018)).
struct Buoyancy {
    q: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "buoyancy", kind: ChannelKind::Stored },
    flow: Flow::Dynamic,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "buoyancy",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[Confounder {
            effect: "yield-stress",
            any_of: &[Needs::Oblique, Needs::Masses],
        }],
    }),
    summary: "The weight of the displaced bed, upward.",
    formula: "F = q rho g V",
    signature: "like a constant force once immersed; light intruders float",
    source: "Archimedes; Kang, Feng, Liu & Blumenfeld, Nature Commun. 9, 1101 (2018)",
    params: &[amplitude(
        Range::closed(0.0, 200.0),
        Range::closed(0.0, 50.0),
        "force in units of the weight of the displaced bed",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(Buoyancy { q: given.get("q") }),
};

impl ResistanceLaw for Buoyancy {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        load.dynamic.z += self.q * bed.bulk_density * bed.gravity * at.volume;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn a_sphere_under_the_surface_is_lifted_by_the_weight_of_its_volume() {
        let bed = surroundings();
        let mut load = Load::default();
        Buoyancy { q: 1.0 }.act(&SPHERE.at(0.0254), &sinking(1.0), &bed, &mut load);
        let volume = std::f64::consts::PI * 0.0254_f64.powi(3) / 6.0;
        assert!((load.dynamic.z - bed.bulk_density * bed.gravity * volume).abs() < 1e-12);
    }
}
