//! A force across an oblique path, out of the bed.

use crate::{Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = q ρ A v² n̂, n̂ = s (−v̂_z, v̂_x) of (x, z), s the sense of v_x, 0 on a vertical path   (N)
///
/// normal to the motion in its plane, out of the bed where the body sinks; none on a vertical fall. It does
/// no work.
///
/// Source: lift of a body dragged through grains (Ding, Gravish & Goldman, Phys. Rev. Lett. 106, 028001
/// (2011)), with the square of the speed as in a fluid.
struct Lift {
    q: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "lift",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[Needs::Oblique],
        separable_from: &[],
    }),
    summary: "A force across an oblique path, out of the bed.",
    formula: "F = q rho A v^2, normal to v in the plane of motion",
    signature: "shallow paths are bent upward: less deep and farther, up to ricochet; vertical impacts are unchanged",
    source: "Ding, Gravish & Goldman, Phys. Rev. Lett. 106, 028001 (2011)",
    params: &[amplitude(
        Range::closed(-10.0, 10.0),
        Range::closed(-0.5, 1.0),
        "lift coefficient on the frontal area",
    )],
    forms: &[],
    variables: &[],
    accounts: &[],
    build: |given| Box::new(Lift { q: given.get("q") }),
};

impl ResistanceLaw for Lift {
    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let Motion { velocity, speed, .. } = *motion;
        let pressure = self.q * bed.bulk_density * at.loaded_area * speed * motion.leaning();
        load.dynamic += Vec3::new(-velocity.z, 0.0, velocity.x) * pressure;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    fn oblique(x: f64, z: f64) -> Motion {
        let velocity = Vec3::new(x, 0.0, z);
        let speed = velocity.norm();
        let sense = [x.signum(), z.signum()];
        Motion { velocity, speed, direction: velocity / speed, sense, spin: 0.0, time: 0.0 }
    }

    #[test]
    fn a_body_that_sinks_obliquely_is_pushed_up_whichever_way_it_goes() {
        for forward in [1.0, -1.0] {
            let mut load = Load::default();
            let law = Lift { q: 0.2 };
            law.act(&SPHERE.at(0.02), &oblique(1.2 * forward, -0.9), &surroundings(), &mut load);
            // 0.2 × 1520 kg/m³ × 5.067e-4 m² × 2.25 m²/s², of which 0.6 sideways and 0.8 up.
            let lift = 0.346_585;
            assert!((load.dynamic.x - forward * 0.6 * lift).abs() < 1e-5, "{}", load.dynamic.x);
            assert!((load.dynamic.z - 0.8 * lift).abs() < 1e-5, "{}", load.dynamic.z);
        }
    }

    #[test]
    fn a_vertical_fall_is_not_lifted() {
        let mut load = Load::default();
        Lift { q: 0.2 }.act(&SPHERE.at(0.02), &sinking(2.0), &surroundings(), &mut load);
        assert!(load.dynamic.norm() < 1e-15);
    }

    #[test]
    fn a_path_that_hardly_leans_is_hardly_lifted() {
        let lift = |lean: f64| {
            let mut load = Load::default();
            let law = Lift { q: 0.2 };
            law.act(&SPHERE.at(0.02), &oblique(lean, -1.0), &surroundings(), &mut load);
            load.dynamic.x
        };
        // From one side to the other without a jump; whole from 3° on.
        assert!((lift(1e-4) + lift(-1e-4)).abs() < 1e-12 && lift(1e-4) > 0.0);
        assert!(lift(1e-4) < 0.004 * lift(0.06), "{} {}", lift(1e-4), lift(0.06));
        assert!((lift(0.06) / lift(0.12) - 1.0).abs() < 0.01);
    }
}
