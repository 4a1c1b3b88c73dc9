//! Friction that grows with a power of depth.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Facts, Kind};
use super::registry::{ResistanceEntry, Role, amplitude};

/// z → D (z/D)^(1+q)   (m)
///
/// in every friction that grows with depth. q is held above −0.99: friction as a step of depth is
/// yield-stress.
///
/// Source: exponents 1.3–1.4 plunging into glass beads and below 1 in other media (Hill, Yeung &
/// Koehler 2005; de Bruyn & Walsh 2004).
struct DepthExponent {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "depth-exponent",
    role: Role::Effect(Facts { kind: Kind::Physics, unit: "1", visible: &[], separable_from: &[] }),
    summary: "Friction that grows with a power of depth other than one.",
    formula: "z -> D (z/D)^(1+q)",
    signature: "below one like a constant force at low speed, with the sign changed at high speed",
    source: "Hill, Yeung & Koehler, Europhys. Lett. 72, 137 (2005); de Bruyn & Walsh, Can. J. Phys. 82, 439 (2004)",
    params: &[amplitude(
        Range::closed(-0.99, 3.0),
        Range::closed(-0.8, 1.0),
        "exponent of depth less one",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(DepthExponent { q: given.get("q") }),
};

impl ResistanceLaw for DepthExponent {
    fn expose(&self, at: &mut Immersion, _: &Motion, _: &Surroundings) {
        let ratio = at.effective_depth / at.diameter;
        at.effective_depth = at.diameter * libm::pow(ratio, 1.0 + self.q);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn depth_is_kept_at_one_diameter_and_follows_the_power_elsewhere() {
        for (depth, expected) in [(0.0254, 0.0254), (0.0254 / 4.0, 0.0254 / 2.0)] {
            let mut at = SPHERE.at(depth);
            DepthExponent { q: -0.5 }.expose(&mut at, &sinking(1.0), &surroundings());
            assert!((at.effective_depth - expected).abs() < 1e-14);
        }
    }
}
