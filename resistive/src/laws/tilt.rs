//! An apparatus that does not stand upright.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::Range;

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{ResistanceEntry, Role, amplitude};

/// F = m g (sin q, 0, 1 − cos q), in the bed and above   (N)
///
/// so that gravity leans by q (rad) towards +x in the plane of motion. Its work is that of a potential, and
/// comes back. It acts where the loads of the bed do, which is the centre of a compact body; of a link that
/// is not its centre of mass.
///
/// Source: geometry.
struct Tilt {
    /// (sin q, 0, 1 − cos q).
    lean: Vec3,
}

impl Tilt {
    fn by(q: f64) -> Self {
        Self { lean: Vec3::new(libm::sin(q), 0.0, 1.0 - libm::cos(q)) }
    }
}

const ACCOUNTS: &[Account] = &[Account {
    channel: Channel { name: "tilt", kind: ChannelKind::Stored },
    flow: Flow::Dynamic,
}];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "tilt",
    role: Role::Effect(Facts {
        kind: Kind::Apparatus,
        unit: "rad",
        visible: &[],
        separable_from: &[
            Confounder { effect: "lift", any_of: &[Needs::Vertical] },
            Confounder { effect: "anisotropic-drag", any_of: &[Needs::Vertical] },
        ],
    }),
    summary: "Gravity leans in the plane of motion: a fault of the apparatus.",
    formula: "F = m g (sin q, 0, 1 - cos q), q in radians",
    signature: "vertical impacts drift sideways, in the flight too; oblique ones go farther or less far",
    source: "geometry of a camera or a guide that is not plumb",
    params: &[amplitude(
        Range::closed(-0.5, 0.5),
        Range::closed(-0.05, 0.05),
        "angle by which gravity leans towards +x, in radians",
    )],
    forms: &[],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| Box::new(Tilt::by(given.get("q"))),
};

impl ResistanceLaw for Tilt {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act_everywhere(&self, at: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        load.dynamic += self.lean * (at.mass * bed.gravity);
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
    fn the_weight_is_turned_and_keeps_its_size() {
        let mut load = Load::default();
        let law = Tilt::by(0.1);
        law.act_everywhere(&SPHERE.at(0.02), &sinking(1.0), &surroundings(), &mut load);
        // 0.0692 kg × 9.8 m/s² × sin 0.1.
        assert!((load.dynamic.x - 0.067_703).abs() < 1e-5, "{}", load.dynamic.x);
        let weight = 0.0692 * 9.8;
        let turned = load.dynamic - Vec3::new(0.0, 0.0, weight);
        assert!((turned.norm() / weight - 1.0).abs() < 1e-14);
    }
}
