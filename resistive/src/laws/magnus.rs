//! A spinning intruder is pushed across its path.

use crate::{Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = q ρ A R ω × v   (N)
///
/// in the plane of motion; it does no work.
///
/// Source: the force of Magnus; in a fluid at low speed q = 1 (Rubinow & Keller, J. Fluid Mech. 11, 447
/// (1961)), in grains of either sign (Kumar, Dhiman & Reddy, Phys. Rev. E 99, 012902 (2019)).
struct Magnus {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "magnus",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::Spin],
        separable_from: &[Confounder { effect: "lift", any_of: &[Needs::SpinBothWays] }],
    }),
    summary: "A force across the motion of a spinning intruder.",
    formula: "F = q rho A R omega x v",
    signature: "a sideways drift in proportion to the spin, with its sign",
    source: "Rubinow & Keller, J. Fluid Mech. 11, 447 (1961); Kumar, Dhiman & Reddy, Phys. Rev. E 99, 012902 (2019)",
    params: &[amplitude(
        Range::closed(-50.0, 50.0),
        Range::closed(-2.0, 2.0),
        "force in units of rho A R omega v",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(Magnus { q: given.get("q") }),
};

impl ResistanceLaw for Magnus {
    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let moved = bed.bulk_density * at.loaded_area * 0.5 * at.diameter;
        let spin = Vec3::new(0.0, motion.spin, 0.0);
        load.dynamic += spin.cross(&motion.velocity) * (self.q * moved);
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
    fn a_sinking_sphere_that_rolls_forward_is_pushed_back() {
        let mut load = Load::default();
        let motion = Motion { spin: 10.0, ..sinking(2.0) };
        Magnus { q: 1.5 }.act(&SPHERE.at(0.02), &motion, &surroundings(), &mut load);
        // 1.5 × 1520 kg/m³ × 5.067e-4 m² × 0.0127 m × 10 rad/s × 2 m/s.
        assert!((load.dynamic.x + 0.293_441).abs() < 1e-5, "{}", load.dynamic.x);
        assert!(load.dynamic.z.abs() < 1e-15);
    }
}
