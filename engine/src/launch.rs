//! Where an impact starts: with the intruder just touching the bed.

use crate::grains::Grains;
use crate::math::{Quat, Vec3};
use crate::surface::Surface;

/// How near the intruder is brought to the first grain (m).
const TOUCH: f64 = 1e-12;

/// Height (m) of the reference point of `surface`, turned by `orientation`, at which it first touches
/// a grain or the floor when it is lowered along the vertical through `x`, `y`.
#[must_use]
pub fn height_in_touch(
    grains: &Grains,
    surface: &dyn Surface,
    orientation: Quat,
    (x, y): (f64, f64),
) -> f64 {
    let reach = surface.bounding_radius();
    let below: Vec<(Vec3, f64)> = grains
        .position
        .iter()
        .zip(&grains.radius)
        .filter(|(position, radius)| {
            let apart = Vec3::new(position.x - x, position.y - y, 0.0);
            apart.norm() < reach + **radius
        })
        .map(|(&position, &radius)| (position, radius))
        .collect();
    let down = orientation.inverse_transform_vector(&-Vec3::z());
    let on_floor = surface.support(down);
    let top = below.iter().fold(0.0_f64, |top, (position, radius)| top.max(position.z + radius));
    let mut z = top + reach;
    // A gap bounds the free way from below, so this never passes the first touch; near it, each
    // round leaves at most the share that the slope of the contact does not take away.
    for _ in 0..10_000 {
        let gap = below.iter().fold(z - on_floor, |gap, &(position, radius)| {
            let local = orientation.inverse_transform_vector(&(position - Vec3::new(x, y, z)));
            gap.min(surface.closest(local).gap - radius)
        });
        if gap < TOUCH {
            break;
        }
        z -= gap;
    }
    z
}
