//! What a log is told: once, about the run, and then step by step.

use std::collections::{BTreeMap, BTreeSet};

use super::error::RecordError;
use super::schema::Layout;
use crate::math::{Quat, Vec3};

/// What a log needs to know of its run before the first message.
///
/// All positions given to the log, here and later, are those of the engine; the log shifts them
/// by `surface_z_m`, so that the undisturbed surface of the bed lies at z = 0 in it.
#[derive(Clone, Debug)]
pub struct LogSetup {
    /// Chunks of `run.mcap` end, and are brought to the disk, after the last message of every
    /// multiple of this (steps).
    pub flush_every: u64,
    /// Checkpoints are written at multiples of this (steps); both files are flushed there.
    /// `grains.mcap` is flushed at these only, since its chunks compress the better the longer
    /// they are. [`u64::MAX`] for a run without checkpoints.
    pub checkpoint_every: u64,
    /// Whether to write `grains.mcap`.
    pub grains: bool,
    /// What there is to say of a bed of grains; none of another medium.
    pub bed: Option<BedChannels>,
    /// Height of the undisturbed surface (m).
    pub surface_z_m: f64,
    /// The bodies, in the order in which the engine numbers them.
    pub bodies: Vec<LoggedBody>,
    /// Lowest and highest corner of the container (m), if it is to be drawn.
    pub container: Option<(Vec3, Vec3)>,
    /// Names of the energy terms, each a [`Term::key`](crate::ledger::Term::key).
    pub energy_terms: Vec<String>,
    /// Names of the origins of force on a body: `contact`, `gravity`, each added effect.
    pub force_origins: Vec<String>,
    /// Length of a drawn force (m/N).
    pub arrow_m_per_newton: f64,
    /// The metadata record `run`: seed, versions, hashes. Nothing that depends on the wall clock
    /// or on the number of threads. The closure identity and the scale of the arrows are added.
    pub metadata: BTreeMap<String, String>,
    /// Files carried in `run.mcap`.
    pub attachments: Vec<LogAttachment>,
}

/// The channels of a bed of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BedChannels {
    /// How much of it moves, and the collisional estimate of the force on each body.
    Scalars,
    /// The same, and its fields and its crater at some times.
    ScalarsAndFields,
}

/// A body of the log.
#[derive(Clone, Debug)]
pub struct LoggedBody {
    /// Its name: letters, digits, `-` and `_`; part of its topics.
    pub name: String,
    /// Its shape as drawn, in the body frame.
    pub shape: LoggedShape,
}

/// A shape as viewers draw it, about the origin of the body frame.
#[derive(Clone, Debug)]
pub enum LoggedShape {
    /// A sphere.
    Sphere {
        /// Radius (m).
        radius: f64,
    },
    /// The disc of a planar run, with its axis along y.
    Disc {
        /// Radius (m).
        radius: f64,
        /// Length along y, for the eye only (m).
        thickness: f64,
    },
    /// A closed surface of triangles.
    Mesh {
        /// Corners (m).
        vertices: Vec<Vec3>,
        /// Indices into `vertices`, counter-clockwise seen from outside.
        triangles: Vec<[u32; 3]>,
    },
}

impl LoggedShape {
    /// Largest distance from the origin of the body frame to the surface (m).
    pub(super) fn extent(&self) -> f64 {
        match self {
            Self::Sphere { radius } | Self::Disc { radius, .. } => *radius,
            Self::Mesh { vertices, .. } => vertices.iter().map(Vec3::norm).fold(0.0, f64::max),
        }
    }
}

/// A file carried in the log.
#[derive(Clone, Debug)]
pub struct LogAttachment {
    /// File name, as in `model.toml`.
    pub name: String,
    /// Media type, as in `application/toml`.
    pub media_type: String,
    /// The bytes.
    pub data: Vec<u8>,
}

/// The state of a body at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct BodySample {
    /// Centre of mass (m).
    pub position: Vec3,
    /// Its velocity (m/s).
    pub velocity: Vec3,
    /// Angular velocity in the world frame (rad/s).
    pub spin: Vec3,
    /// Depth of the lowest point below the undisturbed surface, positive downward (m).
    pub depth_m: f64,
}

/// The load on a body in a step, by origin in the order of [`LogSetup::force_origins`].
#[derive(Clone, Copy, Debug)]
pub struct BodyLoad<'a> {
    /// Forces (N).
    pub forces: &'a [Vec3],
    /// Torques about the centre of mass, in the world frame (N m).
    pub torques: &'a [Vec3],
    /// Number of touching grains and walls.
    pub contacts: u32,
    /// What the bed covers of the surface (m², planar m): in a bed of grains the sum of the
    /// cross-sections of the touching grains, in a resistive medium the immersed area.
    pub area: f64,
}

/// What the collisional estimate says of the load on a body.
#[derive(Clone, Copy, Debug)]
pub struct BodyEstimate {
    /// Area (m², planar m) that a body of this shape has below the undisturbed surface.
    pub geometric_area: f64,
    /// Estimated force (N).
    pub force: Vec3,
    /// Sum of the magnitudes of its parts (N).
    pub magnitudes: f64,
}

/// A body in a frame.
#[derive(Clone, Copy, Debug)]
pub struct BodyFrame {
    /// Where it is and how it moves.
    pub state: BodySample,
    /// Rotation from the body frame to the world frame.
    pub orientation: Quat,
    /// The force drawn as an arrow (N).
    pub force: Vec3,
}

/// A grain in a frame; the log keeps 32-bit floats.
#[derive(Clone, Copy, Debug)]
pub struct GrainSample {
    /// Centre (m).
    pub position: Vec3,
    /// Radius (m).
    pub radius: f64,
    /// Velocity of its centre (m/s).
    pub velocity: Vec3,
    /// Magnitude of its contact force (N).
    pub force: f64,
    /// Its identifier, the same in every frame.
    pub id: u32,
}

/// The weight of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventLevel {
    /// Something worth knowing: impact, rest, a checkpoint written.
    Info,
    /// The result may be affected.
    Warning,
    /// The run ended by it.
    Error,
}

impl LogSetup {
    /// Refuses names and intervals that cannot be logged.
    pub(super) fn check(&self, layouts: &[&Layout]) -> Result<(), RecordError> {
        if self.flush_every == 0 || self.checkpoint_every == 0 {
            return Err(RecordError::Setup("an interval of 0 steps".to_owned()));
        }
        for layout in layouts {
            if let Some(name) = layout.bad_name() {
                let schema = layout.name;
                return Err(RecordError::Setup(format!(
                    "{schema}: field `{name}` is used twice or is not made of a letter and then \
                     letters, digits and _"
                )));
            }
        }
        let mut seen = BTreeSet::new();
        for LoggedBody { name, .. } in &self.bodies {
            let legal = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
            if name.is_empty() || !legal || name == "world" || !seen.insert(name) {
                return Err(RecordError::Setup(format!(
                    "body `{name}`: names are letters, digits, - and _, each used once, \
                     and not `world`"
                )));
            }
        }
        Ok(())
    }
}
