//! Drag of the air.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::params::Range;

use super::facts::{Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = −½ q ρ_a A v² v̂, ρ_a = 1.2 kg/m³, in the bed and above   (N, planar N/m)
///
/// In the bed it is lost in the drag of the grains, so only the flight shows it.
///
/// Source: drag of a body at large Reynolds number, with q its drag coefficient: 0.47 of a sphere, 1.2 of a
/// long cylinder.
struct AirDrag {
    q: f64,
}

/// Density of air at 20 °C and 1 atm (kg/m³).
const AIR: f64 = 1.2;

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "air-drag", kind: ChannelKind::Dissipated },
    flow: Flow::Dynamic,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "air-drag",
    role: Role::Effect(Facts {
        kind: Kind::Apparatus,
        unit: "1",
        visible: &[Needs::FramesBeforeImpact],
        separable_from: &[],
    }),
    summary: "Drag of the air, in the bed and above.",
    formula: "F = -(1/2) q rho_air A v^2 v/|v|, rho_air = 1.2 kg/m^3",
    signature: "the flight is slower than free fall, the more so the faster",
    source: "drag coefficient at large Reynolds number; air at 20 C and 1 atm",
    params: &[amplitude(
        Range::closed(0.0, 1e5),
        Range::closed(0.0, 5.0),
        "drag coefficient in air",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(AirDrag { q: given.get("q") }),
};

impl ResistanceLaw for AirDrag {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act_everywhere(&self, at: &Immersion, motion: &Motion, _: &Surroundings, load: &mut Load) {
        let drag = 0.5 * self.q * AIR * at.frontal_area * motion.speed;
        load.dynamic -= motion.velocity * drag;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn it_acts_above_the_bed_with_the_square_of_the_speed() {
        let mut load = Load::default();
        let above = SPHERE.at(-0.1);
        AirDrag { q: 0.47 }.act_everywhere(&above, &sinking(3.0), &surroundings(), &mut load);
        // ½ × 0.47 × 1.2 kg/m³ × 5.067e-4 m² × 9 m²/s².
        assert!((load.dynamic.z - 1.286_0e-3).abs() < 1e-6, "{}", load.dynamic.z);
    }
}
