//! Fields of a bed as point clouds, which every viewer draws and colours by any of their fields.

use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{PackedElementField, PointCloud, Pose, Quaternion, Vector3};

use super::scene::{Scene, WORLD, timestamp};
use crate::coarse_graining::FieldPoint;
use crate::crater::CraterPoint;

/// Names of the values of a field point, in order.
const FIELD: [&str; 9] = [
    "x",
    "y",
    "z",
    "packing_fraction",
    "vx_m_per_s",
    "vy_m_per_s",
    "vz_m_per_s",
    "speed_m_per_s",
    "temperature_m2_per_s2",
];

/// Names of the values of a point of the surface, in order.
const CRATER: [&str; 4] = ["x", "y", "z", "distance_m"];

/// The fields of the bed at a time (ns); `None` if a value is not finite.
pub(super) fn field_cloud(
    log_time: u64,
    fields: &[FieldPoint],
    scene: &Scene,
) -> Option<PointCloud> {
    let rows = fields.iter().map(|at| {
        let (p, v) = (scene.to_log(&at.position), at.velocity);
        let scalars = [at.packing_fraction, v.x, v.y, v.z, v.norm(), at.temperature];
        let [a, b, c, d, e, f] = scalars;
        [p.x, p.y, p.z, a, b, c, d, e, f]
    });
    cloud(log_time, FIELD, rows)
}

/// The surface of the bed at a time (ns); `None` if a value is not finite.
pub(super) fn crater_cloud(
    log_time: u64,
    crater: &[CraterPoint],
    scene: &Scene,
) -> Option<PointCloud> {
    let rows = crater.iter().map(|at| {
        let p = scene.to_log(&at.position);
        [p.x, p.y, p.z, at.distance]
    });
    cloud(log_time, CRATER, rows)
}

/// Points with 32-bit floats of these names.
fn cloud<const N: usize>(
    log_time: u64,
    names: [&str; N],
    rows: impl Iterator<Item = [f64; N]>,
) -> Option<PointCloud> {
    let mut data = Vec::new();
    for value in rows.flatten() {
        if !value.is_finite() {
            return None;
        }
        data.extend_from_slice(&(value as f32).to_le_bytes());
    }
    let fields = (0..).step_by(4).zip(names).map(|(offset, name)| PackedElementField {
        name: name.to_owned(),
        offset,
        r#type: NumericType::Float32 as i32,
    });
    Some(PointCloud {
        timestamp: Some(timestamp(log_time)),
        frame_id: WORLD.to_owned(),
        pose: Some(Pose {
            position: Some(Vector3::default()),
            orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }),
        }),
        point_stride: 4 * N as u32,
        fields: fields.collect(),
        data: data.into(),
    })
}
