//! Closed surfaces of triangles: what a log draws of a body.

use std::f64::consts::{PI, TAU};

/// Corners around a round body.
const AROUND: u32 = 48;

/// Rings of a sphere between its poles.
const RINGS: u32 = 23;

/// A surface of triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The corners (m).
    pub corners: Vec<[f64; 3]>,
    /// Indices of corners, three to a triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// A place and a turn, from one frame to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// (m).
    pub(super) position: [f64; 3],
    /// Unit quaternion x, y, z, w.
    pub(super) turn: [f64; 4],
}

/// Not turned.
pub(super) const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

impl Surface {
    /// Adds `other`, stretched by `size` along its axes and then put into `pose`.
    pub(super) fn add(&mut self, other: &Self, size: [f64; 3], pose: Pose) {
        let first = self.corners.len() as u32;
        self.corners.extend(other.corners.iter().map(|corner| {
            let [x, y, z] = [0, 1, 2].map(|axis| size[axis] * corner[axis]);
            pose.apply([x, y, z])
        }));
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|i| first + i)));
    }
}

impl Pose {
    /// Neither moved nor turned.
    pub(super) const NONE: Self = Self { position: [0.0; 3], turn: UPRIGHT };

    /// A point of the inner frame in the outer one: v + 2 w (q × v) + 2 q × (q × v), and the shift.
    pub(super) fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        let [x, y, z, w] = self.turn;
        let q = [x, y, z];
        let once = cross(q, v);
        let twice = cross(q, once);
        [0, 1, 2].map(|i| self.position[i] + v[i] + 2.0 * (w * once[i] + twice[i]))
    }
}

/// The vector product.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A sphere of diameter 1.
pub(super) fn ball() -> Surface {
    let ring = |ring: u32| {
        let angle = PI * f64::from(ring) / f64::from(RINGS + 1);
        (0.5 * libm::sin(angle), -0.5 * libm::cos(angle))
    };
    revolved(&(0..=RINGS + 1).map(ring).collect::<Vec<_>>())
}

/// An upright cylinder of diameter and height 1.
pub(super) fn barrel() -> Surface {
    revolved(&[(0.0, -0.5), (0.5, -0.5), (0.5, 0.5), (0.0, 0.5)])
}

/// A surface around the z axis through these radii and heights, in rising order.
fn revolved(outline: &[(f64, f64)]) -> Surface {
    let mut surface = Surface::default();
    for (radius, height) in outline {
        for corner in 0..AROUND {
            let angle = TAU * f64::from(corner) / f64::from(AROUND);
            let (sin, cos) = libm::sincos(angle);
            surface.corners.push([radius * cos, radius * sin, *height]);
        }
    }
    for ring in 0..outline.len() as u32 - 1 {
        for corner in 0..AROUND {
            let next = (corner + 1) % AROUND;
            let [a, b] = [corner, next].map(|corner| ring * AROUND + corner);
            let [c, d] = [a + AROUND, b + AROUND];
            surface.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume inside a closed surface, by the divergence theorem.
    fn volume(surface: &Surface) -> f64 {
        let corner = |index: u32| surface.corners[index as usize];
        let of = |&[a, b, c]: &[u32; 3]| {
            let normal = cross(corner(b), corner(c));
            (0..3).map(|i| corner(a)[i] * normal[i]).sum::<f64>() / 6.0
        };
        surface.triangles.iter().map(of).sum()
    }

    #[test]
    fn round_bodies_are_closed_turned_outward_and_of_their_size() {
        // Of a circle the polygon has n/(2π) sin(2π/n): 0.9971 of its area at 48 corners.
        assert!((volume(&barrel()) / (PI / 4.0) - 0.9971).abs() < 1e-4, "{}", volume(&barrel()));
        let share = volume(&ball()) / (PI / 6.0);
        assert!((0.985..0.9971).contains(&share), "{share}");
    }

    #[test]
    fn a_quarter_turn_about_x_lays_a_cylinder_along_y() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let pose = Pose { position: [1.0, 2.0, 3.0], turn: [half, 0.0, 0.0, half] };
        let mut disc = Surface::default();
        disc.add(&barrel(), [2.0, 2.0, 0.1], pose);
        let span = |axis: usize| {
            let of = |fold: fn(f64, f64) -> f64, start| {
                disc.corners.iter().map(|corner| corner[axis]).fold(start, fold)
            };
            [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
        };
        for (axis, expected) in [[0.0, 2.0], [1.95, 2.05], [2.0, 4.0]].into_iter().enumerate() {
            for (found, wanted) in span(axis).into_iter().zip(expected) {
                // A few roundings of numbers of order one.
                assert!((found - wanted).abs() < 1e-14, "axis {axis}: {found}, not {wanted}");
            }
        }
    }
}
