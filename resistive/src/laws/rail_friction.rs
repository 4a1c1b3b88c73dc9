//! Friction of the guide on which an intruder falls.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Facts, Kind};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = −q v̂ (1 N), in the bed and above   (N)
///
/// The only scale that it has is its own: q is the friction in newtons.
///
/// Source: dry friction of a guide; unknown in most campaigns.
struct RailFriction {
    q: f64,
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "rail-friction", kind: ChannelKind::Dissipated },
    flow: Flow::Static,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "rail-friction",
    role: Role::Effect(Facts {
        kind: Kind::Apparatus,
        unit: "N",
        visible: &[],
        separable_from: &[],
    }),
    summary: "A constant friction of the guide, in the bed and above, whatever the area.",
    formula: "F = -q v/|v|, q in newtons",
    signature: "impact speed below that of free fall; in the bed like a constant force",
    source: "dry friction of a guide",
    params: &[amplitude(
        Range::closed(0.0, 1000.0),
        Range::closed(0.0, 10.0),
        "friction in newtons",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(RailFriction { q: given.get("q") }),
};

impl ResistanceLaw for RailFriction {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act_everywhere(&self, _: &Immersion, _: &Motion, _: &Surroundings, load: &mut Load) {
        load.friction += Vec3::new(1.0, 0.0, 1.0) * self.q;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn it_acts_above_the_bed_too() {
        let mut load = Load::default();
        let above = SPHERE.at(-0.1);
        RailFriction { q: 0.3 }.act_everywhere(&above, &sinking(1.0), &surroundings(), &mut load);
        assert!((load.friction.z - 0.3).abs() < 1e-15);
    }
}
