//! Bekker's law of plates: a pressure that grows with a power of the sinkage.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::{ParamSpec, Range};
use engine::units::Dimension;

use super::registry::{ResistanceEntry, Role};

/// F = −A (k_c/b + k_φ) (z / 1 m)ⁿ v̂   (N)
///
/// b is the radius of a round plate (m). It is set-valued at rest, like any friction; there is no drag.
///
/// Source: Bekker, Introduction to Terrain-Vehicle Systems (1969), with the sinkage in metres.
struct Bekker {
    cohesive: f64,
    frictional: f64,
    exponent: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "sinkage", kind: ChannelKind::Dissipated },
    flow: Flow::Static,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "bekker",
    role: Role::Baseline,
    summary: "Bekker's pressure on a plate, a power of the sinkage, for slow pushes.",
    formula: "F = -A (k_c/b + k_phi) (z / 1 m)^n v/|v|",
    signature: "force grows with a power of the depth and faster than the area of small plates",
    source: "Bekker, Introduction to Terrain-Vehicle Systems (1969)",
    params: &[
        ParamSpec::required("cohesive", Dimension::STIFFNESS, "k_c, the modulus over the radius b")
            .allowed(Range::closed(-1e12, 1e12))
            .usual(-1e8, 1e8),
        ParamSpec::required("frictional", Dimension::PRESSURE, "k_phi, the other modulus")
            .usual(1e3, 1e11),
        ParamSpec::number("exponent", "n, the power of the sinkage in metres")
            .allowed(Range { min: 0.0, max: 5.0, includes_min: false })
            .usual(0.3, 2.5),
    ],
    forms: &[],
    variables: &["density", "angle"],
    accounts: ACCOUNTS,
    build: |given| {
        let (cohesive, frictional) = (given.get("cohesive"), given.get("frictional"));
        Box::new(Bekker { cohesive, frictional, exponent: given.get("exponent") })
    },
};

impl ResistanceLaw for Bekker {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, _: &Motion, _: &Surroundings, load: &mut Load) {
        let modulus = self.cohesive / (0.5 * at.diameter) + self.frictional;
        let depth = at.effective_depth.max(0.0);
        // Two moduli may come to nothing, and no friction pushes.
        let pressure = modulus.max(0.0) * libm::pow(depth, self.exponent);
        let limit = pressure * at.friction_factor * at.loaded_area;
        load.friction += Vec3::new(limit * at.sideways_friction, 0.0, limit);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn the_pressure_is_a_power_of_the_depth_with_a_modulus_of_the_radius() {
        let law = Bekker { cohesive: 2e3, frictional: 1e6, exponent: 1.5 };
        let mut load = Load::default();
        law.act(&SPHERE.at(0.04), &sinking(0.01), &surroundings(), &mut load);
        let radius = 0.5 * SPHERE.at(0.04).diameter;
        // 0.04 to the power 1.5 is 0.008.
        let expected = (2e3 / radius + 1e6) * 0.008 * SPHERE.frontal_area();
        assert!((load.friction.z / expected - 1.0).abs() < 1e-12, "{}", load.friction.z);
    }
}
