//! The drawn messages of a frame: transforms, poses, scene and grains, in Foxglove's schemas.

use foxglove::Encode;
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{
    ArrowPrimitive, Color, CubePrimitive, CylinderPrimitive, FrameTransform, FrameTransforms,
    PackedElementField, Point3, PointCloud, Pose, PoseInFrame, Quaternion, SceneEntity,
    SceneUpdate, SpherePrimitive, Timestamp, TriangleListPrimitive, Vector3,
};
use prost::encoding::{WireType, encode_key, encode_varint};

use super::{BodyFrame, GrainSample, LogSetup, LoggedBody, LoggedShape};
use crate::math::{Quat, Vec3};

/// The frame that everything is drawn in: z up, surface of the undisturbed bed at z = 0.
pub(super) const WORLD: &str = "world";

/// What a grain in the cloud has, in order: an identifier behind 32-bit floats.
const GRAIN: [&str; 10] = ["x", "y", "z", "radius", "vx", "vy", "vz", "speed", "force", "id"];

/// Bytes of a number in the cloud.
const WIDTH: u32 = 4;

/// The messages of a frame, built once; a frame changes their numbers only.
pub(super) struct Scene {
    surface_z: f64,
    arrow_m_per_newton: f64,
    /// How far bodies reach from their positions (m).
    extents_m: Vec<f64>,
    transforms: FrameTransforms,
    poses: Vec<PoseInFrame>,
    update: SceneUpdate,
    cloud: PointCloud,
    points: Vec<u8>,
}

impl Scene {
    pub(super) fn new(setup: &LogSetup) -> Self {
        let transforms = setup.bodies.iter().map(|body| FrameTransform {
            parent_frame_id: WORLD.to_owned(),
            child_frame_id: body.name.clone(),
            ..Default::default()
        });
        let pose = PoseInFrame { frame_id: WORLD.to_owned(), ..Default::default() };
        let mut entities: Vec<_> = setup.bodies.iter().map(body_entity).collect();
        entities.extend(setup.container.map(|(low, high)| SceneEntity {
            frame_id: WORLD.to_owned(),
            id: "container".to_owned(),
            cubes: vec![CubePrimitive {
                pose: Some(Pose {
                    position: Some(shifted(&(0.5 * (low + high)), setup.surface_z_m)),
                    orientation: Some(UPRIGHT),
                }),
                size: Some(vector(&(high - low))),
                color: Some(Color { r: 0.5, g: 0.5, b: 0.5, a: 0.15 }),
            }],
            ..Default::default()
        }));
        // the last entity is the arrows', see `encode_update`
        entities.push(SceneEntity {
            frame_id: WORLD.to_owned(),
            id: "force".to_owned(),
            arrows: setup.bodies.iter().map(arrow).collect(),
            ..Default::default()
        });
        Self {
            surface_z: setup.surface_z_m,
            arrow_m_per_newton: setup.arrow_m_per_newton,
            extents_m: setup.bodies.iter().map(|body| body.shape.extent()).collect(),
            transforms: FrameTransforms { transforms: transforms.collect() },
            poses: vec![pose; setup.bodies.len()],
            update: SceneUpdate { deletions: Vec::new(), entities },
            cloud: cloud(),
            points: Vec::new(),
        }
    }

    /// A point of the engine in the frame of the log.
    pub(super) fn to_log(&self, point: &Vec3) -> Vec3 {
        Vec3::new(point.x, point.y, point.z - self.surface_z)
    }

