//! Where an impact starts: with the intruder just touching the bed.

use crate::grains::Grains;
use crate::math::{Quat, Vec3};
use crate::surface::Surface;

/// How near the intruder is brought to the first grain (m).
const TOUCH: f64 = 1e-12;

/// Rounds of each way to lower it.
const ROUNDS: usize = 1_000;

/// Height (m) of the reference point of `surface`, turned by `orientation`, at which it first touches
/// a grain or the floor when it is lowered along the vertical through `x`, `y`.
pub fn height_in_touch(
    grains: &Grains,
    surface: &dyn Surface,
    orientation: Quat,
    (x, y): (f64, f64),
) -> f64 {
    let reach = surface.bounding_radius();
    let images = grains.positions().map(|at| grains.period.image_near(at, Vec3::new(x, y, at.z)));
    let below: Vec<(Vec3, f64)> = images
        .zip(grains.radii())
        .filter(|(position, radius)| {
            let apart = Vec3::new(position.x - x, position.y - y, 0.0);
            apart.norm() < reach + radius
        })
        .collect();
    let down = orientation.inverse_transform_vector(&-Vec3::z());
    let on_floor = surface.support(down);
    let top = below.iter().fold(0.0_f64, |top, (position, radius)| top.max(position.z + radius));
    let mut z = top + reach;
    // The least of what `bound` makes of every gap and of what a way down takes from it.
    let least = |z: f64, bound: fn(f64, f64) -> f64| {
        below.iter().fold(bound(z - on_floor, 1.0), |least, &(position, radius)| {
            let local = orientation.inverse_transform_vector(&(position - Vec3::new(x, y, z)));
            let nearest = surface.closest(local);
            let slope = -(orientation * nearest.normal).z;
            least.min(bound(nearest.gap - radius, slope))
        })
    };
    // A gap bounds the free way from below, so this never passes the first touch. Each round leaves
    // the share of the way that the slope of the contact takes away.
    for _ in 0..ROUNDS {
        let gap = least(z, |gap, _| gap);
        if gap < TOUCH {
            return z;
        }
        z -= gap;
    }
    // Along a steep flank that is nearly all. The gap to a convex body is convex along a line, so its
    // tangent reaches zero no later, and a gap that does not close never does.
    for _ in 0..ROUNDS {
        z -= least(z, |gap, slope| if slope > 0.0 { gap / slope } else { f64::INFINITY });
        if least(z, |gap, _| gap) < TOUCH {
            break;
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::Grain;
    use crate::space::Space;
    use crate::surface::SurfacePoint;

    /// Half a plane that leans steeply: the flank of a sharp wedge, along y and upward without end.
    struct Flank(Vec3);

    impl Surface for Flank {
        fn closest(&self, point: Vec3) -> SurfacePoint {
            let gap = point.dot(&self.0);
            SurfacePoint { normal: self.0, gap, curvature: 0.0, felt: true }
        }

        fn support(&self, _: Vec3) -> f64 {
            0.0
        }

        fn bounding_radius(&self) -> f64 {
            1.0
        }
    }

    #[test]
    fn a_flank_a_thousandth_off_the_vertical_is_lowered_to_its_touch() {
        let grain = Grain {
            position: Vec3::new(0.05, 0.0, 0.5),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            radius: 0.01,
            mass: 1.0,
            id: 0,
        };
        let grains = Grains::new(Space::Planar, &[grain]);
        let normal = Vec3::new(1.0, 0.0, -1e-3).normalize();
        let z = height_in_touch(&grains, &Flank(normal), Quat::identity(), (0.0401, 0.0));
        let gap = Flank(normal).closest(grain.position - Vec3::new(0.0401, 0.0, z)).gap - 0.01;
        assert!((0.0..TOUCH).contains(&gap.abs()), "{gap:e}");
    }
}
