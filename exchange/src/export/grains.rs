//! The states of grains and bodies in a log, frame by frame.

use std::path::{Path, PathBuf};

use prost_reflect::{DynamicMessage, MessageDescriptor};

use super::bodies::{Bodies, Body, MovingBead};
use super::cloud::{Cloud, CloudReader};
use super::{ExportError, Exported};
use crate::Stop;
use crate::read::messages::{Receiver, Refusal, each_message};

/// All grains and bodies at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Frame {
    /// Which frame, from 0.
    pub(super) number: usize,
    /// Simulated time (s).
    pub(super) time: f64,
    pub(super) grains: Vec<Grain>,
    /// In the order of their names.
    pub(super) bodies: Vec<Body>,
}

/// A grain as the log has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grain {
    pub(super) id: u32,
    /// Centre; z points up from the undisturbed surface (m).
    pub(super) position: [f32; 3],
    /// (m).
    pub(super) radius: f32,
    /// (m/s).
    pub(super) velocity: [f32; 3],
    /// Magnitude of the velocity (m/s).
    pub(super) speed: f32,
    /// Magnitude of the sum of contact forces (N).
    pub(super) force: f32,
}

impl Frame {
    /// The grains and then the beads of every body, each with the number of its body: 0 for a grain.
    /// Beads are identified by the numbers behind those of the grains, and bear no force.
    pub(super) fn particles(&self) -> impl Iterator<Item = (usize, Grain)> {
        let behind = self.grains.iter().map(|grain| grain.id.wrapping_add(1)).max().unwrap_or(0);
        let beads = (1..).zip(&self.bodies);
        let beads =
            beads.flat_map(|(number, body)| body.beads.iter().map(move |bead| (number, bead)));
        let beads = (0..).zip(beads).map(move |(place, (number, bead)): (u32, _)| {
            let MovingBead { position, radius, velocity } = bead;
            let single = |vector: &[f64; 3]| vector.map(|x| x as f32);
            let speed = velocity.iter().map(|x| x * x).sum::<f64>().sqrt();
            let bead = Grain {
                id: behind.wrapping_add(place),
                position: single(position),
                radius: *radius as f32,
                velocity: single(velocity),
                speed: speed as f32,
                force: 0.0,
            };
            (number, bead)
        });
        self.grains.iter().map(|grain| (0, *grain)).chain(beads)
    }

    /// The least and the greatest coordinate of any particle along each axis (m).
    pub(super) fn bounds(&self) -> [[f32; 2]; 3] {
        let mut bounds = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
        for (_, Grain { position, radius, .. }) in self.particles() {
            for ([low, high], middle) in bounds.iter_mut().zip(position) {
                *low = low.min(middle - radius);
                *high = high.max(middle + radius);
            }
        }
        bounds
    }
}

/// What writes frames.
pub(super) trait FrameWriter {
    /// One more frame.
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError>;
    /// Completes what was written and says where it is.
    fn finish(self) -> Result<Vec<PathBuf>, ExportError>;
}

/// Hands every frame of the log at `path` to `writer`.
pub(super) fn export(
    path: &Path,
    writer: impl FrameWriter,
    stop: Stop<'_>,
) -> Result<Exported, ExportError> {
    let mut frames = Frames {
        writer,
        stop,
        frame: Frame::default(),
        bodies: Bodies::default(),
        n: 0,
        failed: None,
    };
    let read = each_message(path, &mut frames);
    if let Some(error) = frames.failed {
        return Err(error);
    }
    let complete = read?;
    if frames.n == 0 {
        return Err(ExportError::Nothing { path: path.to_owned(), what: "frame of grains" });
    }
    Ok(Exported { files: frames.writer.finish()?, complete })
}

struct Frames<'a, W> {
    writer: W,
    stop: Stop<'a>,
    /// Taken again for every frame.
    frame: Frame,
    /// Of the same frame: a log says where they are before it says where grains are.
    bodies: Bodies,
    n: usize,
    failed: Option<ExportError>,
}

/// What is read of a frame.
enum Topic {
    Grains(CloudReader),
    /// Where bodies are.
    Places(MessageDescriptor),
    /// What they look like.
    Shapes(MessageDescriptor),
    /// How the body of this name moves.
    Motion(String, MessageDescriptor),
}

impl Frame {
    /// Takes the grains of `cloud` in place of those that it has.
    fn take(&mut self, cloud: &Cloud) -> Result<(), String> {
        let [x, y, z] = ["x", "y", "z"].map(|name| cloud.column(name));
        let [vx, vy, vz] = ["vx", "vy", "vz"].map(|name| cloud.column(name));
        let [radius, speed, force] = ["radius", "speed", "force"].map(|name| cloud.column(name));
        let (position, velocity) = ([x?, y?, z?], [vx?, vy?, vz?]);
        let (radius, speed, force) = (radius?, speed?, force?);
        let id = cloud.column("id")?;
        self.time = cloud.time;
        self.grains.clear();
        self.grains.extend(cloud.points().map(|point| Grain {
            id: id.count(point),
            position: position.map(|column| column.quantity(point)),
            radius: radius.quantity(point),
            velocity: velocity.map(|column| column.quantity(point)),
            speed: speed.quantity(point),
            force: force.quantity(point),
        }));
        Ok(())
    }
}

impl<W: FrameWriter> Receiver for Frames<'_, W> {
    type Channel = Topic;

    fn introduce(
        &mut self,
        topic: &str,
        message: &MessageDescriptor,
    ) -> Result<Option<Topic>, String> {
        Ok(match topic {
            "/grains" => Some(Topic::Grains(CloudReader::of(message)?)),
            "/tf" => Some(Topic::Places(message.clone())),
            "/scene" => Some(Topic::Shapes(message.clone())),
            _ => {
                let body =
                    topic.strip_prefix("/intruder/").and_then(|of| of.strip_suffix("/state"));
                body.map(|name| Topic::Motion(name.to_owned(), message.clone()))
            }
        })
    }

    fn receive(&mut self, topic: &mut Topic, data: &[u8]) -> Result<(), Refusal> {
        if (self.stop)() {
            self.failed = Some(ExportError::Stopped);
            return Err(Refusal::Stop);
        }
        let decoded = |message: &MessageDescriptor| {
            DynamicMessage::decode(message.clone(), data)
                .map_err(|error| Refusal::Damaged(error.to_string()))
        };
        let reader = match topic {
            Topic::Grains(reader) => reader,
            Topic::Places(message) => {
                self.bodies.place(&decoded(message)?);
                return Ok(());
            }
            Topic::Shapes(message) => {
                self.bodies.draw(&decoded(message)?);
                return Ok(());
            }
            Topic::Motion(name, message) => {
                self.bodies.set_motion(name, &decoded(message)?);
                return Ok(());
            }
        };
        let cloud = reader.read(data).map_err(Refusal::Damaged)?;
        self.frame.take(&cloud).map_err(Refusal::Damaged)?;
        self.frame.bodies = self.bodies.placed();
        self.frame.number = self.n;
        self.n += 1;
        self.writer.frame(&self.frame).map_err(|error| {
            self.failed = Some(error);
            Refusal::Stop
        })
    }
}