    /// Moves everything to the present frame.
    pub(super) fn place(&mut self, log_time: u64, bodies: &[BodyFrame]) {
        let now = timestamp(log_time);
        for entity in &mut self.update.entities {
            entity.timestamp = Some(now);
        }
        let arrows = self.update.entities.last_mut().map(|force| &mut force.arrows);
        let arrows = arrows.into_iter().flatten();
        let bodies = bodies.iter().zip(&mut self.transforms.transforms).zip(&mut self.poses);
        for ((((body, transform), pose), arrow), extent) in bodies.zip(arrows).zip(&self.extents_m)
        {
            let position = shifted(&body.state.position, self.surface_z);
            let orientation = quaternion(&body.orientation);
            transform.timestamp = Some(now);
            transform.translation = Some(position);
            transform.rotation = Some(orientation);
            pose.timestamp = Some(now);
            pose.pose = Some(Pose { position: Some(position), orientation: Some(orientation) });
            // From where the body ends: inside it nothing would be seen of a small force.
            let force = body.force.norm();
            let start = if force > 0.0 { body.force * (extent / force) } else { Vec3::zeros() };
            arrow.pose = Some(Pose {
                position: Some(shifted(&(body.state.position + start), self.surface_z)),
                orientation: Some(from_x_axis_to(&body.force)),
            });
            arrow.shaft_length = force * self.arrow_m_per_newton;
        }
        self.cloud.timestamp = Some(now);
    }

    /// Packs one grain; `clear_grains` starts a frame.
    pub(super) fn push_grain(&mut self, grain: &GrainSample) {
        let GrainSample { position, radius, velocity: v, force, id } = grain;
        let p = self.to_log(position);
        for value in [p.x, p.y, p.z, *radius, v.x, v.y, v.z, v.norm(), *force] {
            self.points.extend_from_slice(&(value as f32).to_le_bytes());
        }
        self.points.extend_from_slice(&id.to_le_bytes());
    }

    pub(super) fn clear_grains(&mut self) {
        self.points.clear();
    }

    pub(super) fn encode_transforms(&self, buffer: &mut Vec<u8>) {
        encode(&self.transforms, buffer);
    }

    pub(super) fn encode_pose(&self, body: usize, buffer: &mut Vec<u8>) {
        encode(&self.poses[body], buffer);
    }

    /// The whole scene. Shapes are repeated in every frame: after a jump in time a viewer gets
    /// the last message of the topic alone, and a body drawn once would vanish.
    pub(super) fn encode_update(&self, buffer: &mut Vec<u8>) {
        encode(&self.update, buffer);
    }

    /// The grains packed since `clear_grains`.
    pub(super) fn encode_grains(&self, buffer: &mut Vec<u8>) {
        /// Field number of `PointCloud.data`, the last of the message.
        const DATA: u32 = 6;
        encode(&self.cloud, buffer);
        // appended by hand: through the message, the bytes would be copied twice more
        encode_key(DATA, WireType::LengthDelimited, buffer);
        encode_varint(self.points.len() as u64, buffer);
        buffer.extend_from_slice(&self.points);
    }
}

/// Encodes a Foxglove message into an emptied buffer.
pub(super) fn encode<M: Encode>(message: &M, buffer: &mut Vec<u8>) {
    buffer.clear();
    message.encode(buffer).expect("a growing buffer has room for every message");
}

/// A viewer's timestamp of a simulated time (ns).
pub(super) fn timestamp(log_time: u64) -> Timestamp {
    Timestamp::new((log_time / 1_000_000_000) as u32, (log_time % 1_000_000_000) as u32)
}

const UPRIGHT: Quaternion = Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };

