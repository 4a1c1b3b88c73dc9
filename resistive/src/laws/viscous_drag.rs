//! Drag in proportion to the speed.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::params::Range;

use super::facts::{Facts, Kind, Needs, Twin};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = −q ρ A V_s v, V_s = √(g D)   (N)
///
/// Source: linear band between quasi-static and quadratic drag, Froude 1 to 5, in published simulations;
/// amplitudes are scaled so that q is a pure number.
struct ViscousDrag {
    q: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "viscous-drag", kind: ChannelKind::Dissipated },
    flow: Flow::Dynamic,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "viscous-drag",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[Twin { effect: "yield-stress", any_of: &[Needs::Speeds] }],
    }),
    summary: "A drag in proportion to the speed.",
    formula: "F = -q rho A sqrt(g D) v",
    signature: "depth falls by the same fraction at all speeds, stopping time hardly moves, soft landing",
    source: "term of the resistance law between the quasi-static and the quadratic regime",
    params: &[amplitude(
        Range::closed(0.0, 200.0),
        Range::closed(0.0, 10.0),
        "drag in units of rho A sqrt(g D) v",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(ViscousDrag { q: given.get("q") }),
};

impl ResistanceLaw for ViscousDrag {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let scale = (bed.gravity * at.diameter).sqrt();
        load.dynamic -= motion.velocity * (self.q * bed.bulk_density * at.loaded_area * scale);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn the_force_is_linear_in_the_speed() {
        let bed = surroundings();
        let (mut slow, mut fast) = (Load::default(), Load::default());
        ViscousDrag { q: 0.5 }.act(&SPHERE.at(0.02), &sinking(1.0), &bed, &mut slow);
        ViscousDrag { q: 0.5 }.act(&SPHERE.at(0.02), &sinking(3.0), &bed, &mut fast);
        let scale = (9.8_f64 * 0.0254).sqrt();
        let expected = 0.5 * bed.bulk_density * SPHERE.frontal_area() * scale;
        assert!((slow.dynamic.z - expected).abs() < 1e-12);
        assert!((fast.dynamic.z - 3.0 * expected).abs() < 1e-12);
    }
}
