//! The states of grains and bodies in a log, frame by frame.

use std::path::{Path, PathBuf};

use prost_reflect::{DynamicMessage, FieldDescriptor, MessageDescriptor, Value};

use super::surfaces::{Bodies, Surface};
use super::{ExportError, Exported};
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
    pub(super) bodies: Vec<Surface>,
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
    pub(super) speed: f32,
    /// Magnitude of the sum of contact forces (N).
    pub(super) force: f32,
}

impl Frame {
    /// The least and the greatest coordinate of any grain along each axis (m).
    pub(super) fn bounds(&self) -> [[f32; 2]; 3] {
        [0, 1, 2].map(|axis| {
            let ends = |[low, high]: [f32; 2], grain: &Grain| {
                let (middle, radius) = (grain.position[axis], grain.radius);
                [low.min(middle - radius), high.max(middle + radius)]
            };
            self.grains.iter().fold([f32::INFINITY, f32::NEG_INFINITY], ends)
        })
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
pub(super) fn export(path: &Path, writer: impl FrameWriter) -> Result<Exported, ExportError> {
    let mut frames =
        Frames { writer, frame: Frame::default(), bodies: Bodies::default(), n: 0, failed: None };
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

struct Frames<W> {
    writer: W,
    /// Taken again for every frame.
    frame: Frame,
    /// Of the same frame: a log says where they are before it says where grains are.
    bodies: Bodies,
    n: usize,
    failed: Option<ExportError>,
}

/// What is read of a frame.
enum Topic {
    Grains(Cloud),
    /// Where bodies are.
    Places(MessageDescriptor),
    /// What they look like.
    Shapes(MessageDescriptor),
}

/// Where a point cloud has what we read of it.
struct Cloud {
    message: MessageDescriptor,
    timestamp: FieldDescriptor,
    stride: FieldDescriptor,
    fields: FieldDescriptor,
    data: FieldDescriptor,
}

impl Cloud {
    fn of(message: &MessageDescriptor) -> Result<Self, String> {
        let field = |name: &str| {
            let found = message.get_field_by_name(name);
            found.ok_or_else(|| format!("{} has no field `{name}`", message.full_name()))
        };
        Ok(Self {
            timestamp: field("timestamp")?,
            stride: field("point_stride")?,
            fields: field("fields")?,
            data: field("data")?,
            message: message.clone(),
        })
    }

    fn read(&self, data: &[u8], into: &mut Frame) -> Result<(), String> {
        let message =
            DynamicMessage::decode(self.message.clone(), data).map_err(|e| e.to_string())?;
        into.time = seconds(message.get_field(&self.timestamp).as_ref());
        let stride = message.get_field(&self.stride).as_u32().unwrap_or(0) as usize;
        let fields = message.get_field(&self.fields);
        let offset = |name: &str| {
            let named = |field: &&Value| text_of(field, "name").as_deref() == Some(name);
            let found = fields.as_list().unwrap_or(&[]).iter().find(named);
            let at = found.and_then(|field| number_of(field, "offset"));
            at.filter(|at| at + WIDTH <= stride)
                .ok_or_else(|| format!("its points have no `{name}`"))
        };
        let names = ["x", "y", "z", "radius", "speed", "force"];
        let mut places = [0; 6];
        for (place, name) in places.iter_mut().zip(names) {
            *place = offset(name)?;
        }
        let id = offset("id")?;
        let points = message.get_field(&self.data);
        let points = points.as_bytes().ok_or("its points are no bytes")?;
        into.grains.clear();
        into.grains.extend(points.chunks_exact(stride).map(|point| {
            let word = |at: usize| [point[at], point[at + 1], point[at + 2], point[at + 3]];
            let [x, y, z, radius, speed, force] = places.map(|at| f32::from_le_bytes(word(at)));
            let id = u32::from_le_bytes(word(id));
            Grain { id, position: [x, y, z], radius, speed, force }
        }));
        Ok(())
    }
}

/// Bytes of a number in a point cloud of ours.
const WIDTH: usize = 4;

/// A timestamp of a log (s).
fn seconds(timestamp: &Value) -> f64 {
    let part = |name: &str| number_of(timestamp, name).unwrap_or(0) as f64;
    part("seconds") + 1e-9 * part("nanos")
}

fn number_of(message: &Value, field: &str) -> Option<usize> {
    match message.as_message()?.get_field_by_name(field)?.as_ref() {
        Value::U32(number) => Some(*number as usize),
        Value::I32(number) => usize::try_from(*number).ok(),
        Value::I64(number) => usize::try_from(*number).ok(),
        _ => None,
    }
}

fn text_of(message: &Value, field: &str) -> Option<String> {
    message.as_message()?.get_field_by_name(field)?.as_str().map(str::to_owned)
}

impl<W: FrameWriter> Receiver for Frames<W> {
    type Channel = Topic;

    fn introduce(
        &mut self,
        topic: &str,
        message: &MessageDescriptor,
    ) -> Result<Option<Topic>, String> {
        Ok(match topic {
            "/grains" => Some(Topic::Grains(Cloud::of(message)?)),
            "/tf" => Some(Topic::Places(message.clone())),
            "/scene" => Some(Topic::Shapes(message.clone())),
            _ => None,
        })
    }

    fn receive(&mut self, topic: &mut Topic, data: &[u8]) -> Result<(), Refusal> {
        let decoded = |message: &MessageDescriptor| {
            DynamicMessage::decode(message.clone(), data)
                .map_err(|error| Refusal::Damaged(error.to_string()))
        };
        let cloud = match topic {
            Topic::Grains(cloud) => cloud,
            Topic::Places(message) => {
                self.bodies.place(&decoded(message)?);
                return Ok(());
            }
            Topic::Shapes(message) => {
                self.bodies.draw(&decoded(message)?);
                return Ok(());
            }
        };
        cloud.read(data, &mut self.frame).map_err(Refusal::Damaged)?;
        self.frame.bodies = self.bodies.surfaces();
        self.frame.number = self.n;
        self.n += 1;
        self.writer.frame(&self.frame).map_err(|error| {
            self.failed = Some(error);
            Refusal::Stop
        })
    }
}
