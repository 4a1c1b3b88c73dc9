//! A force over depth and speed, as a law.

use std::sync::Arc;

use engine::math::Vec3;
use resistive::{Immersion, Load, Motion, ResistanceLaw, Surroundings};

use crate::forward::field::Field;

/// A force that pushes, or is normal to the motion, fades with the speed below this share of √(g D), so that it moves nothing
/// that rests.
const REST: f64 = 0.05;

/// The force of a field in an impact at one angle: where it resists it is a friction, there at rest too.
pub(super) struct FieldForce {
    pub(super) field: Arc<Field>,
    /// Below the horizontal (rad).
    pub(super) angle: f64,
}

impl FieldForce {
    /// Against the motion, and normal to it (N).
    fn sizes(&self, at: &Immersion, motion: &Motion, bed: &Surroundings) -> [f64; 2] {
        let unit = bed.bulk_density * bed.gravity * at.loaded_area * at.diameter;
        let place = [at.depth, motion.speed.abs(), self.angle, at.diameter];
        [self.field.at(place), self.field.sideways_at(place)].map(|size| unit * size)
    }
}

impl ResistanceLaw for FieldForce {
    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let [size, sideways] = self.sizes(at, motion, bed);
        let slow = REST * (bed.gravity * at.diameter).sqrt();
        let faded = libm::tanh(motion.speed / slow);
        if size >= 0.0 {
            load.friction += Vec3::new(size, 0.0, size);
        } else {
            load.dynamic -= motion.direction * (size * faded);
        }
        let normal = Vec3::new(-motion.direction.z, 0.0, motion.direction.x);
        load.dynamic += normal * (sideways * motion.leaning() * faded);
    }
}
