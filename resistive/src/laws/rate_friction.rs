//! Friction that depends on the speed.

use crate::{Immersion, Motion, ResistanceLaw, Surroundings};
use engine::params::Range;

use super::facts::{Facts, Kind};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F → (1 + q v/V_s) F, V_s = √(g D)   (N)
///
/// of the friction that grows with depth, never below zero.
///
/// Source: to first order in the speed, the rise of μ(I) (Jop, Forterre & Pouliquen, Nature 441, 727
/// (2006)): 0.38 to 0.64 for beads.
struct RateFriction {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "rate-friction",
    role: Role::Effect(Facts { kind: Kind::Physics, unit: "1", visible: &[], separable_from: &[] }),
    summary: "Friction that grows, or falls, with the speed.",
    formula: "F -> (1 + q v/sqrt(g D)) F of the friction",
    signature: "the depth changes by nearly the same fraction at all speeds, the stopping time the more the faster",
    source: "Jop, Forterre & Pouliquen, Nature 441, 727 (2006), to first order in the speed",
    params: &[amplitude(
        Range::closed(-5.0, 20.0),
        Range::closed(-0.2, 2.0),
        "relative change of the friction at the speed sqrt(g D)",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(RateFriction { q: given.get("q") }),
};

impl ResistanceLaw for RateFriction {
    fn expose(&self, at: &mut Immersion, motion: &Motion, bed: &Surroundings) {
        let scale = (bed.gravity * at.diameter).sqrt();
        at.friction_factor *= (1.0 + self.q * motion.speed / scale).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn friction_rises_by_q_at_the_speed_of_a_fall_over_half_a_diameter_and_never_pushes() {
        let speed = (9.8_f64 * 0.0254).sqrt();
        for (q, expected) in [(0.3, 1.3), (-0.3, 0.7), (-1.5, 0.0)] {
            let mut at = SPHERE.at(0.02);
            RateFriction { q }.expose(&mut at, &sinking(speed), &surroundings());
            assert!((at.friction_factor - expected).abs() < 1e-14, "{q}: {}", at.friction_factor);
        }
    }
}
