//! The vector types of the engine; only this file and `lanes.rs` name nalgebra.
//!
//! The world frame is right-handed with z up. A planar (2D) run lives in the x–z plane: its
//! vectors have y = 0 and its spins point along y, so the vertical is z in every dimension.

/// A vector in the world frame (or a body frame where a doc says so).
pub type Vec3 = nalgebra::Vector3<f64>;

/// A column of four, one for each coordinate of an assembly.
pub type Vec4 = nalgebra::Vector4<f64>;

/// A square matrix over four coordinates.
pub type Mat4 = nalgebra::Matrix4<f64>;

/// A rotation from a body frame to the world frame.
pub type Quat = nalgebra::UnitQuaternion<f64>;

/// The rotation by about |`angle`| radians around `angle` (Cayley map: exact to second order,
/// symmetric in time, and free of functions whose bits depend on the system).
pub fn cayley(angle: Vec3) -> Quat {
    Quat::new_normalize(nalgebra::Quaternion::from_parts(1.0, angle * 0.5))
}

/// The rotation by `angle` (rad) about y, which takes z towards x.
pub fn turned_about_y(angle: f64) -> Quat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    Quat::new_unchecked(nalgebra::Quaternion::new(cos, 0.0, sin, 0.0))
}

/// Scalar and vector part of a rotation.
pub(crate) fn quat_parts(rotation: Quat) -> [f64; 4] {
    [rotation.w, rotation.i, rotation.j, rotation.k]
}

/// The rotation with these parts, which [`quat_parts`] gave: normalising again would change bits.
pub(crate) fn quat_from_parts([w, x, y, z]: [f64; 4]) -> Quat {
    Quat::new_unchecked(nalgebra::Quaternion::new(w, x, y, z))
}
