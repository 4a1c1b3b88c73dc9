//! The bodies of a log: what it draws of them, at the places where they are, and how they move.

use std::collections::BTreeMap;

use prost_reflect::{DynamicMessage, Value};

use super::beads::{self, Bead};
use super::surfaces::{Pose, Surface, UPRIGHT, ball, barrel, cross};

/// A body at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// Its name in the topics of the log.
    pub name: String,
    /// Centre of mass; z points up from the undisturbed surface (m).
    pub centre: [f64; 3],
    /// What it looks like.
    pub surface: Surface,
    /// Velocities of the corners of the surface (m/s).
    pub velocities: Vec<[f64; 3]>,
    /// What stands for it among particles.
    pub beads: Vec<MovingBead>,
}

/// A bead at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingBead {
    /// Centre (m).
    pub position: [f64; 3],
    /// Radius (m).
    pub radius: f64,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
}

/// A body in its own frame.
#[derive(Clone, Debug, Default)]
struct Shape {
    surface: Surface,
    beads: Vec<Bead>,
}

/// How a body moves.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Centre of mass (m).
    centre: [f64; 3],
    /// (m/s).
    velocity: [f64; 3],
    /// (rad/s).
    spin: [f64; 3],
}

/// What is known of the bodies so far.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    /// By name, in the frames of the bodies.
    shapes: BTreeMap<String, Shape>,
    /// Where these frames are.
    poses: BTreeMap<String, Pose>,
    motions: BTreeMap<String, Motion>,
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

    /// Takes a message `plunge.IntruderState` of the body `name`.
    pub(super) fn set_motion(&mut self, name: &str, state: &DynamicMessage) {
        let motion = Motion {
            centre: vector(state, "position"),
            velocity: vector(state, "velocity"),
            spin: vector(state, "spin"),
        };
        self.motions.insert(name.to_owned(), motion);
    }

    /// Takes a message `foxglove.SceneUpdate`: a body is what is drawn in a frame of its own name. The
    /// log repeats it in every frame, so a body that is known is passed over.
    pub(super) fn draw(&mut self, update: &DynamicMessage) {
        for entity in items(update, "entities") {
            let name = text(&entity, "id");
            if name == text(&entity, "frame_id") && !self.shapes.contains_key(&name) {
                self.shapes.insert(name, Shape::of(&entity));
            }
        }
    }

    /// Every body of which place and motion are known, in the frame of the log and in the order of
    /// their names.
    pub(super) fn placed(&self) -> Vec<Body> {
        let placed = self.shapes.iter().filter_map(|(name, shape)| {
            let (pose, motion) = (*self.poses.get(name)?, self.motions.get(name)?);
            let mut surface = Surface::default();
            surface.add(&shape.surface, [1.0; 3], pose);
            let velocities = surface.corners.iter().map(|corner| motion.at(*corner)).collect();
            let beads = shape.beads.iter().map(|bead| {
                let position = pose.apply(bead.centre);
                MovingBead { position, radius: bead.radius, velocity: motion.at(position) }
            });
            Some(Body {
                name: name.clone(),
                centre: motion.centre,
                beads: beads.collect(),
                surface,
                velocities,
            })
        });
        placed.collect()
    }
}

impl Shape {
    /// What `entity` draws. A sphere is one bead, and so is a cylinder, which a log draws for the disc of
    /// a planar run; other bodies are beads on their surfaces.
    fn of(entity: &DynamicMessage) -> Self {
        let mut shape = Self::default();
        for (round, outline) in [("spheres", ball()), ("cylinders", barrel())] {
            for primitive in items(entity, round) {
                let (size, pose) = (vector(&primitive, "size"), pose_of(&primitive));
                shape.surface.add(&outline, size, pose);
                shape.beads.push(Bead { centre: pose.position, radius: 0.5 * size[0] });
            }
        }
        for mesh in items(entity, "triangles") {
            let mut surface = Surface::default();
            surface.add(&of_triangles(&mesh), [1.0; 3], pose_of(&mesh));
            shape.beads.extend(beads::on(&surface));
            shape.surface.add(&surface, [1.0; 3], Pose::NONE);
        }
        shape
    }
}

impl Motion {
    /// Velocity (m/s) of the point of the body at `point` (m).
    fn at(&self, point: [f64; 3]) -> [f64; 3] {
        let arm = [0, 1, 2].map(|axis| point[axis] - self.centre[axis]);
        let turning = cross(self.spin, arm);
        [0, 1, 2].map(|axis| self.velocity[axis] + turning[axis])
    }
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
        None => Pose::NONE,
    }
}

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

    #[test]
    fn points_of_a_body_move_as_its_turning_pose_carries_them() {
        let (spin, time) = ([0.4, -0.9, 0.6], 1e-5);
        let rate = 1.33_f64.sqrt();
        let [x, y, z] = spin.map(|component| component / rate * libm::sin(0.5 * rate * time));
        let turned = [x, y, z, libm::cos(0.5 * rate * time)];
        let motion = Motion { centre: [1.0, 2.0, 3.0], velocity: [0.1, 0.2, -0.3], spin };
        let later = [0, 1, 2].map(|axis| motion.centre[axis] + time * motion.velocity[axis]);
        let corner = [0.3, -0.2, 0.5];
        let [before, after] = [(motion.centre, UPRIGHT), (later, turned)]
            .map(|(position, turn)| Pose { position, turn }.apply(corner));
        for (axis, expected) in motion.at(before).into_iter().enumerate() {
            let found = (after[axis] - before[axis]) / time;
            // Half of the acceleration over the time, below 1e-5, and roundings of 1e-16 over it.
            assert!((found - expected).abs() < 1e-5, "{axis}: {found}, not {expected}");
        }
    }
}
