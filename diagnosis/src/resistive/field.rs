//! A force over depth and speed, as a law.

use std::sync::Arc;

use engine::math::Vec3;
use resistive::{Account, Immersion, Load, Motion, ResistanceLaw, Surroundings};

use crate::field::Field;

/// A force that pushes fades with the speed below this share of √(g D), so that it moves nothing that rests.
const REST: f64 = 0.05;

/// The force of a field in an impact at one angle: where it resists it is a friction, there at rest too.
pub(super) struct FieldForce {
    pub(super) field: Arc<Field>,
    /// Below the horizontal (rad).
    pub(super) angle: f64,
}

impl FieldForce {
    fn size(&self, at: &Immersion, motion: &Motion, bed: &Surroundings) -> f64 {
        let unit = bed.bulk_density * bed.gravity * at.loaded_area * at.diameter;
        unit * self.field.at([at.depth, motion.speed.abs(), self.angle, at.diameter])
    }
}

impl ResistanceLaw for FieldForce {
    fn accounts(&self) -> &'static [Account] {
        &[]
    }

    fn act(&self, at: &Immersion, motion: &Motion, bed: &Surroundings, load: &mut Load) {
        let size = self.size(at, motion, bed);
        if size >= 0.0 {
            load.friction += Vec3::new(size, 0.0, size);
        } else {
            let slow = REST * (bed.gravity * at.diameter).sqrt();
            load.dynamic -= motion.direction * (size * libm::tanh(motion.speed / slow));
        }
    }
}
