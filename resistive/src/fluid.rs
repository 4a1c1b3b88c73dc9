//! What a fluid in the bed and above it does to a body.

use super::assembly::{Assembly, State};
use super::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::fluid::Fluid;
use engine::ledger::{Channel, ChannelKind};

/// Its laws for `assembly` at `start`: buoyancy and added mass, and drag.
///
/// The surface of the fluid is so high above the bed that the body is under it at all times. The laws take diameter and
/// volume from the first part.
pub(super) fn around(
    fluid: Fluid,
    assembly: &dyn Assembly,
    start: &State,
) -> [Box<dyn ResistanceLaw>; 2] {
    let Immersion { diameter, body_volume: volume, .. } = assembly.part(0, start).immersion;
    let added_mass = fluid.added_mass(diameter, volume);
    let displaced_mass = fluid.density * volume;
    [Box::new(Displaced { displaced_mass, added_mass }), Box::new(Drag { fluid })]
}

/// F = ρ V g upward, and m_a = k ρ V moves with the body   (N, kg)
///
/// Source: Archimedes; [`Fluid::added_mass`] for k.
struct Displaced {
    displaced_mass: f64,
    added_mass: f64,
}

/// F = −½ ρ C_D A v² v̂   (N)
///
/// Source: [`Fluid::resistance`], of a sphere for every shape.
struct Drag {
    fluid: Fluid,
}

impl ResistanceLaw for Displaced {
    fn accounts(&self) -> &'static [Account] {
        &[
            Account {
                channel: Channel { name: "fluid-buoyancy", kind: ChannelKind::Stored },
                flow: Flow::Dynamic,
            },
            Account {
                channel: Channel { name: "fluid-added-mass", kind: ChannelKind::Stored },
                flow: Flow::AddedMass,
            },
        ]
    }

    fn act_everywhere(&self, _: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        load.dynamic.z += self.displaced_mass * bed.gravity;
        load.added_mass += self.added_mass;
    }
}

impl ResistanceLaw for Drag {
    fn accounts(&self) -> &'static [Account] {
        &[Account {
            channel: Channel { name: "fluid-drag", kind: ChannelKind::Dissipated },
            flow: Flow::Dynamic,
        }]
    }

    fn act_everywhere(&self, at: &Immersion, motion: &Motion, _: &Surroundings, load: &mut Load) {
        let resistance = self.fluid.resistance(at.diameter, at.frontal_area, motion.speed);
        load.dynamic -= motion.velocity * resistance;
    }
}
