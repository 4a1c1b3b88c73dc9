//! Friction that depends on how densely the bed is packed.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F → (1 + q (φ − φ₀)) F, φ₀ = 0.59   (N)
///
/// of the friction that grows with depth, never below zero; nothing where the packing fraction φ is not
/// known. φ₀ is near that of dilation.
///
/// Source: to first order, strength about the critical packing fraction 0.58 to 0.60 of beads (Gravish,
/// Umbanhowar & Goldman, Phys. Rev. Lett. 105, 128301 (2010)).
struct Packing {
    q: f64,
}

/// The packing fraction at which the effect does nothing.
const CRITICAL: f64 = 0.59;

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "packing",
    role: Role::Effect(Facts {
        kind: Kind::Preparation,
        unit: "1",
        visible: &[Needs::Packings],
        separable_from: &[],
    }),
    summary: "Friction that depends on the packing fraction of the bed.",
    formula: "F -> (1 + q (phi - 0.59)) F of the friction",
    signature: "beds of another preparation are harder or softer at every speed",
    source: "Gravish, Umbanhowar & Goldman, Phys. Rev. Lett. 105, 128301 (2010), to first order",
    params: &[amplitude(
        Range::closed(-100.0, 500.0),
        Range::closed(-5.0, 20.0),
        "relative change of the friction per unit of packing fraction",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(Packing { q: given.get("q") }),
};

impl ResistanceLaw for Packing {
    fn expose(&self, at: &mut Immersion, _: &Motion, bed: &Surroundings) {
        let Some(packing) = bed.packing else { return };
        at.friction_factor *= (1.0 + self.q * (packing - CRITICAL)).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    fn factor(q: f64, packing: Option<f64>) -> f64 {
        let mut at = SPHERE.at(0.02);
        let bed = Surroundings { packing, ..surroundings() };
        Packing { q }.expose(&mut at, &sinking(1.0), &bed);
        at.friction_factor
    }

    #[test]
    fn a_denser_bed_has_more_friction_and_a_loose_one_never_pushes() {
        assert!((factor(10.0, Some(0.62)) - 1.3).abs() < 1e-13);
        assert!((factor(10.0, Some(0.57)) - 0.8).abs() < 1e-13);
        assert!(factor(100.0, Some(0.55)).abs() < 1e-15);
        assert!((factor(10.0, None) - 1.0).abs() < 1e-15);
    }
}
