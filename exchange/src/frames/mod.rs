//! The states of grains and bodies in a log, frame by frame.

mod beads;
mod bodies;
pub(crate) mod cloud;
mod grain;
mod joined;
mod surfaces;

use std::ops::ControlFlow;
use std::path::Path;

use engine::crater::crater;
use engine::grains::{Grains, Space};
use engine::math::Vec3;

use prost_reflect::{DynamicMessage, MessageDescriptor};

use crate::read::ReadError;
use crate::read::messages::{Receiver, Refusal, each_message};
use bodies::Bodies;
use cloud::{Cloud, CloudReader};
use joined::joined_to_the_lowest;

pub use engine::crater::CraterPoint;

pub use bodies::{Body, MovingBead};
pub use grain::Grain;
pub use surfaces::Surface;

/// All grains and bodies at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Which frame, from 0.
    pub number: usize,
    /// Simulated time (s).
    pub time: f64,
    /// The grains, in the order of the log.
    pub grains: Vec<Grain>,
    /// In the order of their names.
    pub bodies: Vec<Body>,
}

impl Frame {
    /// Whether all grains lie in one plane y = const, as those of a planar run do.
    pub fn is_planar(&self) -> bool {
        let y = |grain: &Grain| grain.position[1].to_bits();
        self.grains.windows(2).all(|pair| y(&pair[0]) == y(&pair[1]))
    }

    /// The mean surface of the bed around the vertical axis through `x`, `y` (m), in rings one mean diameter
    /// wide (planar: intervals to both sides). Of the bed are grains that a chain of contacts joins to its lowest.
    pub fn crater(&self, x: f64, y: f64) -> Vec<CraterPoint> {
        let space = if self.is_planar() { Space::Planar } else { Space::Spatial };
        let vector = |[x, y, z]: [f32; 3]| Vec3::new(f64::from(x), f64::from(y), f64::from(z));
        let grains: Vec<_> = self
            .grains
            .iter()
            .map(|grain| engine::grains::Grain {
                position: vector(grain.position),
                velocity: vector(grain.velocity),
                spin: Vec3::zeros(),
                radius: f64::from(grain.radius),
                // The surface does not depend on it.
                mass: 1.0,
                id: grain.id,
            })
            .collect();
        let lies = joined_to_the_lowest(&self.grains);
        match grains.is_empty() {
            true => Vec::new(),
            false => crater(&Grains::new(space, &grains), &lies, (x, y)),
        }
    }

    /// The grains and then the beads of every body, each with the number of its body: 0 for a grain.
    /// Beads are identified by the numbers behind those of the grains, and bear no force.
    pub(crate) fn particles(&self) -> impl Iterator<Item = (usize, Grain)> {
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
    pub(crate) fn bounds(&self) -> [[f32; 2]; 3] {
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

/// Hands every frame of the log of grains at `path` to `visit`, in order of time, until it breaks off; says
/// whether the log is finished and was read to its end. One frame is held at a time.
///
/// # Errors
/// The file system's refusal, a file that is no log of grains, or damage before its end.
pub fn each_frame(
    path: &Path,
    visit: impl FnMut(&Frame) -> ControlFlow<()>,
) -> Result<bool, ReadError> {
    let mut frames = Frames { visit, frame: Frame::default(), bodies: Bodies::default(), n: 0 };
    each_message(path, &mut frames)
}

struct Frames<V> {
    visit: V,
    /// Taken again for every frame.
    frame: Frame,
    /// Of the same frame: a log says where they are before it says where grains are.
    bodies: Bodies,
    n: usize,
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

impl<V: FnMut(&Frame) -> ControlFlow<()>> Receiver for Frames<V> {
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
        match (self.visit)(&self.frame) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Refusal::Stop),
        }
    }
}
