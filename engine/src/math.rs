//! The vector types of the engine, and the only file that names nalgebra.
//!
//! The world frame is right-handed with z up. A planar (2D) run lives in the x–z plane: its
//! vectors have y = 0 and its spins point along y, so the vertical is z in every dimension.

/// A vector in the world frame (or a body frame where a doc says so).
pub type Vec3 = nalgebra::Vector3<f64>;

/// A rotation from a body frame to the world frame.
pub type Quat = nalgebra::UnitQuaternion<f64>;
