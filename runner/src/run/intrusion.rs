//! The force along the way of an intruder that a drive pushes.

use configs::{Condition, Model};
use engine::math::Vec3;
use serde::{Deserialize, Serialize};

use super::summary::IntrusionSummary;

/// Equal parts of the depth over which a force is averaged.
const PARTS: usize = 50;

/// What is gathered of a push while it runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Push {
    /// Where it ends (m).
    depth: f64,
    parts: Vec<Part>,
}

/// Sums over the samples within one part of the depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Part {
    samples: u64,
    depth: f64,
    force: [f64; 2],
    torque: f64,
}

impl Push {
    /// Of `model`, if a drive pushes its intruder.
    pub(super) fn of(model: &Model, condition: &Condition) -> Option<Self> {
        let depth = model.launch(condition).pushed_to?;
        Some(Self { depth, parts: vec![Part::default(); PARTS] })
    }

    /// Takes note of the force (N) and torque (N m) on the intruder `depth` (m) deep.
    pub(super) fn see(&mut self, depth: f64, force: Vec3, torque: Vec3) {
        let at = (depth / self.depth * PARTS as f64).max(0.0) as usize;
        let part = &mut self.parts[at.min(PARTS - 1)];
        part.samples += 1;
        part.depth += depth;
        part.force[0] += force.x;
        part.force[1] += force.z;
        part.torque += torque.y;
    }

    /// What it comes to, with the work of the drive (J).
    pub(super) fn summary(&self, work: f64) -> IntrusionSummary {
        let seen = || self.parts.iter().filter(|part| part.samples > 0);
        let mean =
            |of: fn(&Part) -> f64| seen().map(|part| of(part) / part.samples as f64).collect();
        IntrusionSummary {
            to_depth_m: self.depth,
            work,
            depth_m: mean(|part| part.depth),
            force_x: mean(|part| part.force[0]),
            force_z: mean(|part| part.force[1]),
            torque_y: mean(|part| part.torque),
        }
    }
}

/// How near (relative) the depth of a push counts as its end: a run ends at a whole step.
const END: f64 = 0.01;

impl IntrusionSummary {
    /// Whether a push that came `depth` (m) deep came to its end.
    pub(super) fn is_complete(&self, depth: f64) -> bool {
        depth >= (1.0 - END) * self.to_depth_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_means_over_parts_of_the_depth_and_the_end_belongs_to_the_last() {
        let mut push = Push { depth: 0.5, parts: vec![Part::default(); PARTS] };
        for (depth, force) in [(0.002, 1.0), (0.006, 3.0), (0.5, 8.0)] {
            push.see(depth, Vec3::new(-force, 0.0, force), Vec3::y() * force);
        }
        let summary = push.summary(2.0);
        // Sums of two: exact but for the depths.
        assert_eq!(summary.force_z, [2.0, 8.0]);
        assert_eq!(summary.force_x, [-2.0, -8.0]);
        assert_eq!(summary.torque_y, [2.0, 8.0]);
        assert!((summary.depth_m[0] - 0.004).abs() < 1e-15 && summary.depth_m.len() == 2);
        assert!(summary.is_complete(0.499) && !summary.is_complete(0.4));
    }
}
