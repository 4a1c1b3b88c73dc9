//! Drag that depends on depth.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F → (1 + q z/D) F   (N)
///
/// of the drag with the square of the speed, never below zero.
///
/// Source: Poncelet's law with h(z) = h₀ (1 + q z/D); resistance s z v² of published impacts.
struct DepthDrag {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "depth-drag",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[
            Confounder { effect: "rate-friction", any_of: &[Needs::Speeds] },
            Confounder { effect: "immersion", any_of: &[Needs::Shallow] },
        ],
    }),
    summary: "Drag that grows, or falls, with depth.",
    formula: "F -> (1 + q z/D) F of the drag",
    signature: "like more drag, the more so the faster; the stopping time falls at high speed",
    source: "law of Poncelet with an inertial term of depth, h(z)",
    params: &[amplitude(
        Range::closed(-5.0, 50.0),
        Range::closed(-0.3, 3.0),
        "relative change of the drag per diameter of depth",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(DepthDrag { q: given.get("q") }),
};

impl ResistanceLaw for DepthDrag {
    fn expose(&self, at: &mut Immersion, _: &Motion, _: &Surroundings) {
        at.drag_factor *= (1.0 + self.q * at.depth / at.diameter).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn drag_grows_by_q_per_diameter_and_never_pushes() {
        for (q, expected) in [(0.4, 1.8), (-0.2, 0.6), (-0.7, 0.0)] {
            let mut at = SPHERE.at(2.0 * 0.0254);
            DepthDrag { q }.expose(&mut at, &sinking(1.0), &surroundings());
            assert!((at.drag_factor - expected).abs() < 1e-14, "{q}: {}", at.drag_factor);
        }
    }
}
