//! The air between grains, as a drag on each.

use engine::grain_force::{ForceOnGrain, GrainForce, MovingGrain};
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable};
use engine::units::Dimension;

use super::GrainForceEntry;
use crate::candidate::{Candidacy, Candidate};

/// A drag on every grain by air at rest.
///
/// F = −m γ v   (N)
///
/// By the relation of Kozeny and Carman, for grains of diameter d and density ρ_s in a bed of porosity ε
/// under a gas of viscosity η, γ = 150 η (1 − ε)/(ε² ρ_s d²): 100 1/s for glass of 0.2 mm in air, 0.2 1/s for
/// glass of 5 mm. The air does not flow, so that it takes no momentum from grain to grain: in a bed that
/// moves as a whole it is too strong. The spin is left alone.
///
/// Source: Carman, Trans. Inst. Chem. Eng. 15, 150 (1937); Ergun, Chem. Eng. Prog. 48, 89 (1952), the part
/// that is linear in the velocity.
struct PoreAir {
    drag_rate: f64,
}

impl GrainForce for PoreAir {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn on(&self, grain: &MovingGrain) -> ForceOnGrain {
        let force = grain.velocity * (-grain.mass * self.drag_rate);
        ForceOnGrain { force, torque: Vec3::zeros() }
    }

    fn relaxation_time(&self, _: &MovingGrain) -> f64 {
        1.0 / self.drag_rate
    }
}

const PARAMS: &[ParamSpec] = &[ParamSpec::required(
    "drag_rate",
    Dimension::RATE,
    "γ, drag of the air on a grain over its mass and velocity",
)
.usual(0.01, 1e3)];

/// The registry's line.
pub(super) const ENTRY: GrainForceEntry = GrainForceEntry {
    name: "pore-air",
    only_in: None,
    summary: "The air between grains: a drag on each grain in proportion to its velocity.",
    formula: "F = −m γ v;  γ = 150 η (1 − ε)/(ε² ρ_s d²)",
    signature: "A bed that gives way later: fast impacts are stopped earlier, slow ones hardly.",
    source: "Carman, Trans. Inst. Chem. Eng. 15, 150 (1937); Ergun, Chem. Eng. Prog. 48, 89 (1952)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "drag_rate (1/s)",
        screen: 5.0,
        range: (0.0, 200.0),
        separable_from: "from restitution: a wide range of speeds; from air-drag: flight before contact",
        alike_below: &[],
        needs: &[],
        params: |_, q| vec![("drag_rate", q)],
    }),
    build: |params: &ParamTable| Box::new(PoreAir { drag_rate: params.get("drag_rate") }),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drag_is_mass_times_rate_times_velocity() {
        let velocity = Vec3::new(0.5, 0.0, -2.0);
        let grain =
            MovingGrain { velocity, spin: Vec3::y(), radius: 1e-3, mass: 4.0, weight: 39.24 };
        let drag = PoreAir { drag_rate: 0.25 }.on(&grain);
        assert_eq!(drag.force, Vec3::new(-0.5, 0.0, 2.0));
        assert_eq!(drag.torque, Vec3::zeros());
    }
}
