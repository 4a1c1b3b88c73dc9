//! What differs from run to run, as something that laws can be told.

use engine::math::Vec3;
use resistive::{Immersion, Load, Motion, ResistanceLaw};

use crate::forward::Scatter;

/// A factor on the whole resistance and a force across the motion, both over depth.
pub(super) struct PathScatter {
    along: Vec<f64>,
    sideways: Vec<f64>,
    reach: f64,
}

impl PathScatter {
    /// The part of `scatter` that follows the path; `None` if there is none.
    pub(super) fn of(scatter: &Scatter) -> Option<Self> {
        let there = |nodes: &[f64]| nodes.iter().any(|&value| value != 0.0);
        (there(&scatter.along) || there(&scatter.sideways)).then(|| Self {
            along: scatter.along.clone(),
            sideways: scatter.sideways.clone(),
            reach: scatter.reach,
        })
    }

    fn at(&self, nodes: &[f64], depth: f64) -> f64 {
        let Some(last) = nodes.len().checked_sub(1) else { return 0.0 };
        let place = (depth / self.reach).clamp(0.0, 1.0) * last as f64;
        let below = (place as usize).min(last);
        let above = (below + 1).min(last);
        let share = place - below as f64;
        (1.0 - share) * nodes[below] + share * nodes[above]
    }
}

impl ResistanceLaw for PathScatter {
    fn modulate(&self, at: &Immersion, motion: &Motion, load: &mut Load) {
        let factor = 1.0 + self.at(&self.along, at.depth);
        load.dynamic *= factor;
        load.friction *= factor;
        for grip in &mut load.grip {
            grip.positive *= factor;
            grip.negative *= factor;
        }
        let across = self.at(&self.sideways, at.depth);
        if across != 0.0 {
            let gripped = Vec3::new(load.grip[0].positive, 0.0, load.grip[1].negative);
            let held = (load.friction + gripped).component_mul(&motion.direction);
            let size = (load.dynamic - held).norm();
            // Out of the bed for a body that sinks, forward for one that falls straight down.
            let normal = Vec3::new(-motion.direction.z, 0.0, motion.direction.x);
            load.dynamic += normal * (across * size);
        }
    }

    fn deflects(&self) -> bool {
        self.sideways.iter().any(|&value| value != 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_joined_by_straight_lines_and_the_last_one_holds_beyond() {
        let scatter = PathScatter { along: vec![0.0, 1.0, -1.0], sideways: vec![], reach: 0.1 };
        for (depth, expected) in [(0.0, 0.0), (0.025, 0.5), (0.05, 1.0), (0.1, -1.0), (0.3, -1.0)] {
            assert!((scatter.at(&scatter.along, depth) - expected).abs() < 1e-12);
        }
        assert!(!scatter.deflects());
    }
}
