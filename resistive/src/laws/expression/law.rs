//! A user-defined effect as a term of the force.

use std::sync::Arc;

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;

use super::super::approach::Approach;
use super::variables::Seen;
use super::{Acts, Direction, OwnEffect};

const fn account(flow: Flow) -> Account {
    Account { channel: Channel { name: "expression", kind: ChannelKind::Dissipated }, flow }
}

const DYNAMIC: &[Account] = &[account(Flow::Dynamic)];
const STATIC: &[Account] = &[account(Flow::Static)];

/// The force that the formula of `effect` says, of amplitude `q` (SI), in the impact of a body that comes as `approach` says.
struct Law {
    effect: Arc<OwnEffect>,
    q: f64,
    approach: Approach,
}

impl OwnEffect {
    /// The term of the force with amplitude `q` (SI) on a body that comes as `approach` says.
    #[must_use]
    pub fn build(self: &Arc<Self>, q: f64, approach: Approach) -> Box<dyn ResistanceLaw> {
        Box::new(Law { effect: Arc::clone(self), q, approach })
    }
}

impl Law {
    fn add(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        if !self.effect.is_informed(bed) {
            return;
        }
        let force = self.force(at, motion, bed);
        let along = |direction: Vec3| direction * force;
        match self.effect.direction() {
            // A friction that pushes is none: no number says so to whoever integrates.
            Direction::Friction if force < 0.0 => load.friction.x = f64::NAN,
            Direction::Friction => load.friction += along(Vec3::new(1.0, 0.0, 1.0)),
            Direction::AgainstMotion => load.dynamic -= along(motion.direction),
            Direction::Up => load.dynamic.z += force,
            Direction::Down => load.dynamic.z -= force,
            Direction::Forward => load.dynamic.x += force,
            Direction::Backward => load.dynamic.x -= force,
            Direction::Normal => {
                load.dynamic += along(normal(motion.direction));
            }
        }
    }

    /// (N), along its direction.
    fn force(&self, at: &Immersion, motion: &Motion, bed: &Surroundings) -> f64 {
        let seen = Seen { at, motion, bed, speed: motion.speed, approach: self.approach };
        let force = self.effect.value(self.q, &seen);
        // Beyond a reversal there are only trials of the solver; where the formula has no value there, such
        // as a broken power of the speed, the value before the reversal is continued evenly.
        match force.is_finite() || motion.speed >= 0.0 {
            true => force,
            false => self.effect.value(self.q, &Seen { speed: -motion.speed, ..seen }),
        }
    }
}

impl ResistanceLaw for Law {
    fn accounts(&self) -> &'static [Account] {
        match self.effect.direction() {
            Direction::Friction => STATIC,
            _ => DYNAMIC,
        }
    }

    fn own_name(&self) -> Option<&str> {
        Some(self.effect.id())
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        if self.effect.acts() == Acts::InBed {
            // A trial of the solver may be a little above.
            let at = Immersion { depth: at.depth.max(0.0), ..*at };
            self.add(&at, motion, bed, load);
        }
    }

    fn act_everywhere(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        if self.effect.acts() == Acts::Everywhere {
            self.add(at, motion, bed, load);
        }
    }

    fn deflects(&self) -> bool {
        matches!(
            self.effect.direction(),
            Direction::Forward | Direction::Backward | Direction::Normal
        )
    }
}

/// Across the motion, out of the bed for a body that sinks, forward for one that falls straight down.
fn normal(direction: Vec3) -> Vec3 {
    Vec3::new(-direction.z, 0.0, direction.x)
}
