//! Friction of the spinning front of the intruder.

use crate::{Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = −q ρ g A z (R/V_s) ω × v̂, V_s = √(g D)   (N)
///
/// across the motion: the front of a sinking body that rolls forward slips backward over the bed, which
/// pushes it forward. The spin is taken as kept up, and the force does no work.
///
/// Source: tangential friction of a spinning projectile (Carvalho et al., arXiv:2405.05394 (2024)), to first
/// order in spin over speed.
struct SpinFriction {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "spin-friction",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::Spin],
        separable_from: &[],
    }),
    summary: "Friction of the spinning front, across the motion.",
    formula: "F = -q rho g A z (R/sqrt(g D)) omega x v/|v|",
    signature: "a sideways drift in proportion to the spin and the depth, at any speed",
    source: "Carvalho et al., arXiv:2405.05394 (2024), to first order in the spin",
    params: &[amplitude(
        Range::closed(-200.0, 200.0),
        Range::closed(0.0, 10.0),
        "force in units of rho g A z (R omega/sqrt(g D))",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(SpinFriction { q: given.get("q") }),
};

impl ResistanceLaw for SpinFriction {
    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let pressed = bed.bulk_density * bed.gravity * at.loaded_area * at.effective_depth;
        let slip = 0.5 * at.diameter / (bed.gravity * at.diameter).sqrt();
        let spin = Vec3::new(0.0, motion.spin, 0.0);
        load.dynamic -= spin.cross(&motion.direction) * (self.q * pressed * slip);
    }

    fn deflects(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn a_sinking_sphere_that_rolls_forward_is_pushed_forward_the_more_the_deeper() {
        let (mut shallow, mut deep) = (Load::default(), Load::default());
        let motion = Motion { spin: 10.0, ..sinking(2.0) };
        let law = SpinFriction { q: 2.0 };
        law.act(&SPHERE.at(0.01), &motion, &surroundings(), &mut shallow);
        law.act(&SPHERE.at(0.03), &motion, &surroundings(), &mut deep);
        // 2 × 1520 kg/m³ × 9.8 m/s² × 5.067e-4 m² × 0.01 m × 0.0127 m × 10 rad/s / 0.49892 m/s.
        assert!((shallow.dynamic.x - 0.038_426).abs() < 1e-5, "{}", shallow.dynamic.x);
        assert!((deep.dynamic.x - 3.0 * shallow.dynamic.x).abs() < 1e-14);
        assert!(shallow.dynamic.z.abs() < 1e-15);
    }
}