fn body_entity(body: &LoggedBody) -> SceneEntity {
    let color = Some(Color { r: 0.35, g: 0.45, b: 0.6, a: 1.0 });
    let centred = Some(Pose { position: Some(Vector3::default()), orientation: Some(UPRIGHT) });
    let mut entity = SceneEntity {
        frame_id: body.name.clone(),
        id: body.name.clone(),
        frame_locked: true,
        ..Default::default()
    };
    match &body.shape {
        LoggedShape::Sphere { radius } => entity.spheres.push(SpherePrimitive {
            pose: centred,
            size: Some(vector(&Vec3::repeat(2.0 * radius))),
            color,
        }),
        LoggedShape::Disc { radius, thickness } => entity.cylinders.push(CylinderPrimitive {
            // a viewer's cylinder stands along z, a planar run's along y: a quarter turn about x
            pose: Some(Pose {
                position: Some(Vector3::default()),
                orientation: Some(Quaternion {
                    x: std::f64::consts::FRAC_1_SQRT_2,
                    y: 0.0,
                    z: 0.0,
                    w: std::f64::consts::FRAC_1_SQRT_2,
                }),
            }),
            size: Some(Vector3 { x: 2.0 * radius, y: 2.0 * radius, z: *thickness }),
            bottom_scale: 1.0,
            top_scale: 1.0,
            color,
        }),
        LoggedShape::Mesh { vertices, triangles } => {
            entity.triangles.push(TriangleListPrimitive {
                pose: centred,
                points: vertices.iter().map(|v| Point3 { x: v.x, y: v.y, z: v.z }).collect(),
                color,
                colors: Vec::new(),
                indices: triangles.iter().flatten().copied().collect(),
            });
        }
    }
    entity
}

/// An arrow whose head and width go with the size of its body.
fn arrow(body: &LoggedBody) -> ArrowPrimitive {
    let radius = body.shape.extent();
    ArrowPrimitive {
        pose: None,
        shaft_length: 0.0,
        shaft_diameter: 0.15 * radius,
        head_length: 0.3 * radius,
        head_diameter: 0.3 * radius,
        color: Some(Color { r: 0.9, g: 0.2, b: 0.1, a: 1.0 }),
    }
}

fn cloud() -> PointCloud {
    let fields = (0..).step_by(WIDTH as usize).zip(GRAIN).map(|(offset, name)| {
        let kind = if name == "id" { NumericType::Uint32 } else { NumericType::Float32 };
        PackedElementField { name: name.to_owned(), offset, r#type: kind as i32 }
    });
    PointCloud {
        frame_id: WORLD.to_owned(),
        pose: Some(Pose { position: Some(Vector3::default()), orientation: Some(UPRIGHT) }),
        point_stride: WIDTH * GRAIN.len() as u32,
        fields: fields.collect(),
        ..Default::default()
    }
}

fn vector(v: &Vec3) -> Vector3 {
    Vector3 { x: v.x, y: v.y, z: v.z }
}

/// A point of the engine in the frame of the log.
fn shifted(point: &Vec3, surface_z: f64) -> Vector3 {
    Vector3 { x: point.x, y: point.y, z: point.z - surface_z }
}

fn quaternion(q: &Quat) -> Quaternion {
    Quaternion { x: q.i, y: q.j, z: q.k, w: q.w }
}

/// The rotation that turns the x axis, along which viewers draw arrows, to `direction`.
///
/// By the half-way quaternion (1 + cos, x × d): square roots only, the same on every machine.
fn from_x_axis_to(direction: &Vec3) -> Quaternion {
    let length = direction.norm();
    if length == 0.0 {
        return UPRIGHT;
    }
    let d = direction / length;
    let (w, y, z) = (1.0 + d.x, -d.z, d.y);
    let norm = (w * w + y * y + z * z).sqrt();
    // straight back, the half-way is undefined: half a turn about z
    if norm < 1e-9 {
        return Quaternion { x: 0.0, y: 0.0, z: 1.0, w: 0.0 };
    }
    Quaternion { x: 0.0, y: y / norm, z: z / norm, w: w / norm }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_points_along_its_force_in_every_direction() {
        for direction in [
            Vec3::x(),
            -Vec3::x(),
            Vec3::y(),
            -Vec3::y(),
            Vec3::z(),
            -Vec3::z(),
            Vec3::new(-3.0, 2.0, -0.5),
        ] {
            let q = from_x_axis_to(&direction);
            let turned = Quat::from_quaternion([q.x, q.y, q.z, q.w].into()) * Vec3::x();
            // a handful of roundings on numbers of order one
            assert!((turned - direction.normalize()).norm() < 1e-15 * 10.0, "{direction}");
        }
    }
}
