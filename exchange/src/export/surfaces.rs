//! The bodies of a log as closed surfaces: what it draws of them, at the places where they are.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use prost_reflect::{DynamicMessage, Value};

/// Corners around a round body.
const AROUND: u32 = 48;

/// Rings of a sphere between its poles.
const RINGS: u32 = 23;

/// A surface of triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// (m).
    pub(super) corners: Vec<[f64; 3]>,
    /// Indices of corners.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A place and a turn, from one frame to another.
#[derive(Clone, Copy, Debug)]
struct Pose {
    /// (m).
    position: [f64; 3],
    /// Unit quaternion x, y, z, w.
    turn: [f64; 4],
}

/// What is known of the bodies so far.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    /// Surfaces in the frames of their bodies, by name.
    shapes: BTreeMap<String, Surface>,
    /// Where these frames are.
    poses: BTreeMap<String, Pose>,
}

impl Bodies {
    /// Takes a message `foxglove.FrameTransforms`.
    pub(super) fn place(&mut self, transforms: &DynamicMessage) {
        for transform in items(transforms, "transforms") {
            let pose = Pose {
                position: vector(&transform, "translation"),
                turn: quaternion(&transform, "rotation"),
            };
            self.poses.insert(text(&transform, "child_frame_id"), pose);
        }
    }

    /// Takes a message `foxglove.SceneUpdate`: a body is what is drawn in a frame of its own name.
    pub(super) fn draw(&mut self, update: &DynamicMessage) {
        for entity in items(update, "entities") {
            let name = text(&entity, "id");
            if name != text(&entity, "frame_id") {
                continue;
            }
            let mut surface = Surface::default();
            for sphere in items(&entity, "spheres") {
                surface.add(&ball(), vector(&sphere, "size"), pose_of(&sphere));
            }
            for cylinder in items(&entity, "cylinders") {
                surface.add(&barrel(), vector(&cylinder, "size"), pose_of(&cylinder));
            }
            for mesh in items(&entity, "triangles") {
                surface.add(&of_triangles(&mesh), [1.0; 3], pose_of(&mesh));
            }
            self.shapes.insert(name, surface);
        }
    }

    /// The surface of every body whose place is known, in the frame of the log.
    pub(super) fn surfaces(&self) -> Vec<Surface> {
        let placed = self.shapes.iter().filter_map(|(name, shape)| {
            let mut surface = Surface::default();
            surface.add(shape, [1.0; 3], *self.poses.get(name)?);
            Some(surface)
        });
        placed.collect()
    }
}

impl Surface {
    /// Adds `other`, stretched by `size` along its axes and then put into `pose`.
    fn add(&mut self, other: &Self, size: [f64; 3], pose: Pose) {
        let first = self.corners.len() as u32;
        self.corners.extend(other.corners.iter().map(|corner| {
            let [x, y, z] = [0, 1, 2].map(|axis| size[axis] * corner[axis]);
            pose.apply([x, y, z])
        }));
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|i| first + i)));
    }
}

impl Pose {
    /// A point of the inner frame in the outer one: v + 2 w (q × v) + 2 q × (q × v), and the shift.
    fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        let [x, y, z, w] = self.turn;
        let q = [x, y, z];
        let once = cross(q, v);
        let twice = cross(q, once);
        [0, 1, 2].map(|i| self.position[i] + v[i] + 2.0 * (w * once[i] + twice[i]))
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A sphere of diameter 1.
fn ball() -> Surface {
    let ring = |ring: u32| {
        let angle = PI * f64::from(ring) / f64::from(RINGS + 1);
        (0.5 * libm::sin(angle), -0.5 * libm::cos(angle))
    };
    revolved(&(0..=RINGS + 1).map(ring).collect::<Vec<_>>())
}

/// An upright cylinder of diameter and height 1.
fn barrel() -> Surface {
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

fn of_triangles(mesh: &DynamicMessage) -> Surface {
    let corners = items(mesh, "points").map(|point| xyz(&point)).collect();
    let indices = mesh.get_field_by_name("indices");
    let indices = indices.as_deref().and_then(Value::as_list).unwrap_or_default();
    let indices: Vec<u32> = indices.iter().filter_map(Value::as_u32).collect();
    let (triangles, _) = indices.as_chunks();
    let mut surface = Surface { corners, triangles: triangles.to_vec() };
    let n = surface.corners.len() as u32;
    surface.triangles.retain(|corners| corners.iter().all(|corner| *corner < n));
    surface
}

fn pose_of(primitive: &DynamicMessage) -> Pose {
    match part(primitive, "pose") {
        Some(pose) => {
            Pose { position: vector(&pose, "position"), turn: quaternion(&pose, "orientation") }
        }
        None => Pose { position: [0.0; 3], turn: UPRIGHT },
    }
}

const UPRIGHT: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// The messages in the list `field` of `message`.
fn items(message: &DynamicMessage, field: &str) -> impl Iterator<Item = DynamicMessage> {
    let found = message.get_field_by_name(field).map(std::borrow::Cow::into_owned);
    let list = match found {
        Some(Value::List(list)) => list,
        _ => Vec::new(),
    };
    list.into_iter().filter_map(|item| item.as_message().cloned())
}

fn part(message: &DynamicMessage, field: &str) -> Option<DynamicMessage> {
    message.get_field_by_name(field)?.as_message().cloned()
}

fn text(message: &DynamicMessage, field: &str) -> String {
    let found = message.get_field_by_name(field);
    found.as_deref().and_then(Value::as_str).unwrap_or_default().to_owned()
}

fn number(message: &DynamicMessage, field: &str) -> f64 {
    message.get_field_by_name(field).as_deref().and_then(Value::as_f64).unwrap_or(0.0)
}

fn xyz(message: &DynamicMessage) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| number(message, axis))
}

fn vector(message: &DynamicMessage, field: &str) -> [f64; 3] {
    part(message, field).map_or([0.0; 3], |vector| xyz(&vector))
}

fn quaternion(message: &DynamicMessage, field: &str) -> [f64; 4] {
    part(message, field).map_or(UPRIGHT, |turn| ["x", "y", "z", "w"].map(|one| number(&turn, one)))
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
