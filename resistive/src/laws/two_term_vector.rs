//! Drag with the square of the speed and friction with the depth, both against the motion.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::ParamSpec;

use super::registry::{ResistanceEntry, Role};

/// m a = m g − C_d ρ A |v| v − C_f ρ g A z v̂   (N)
///
/// A = πD²/4 (m²), in a planar medium D (m) with ρ per area. Friction is set-valued at rest: it holds
/// the body there as long as C_f ρ g A z balances what pulls.
///
/// Source: Katsuragi & Durian, Nature Phys. 3, 420 (2007), with drag and friction along the velocity.
struct TwoTermVector {
    drag: f64,
    friction: f64,
}

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "two-term-vector",
    role: Role::Baseline,
    summary: "Inertial drag and depth-proportional friction, both against the velocity.",
    formula: "F = -C_d rho A |v| v - C_f rho g A z v/|v|",
    signature: "depth grows slower than linearly with speed, stopping time falls towards a plateau",
    source: "Katsuragi & Durian, Nature Phys. 3, 420 (2007)",
    params: &[
        ParamSpec::number("drag", "drag coefficient C_d on the frontal area").usual(0.1, 10.0),
        ParamSpec::number("friction", "friction coefficient C_f on the frontal area")
            .usual(1.0, 100.0),
    ],
    forms: &[],
    variables: &["density", "angle"],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(TwoTermVector { drag: given.get("drag"), friction: given.get("friction") })
    },
};

/// What every two-term law books.
pub(super) const ACCOUNTS: &[Account] = &[
    Account {
        channel: Channel { name: "inertial-drag", kind: ChannelKind::Dissipated },
        flow: Flow::Dynamic,
    },
    Account {
        channel: Channel { name: "depth-friction", kind: ChannelKind::Dissipated },
        flow: Flow::Static,
    },
];

impl ResistanceLaw for TwoTermVector {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let loaded = bed.bulk_density * at.loaded_area;
        let drag = self.drag * at.drag_factor * loaded * motion.speed;
        load.dynamic -= sideways(motion.velocity, at.sideways_drag) * drag;
        let friction = self.friction * at.friction_factor * loaded * bed.gravity;
        let limit = friction * at.effective_depth;
        load.friction += Vec3::new(limit * at.sideways_friction, 0.0, limit);
    }
}

/// `vector` with its horizontal part multiplied by `factor`.
fn sideways(vector: Vec3, factor: f64) -> Vec3 {
    Vec3::new(vector.x * factor, vector.y, vector.z)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn drag_goes_with_the_square_of_the_speed_and_friction_with_depth() {
        let law = TwoTermVector { drag: 1.2, friction: 15.0 };
        let bed = surroundings();
        let (mut slow, mut fast) = (Load::default(), Load::default());
        law.act(&SPHERE.at(0.02), &sinking(1.0), &bed, &mut slow);
        law.act(&SPHERE.at(0.04), &sinking(2.0), &bed, &mut fast);
        let area = SPHERE.frontal_area();
        assert!((slow.dynamic.z - 1.2 * bed.bulk_density * area).abs() < 1e-12);
        assert!((fast.dynamic.z / slow.dynamic.z - 4.0).abs() < 1e-12);
        let limit = 15.0 * bed.bulk_density * bed.gravity * area * 0.02;
        assert!((slow.friction.z - limit).abs() < 1e-12);
        assert!((fast.friction.z / slow.friction.z - 2.0).abs() < 1e-12);
    }
}
