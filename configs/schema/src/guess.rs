//! What is assumed of a bed before it is prepared.

use engine::grains::Space;

/// Packing fraction by which the height of a bed is guessed that names no target.
pub(crate) fn guessed_packing(space: Space) -> f64 {
    match space {
        Space::Planar => 0.8,
        Space::Spatial => 0.6,
    }
}
