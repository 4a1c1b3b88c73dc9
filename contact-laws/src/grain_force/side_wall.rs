//! Friction of discs with the plates that hold them in their plane.

use engine::grain_force::{ForceOnGrain, GrainForce, MovingGrain};
use engine::grains::Space;
use engine::params::{ParamSpec, ParamTable};

use super::GrainForceEntry;
use crate::candidate::{Candidacy, Candidate, Need};

/// Below this speed (m/s) the friction goes to zero with the speed, so that grains come to rest.
const CREEP: f64 = 1e-3;

/// Friction of a disc that leans on a plate by a share of its weight.
///
/// F = −μ m g v/√(v² + v_c²)   (N),  T = −⅔ μ m g r · r ω/√((r ω)² + v_c²)   (N m)
///
/// with v_c = 1 mm/s. μ is the coefficient of friction times the share of the weight that presses on the
/// plates. The torque is that of an even pressure on a disc that turns on its place; that sliding and turning
/// weaken each other is left out.
///
/// Source: Coulomb's friction; for plates beside a bed, Sperl, Granul. Matter 8, 59 (2006) has Janssen's
/// reasoning.
struct SideWall {
    plate_friction: f64,
}

impl GrainForce for SideWall {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn on(&self, grain: &MovingGrain) -> ForceOnGrain {
        let limit = self.plate_friction * grain.weight;
        let (slip, turn) = (grain.velocity, grain.spin * grain.radius);
        let smooth = |speed: f64| (speed * speed + CREEP * CREEP).sqrt();
        ForceOnGrain {
            force: slip * (-limit / smooth(slip.norm())),
            torque: turn * (-2.0 / 3.0 * limit * grain.radius / smooth(turn.norm())),
        }
    }

    /// Of a creeping disc; the spin, with I = ½ m r², is braked by ⅔ · 2 of the same rate.
    fn relaxation_time(&self, grain: &MovingGrain) -> f64 {
        0.75 * CREEP * grain.mass / (self.plate_friction * grain.weight)
    }
}

/// Why spheres do not have it.
const DISCS_ALONE: &str = "spheres are not held between two plates";

const PARAMS: &[ParamSpec] =
    &[ParamSpec::number("plate_friction", "μ, friction of a disc with the plates over its weight")
        .usual(0.01, 1.0)];

/// The registry's line.
pub(super) const ENTRY: GrainForceEntry = GrainForceEntry {
    name: "side-wall",
    only_in: Some((Space::Planar, DISCS_ALONE)),
    summary: "Plates beside a planar bed: dry friction of every disc that moves.",
    formula: "F = −μ m g v/√(v² + v_c²);  T = −⅔ μ m g r · r ω/√((r ω)² + v_c²)",
    signature: "A stiffer bed: depth and stopping time fall together, more where more grains move.",
    source: "Coulomb friction; Sperl, Granul. Matter 8, 59 (2006)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "plate_friction",
        screen: 0.1,
        range: (0.0, 1.0),
        separable_from: "from grain-friction: slow impacts, or plates of another roughness",
        alike_below: &[],
        needs: &[Need::Discs(DISCS_ALONE), Need::Gravity],
        params: |_, q| vec![("plate_friction", q)],
    }),
    build: |params: &ParamTable| {
        Box::new(SideWall { plate_friction: params.get("plate_friction") })
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use engine::math::Vec3;

    #[test]
    fn a_fast_disc_feels_the_whole_friction_and_a_creeping_one_half_of_it() {
        let law = SideWall { plate_friction: 0.2 };
        let moving = |speed: f64| MovingGrain {
            velocity: Vec3::x() * speed,
            spin: Vec3::y() * (speed / 0.01),
            radius: 0.01,
            mass: 0.1,
            weight: 1.0,
        };
        let fast = law.on(&moving(1.0));
        // v_c is a thousandth of the speed, which takes half a millionth of the force.
        assert!((fast.force.x + 0.2).abs() < 2e-7);
        assert!((fast.torque.y + 2.0 / 3.0 * 0.2 * 0.01).abs() < 2e-9);
        let creeping = law.on(&moving(CREEP / 3.0_f64.sqrt()));
        // At v_c/√3, v/√(v² + v_c²) is one half.
        assert!((creeping.force.x + 0.1).abs() < 1e-12);
    }
}
