//! The log of a run, in MCAP.
//!
//! Two files on one clock: `run.mcap` has the energy budget, state and load of every body at every
//! step, events, and the drawn frames; `grains.mcap` has the grains of every frame, with frames and
//! states of bodies of its own so that it opens alone. Messages are protobuf and carry their descriptors. Topics and
//! field names are stable: renaming one is a breaking change.
//!
//! The bytes depend on the calls alone. Log time is simulated time, the sequence number of a
//! message is its step, and chunks end by size or by step number, never by wall time. A log is
//! called `….partial` until [`RunLog::finish`]; a killed one is readable up to its last whole
//! chunk. [`RunLog::resume`] copies it up to a checkpoint and goes on, and the finished file is
//! byte for byte that of a run never interrupted.

pub mod chunk;
mod error;
mod file;
mod imported;
mod points;
mod resume;
mod scene;
mod schema;
mod setup;
#[cfg(test)]
mod tests;
mod values;

use std::borrow::Cow;
use std::fs::File;
use std::path::{Path, PathBuf};

use foxglove::Encode;
use foxglove::messages::log::Level;
use foxglove::messages::{FrameTransforms, Log, PointCloud, PoseInFrame, SceneUpdate};
use mcap::records::Metadata;
use serde::{Deserialize, Serialize};

use crate::coarse_graining::FieldPoint;
use crate::crater::CraterPoint;
use file::{Cut, Definition, LogFile};
use scene::Scene;
use schema::{Fields, Layout, Layouts};
use values::{encode_loads, encode_state, finite, finite_state};

pub use error::RecordError;
pub use file::Stamp;
pub use setup::{
    BedChannels, BodyEstimate, BodyFrame, BodyLoad, BodySample, EventLevel, GrainSample,
    LogAttachment, LogSetup, LoggedBody, LoggedShape,
};

/// The file of scalars, events and frames.
pub const RUN_LOG: &str = "run.mcap";

/// The file of grains.
pub const GRAIN_LOG: &str = "grains.mcap";

/// How far a log has come; part of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogPosition {
    /// The last step with a message.
    pub step: u64,
    /// Messages in `run.mcap`.
    pub run_messages: u64,
    /// Messages in `grains.mcap`.
    pub grain_messages: u64,
}

/// The log of a run being written.
///
/// Steps must not decrease from call to call. After an error the file concerned is closed as it
/// is and every further call on it fails. Dropped without [`finish`](Self::finish), the files
/// keep their partial names.
pub struct RunLog {
    dir: PathBuf,
    run: LogFile,
    grains: Option<LogFile>,
    ids: RunChannels,
    grain_ids: GrainChannels,
    n_origins: usize,
    energy_terms: Vec<String>,
    bodies: Vec<String>,
    scene: Scene,
    /// The message being encoded.
    buffer: Vec<u8>,
}

struct RunChannels {
    energy: u16,
    states: Vec<u16>,
    loads: Vec<u16>,
    bed: Option<BedIds>,
    frames: FrameChannels,
    events: u16,
}

struct BedIds {
    activity: u16,
    estimates: Vec<u16>,
    /// Fields and crater.
    fields: Option<[u16; 2]>,
}

struct FrameChannels {
    transforms: u16,
    scene: u16,
    poses: Vec<u16>,
}

#[derive(Default)]
struct GrainChannels {
    grains: u16,
    states: Vec<u16>,
    frames: Option<FrameChannels>,
}

impl RunLog {
    /// Starts the log of a run in `dir`, over any partial log that is there.
    ///
    /// # Errors
    /// A setup that cannot be logged, or the file system's refusal.
    pub fn create(dir: &Path, setup: &LogSetup) -> Result<Self, RecordError> {
        Self::open(
            dir,
            setup,
            Layouts::of(&setup.energy_terms, &setup.force_origins),
            |[_, partial, _]| partial,
        )
    }

    /// Goes on with an interrupted log from the position kept in a checkpoint.
    ///
    /// The messages up to there are copied into a file beside the old one, which is replaced at
    /// the next flush: until then the old one can be resumed again.
    ///
    /// # Errors
    /// The old log does not reach the position ([`RecordError::Missing`]), is damaged before it,
    /// or is of another setup; or as [`create`](Self::create).
    pub fn resume(
        dir: &Path,
        setup: &LogSetup,
        position: &LogPosition,
    ) -> Result<Self, RecordError> {
        let mut log = Self::open(
            dir,
            setup,
            Layouts::of(&setup.energy_terms, &setup.force_origins),
            |[_, _, new]| new,
        )?;
        let LogPosition { step, run_messages, grain_messages } = *position;
        let copy = |name, file: &mut LogFile, needed| {
            let names = LogFile::names(dir, name);
            resume::copy_messages(resume::source(&names), file, needed, step)
        };
        copy(RUN_LOG, &mut log.run, run_messages)?;
        if let Some(grains) = &mut log.grains {
            copy(GRAIN_LOG, grains, grain_messages)?;
        }
        Ok(log)
    }

    /// How far the log has come. Take it, for a checkpoint, after the last message of the step
    /// and after [`flush`](Self::flush).
    pub fn position(&self) -> LogPosition {
        let grains = self.grains.as_ref();
        LogPosition {
            step: self.run.last_step().max(grains.and_then(LogFile::last_step)).unwrap_or(0),
            run_messages: self.run.messages(),
            grain_messages: grains.map_or(0, LogFile::messages),
        }
    }

    /// Writes the energy budget of a step.
    ///
    /// `values` (J) are in the order of [`LogSetup::energy_terms`]; `closure` is the largest
    /// energy unaccounted for so far over the initial energy of the intruder.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If there is not one value per term.
    pub fn energy(
        &mut self,
        at: Stamp,
        values: &[f64],
        unaccounted_j: f64,
        closure: f64,
    ) -> Result<(), RecordError> {
        assert_eq!(values.len(), self.energy_terms.len(), "one value per energy term");
        finite(at, || "unaccounted_J".to_owned(), &[unaccounted_j])?;
        finite(at, || "closure".to_owned(), &[closure])?;
        for (value, term) in values.iter().zip(&self.energy_terms) {
            finite(at, || term.clone(), &[*value])?;
        }
        let mut fields = Fields::begin(&mut self.buffer, at.step, at.time_s);
        fields.number(unaccounted_j);
        fields.number(closure);
        for &value in values {
            fields.number(value);
        }
        self.run.write(self.ids.energy, at.encode()?, &self.buffer)
    }

    /// Writes the state of a body after a step.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    pub fn body_state(
        &mut self,
        at: Stamp,
        body: usize,
        sample: &BodySample,
    ) -> Result<(), RecordError> {
        finite_state(at, &self.bodies[body], sample)?;
        encode_state(at, sample, &self.scene, &mut self.buffer);
        self.run.write(self.ids.states[body], at.encode()?, &self.buffer)
    }

    /// Writes the load on a body in a step.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If there is not one force and one torque per origin.
    pub fn body_load(
        &mut self,
        at: Stamp,
        body: usize,
        load: &BodyLoad<'_>,
    ) -> Result<(), RecordError> {
        let BodyLoad { forces, torques, contacts, area } = *load;
        assert!(
            forces.len() == self.n_origins && torques.len() == self.n_origins,
            "one force and one torque per origin"
        );
        let name = &self.bodies[body];
        finite(at, || format!("area of {name}"), &[area])?;
        let mut fields = Fields::begin(&mut self.buffer, at.step, at.time_s);
        fields.count(contacts);
        fields.number(area);
        encode_loads(at, name, &mut fields, forces.iter().zip(torques))?;
        self.run.write(self.ids.loads[body], at.encode()?, &self.buffer)
    }

    /// Writes what the collisional estimate says of a body in a step.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If the setup has no bed.
    pub fn body_estimate(
        &mut self,
        at: Stamp,
        body: usize,
        estimate: &BodyEstimate,
    ) -> Result<(), RecordError> {
        let BodyEstimate { geometric_area, force, magnitudes } = estimate;
        let name = &self.bodies[body];
        finite(at, || format!("estimated force on {name}"), force.as_slice())?;
        finite(at, || format!("estimate for {name}"), &[*geometric_area, *magnitudes])?;
        let id = self.ids.bed().estimates[body];
        let mut fields = Fields::begin(&mut self.buffer, at.step, at.time_s);
        fields.number(*geometric_area);
        fields.number(*magnitudes);
        fields.vector(force);
        self.run.write(id, at.encode()?, &self.buffer)
    }

    /// Writes the share of the grains that move (–) after a step.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If the setup has no bed.
    pub fn bed_activity(&mut self, at: Stamp, moving_share: f64) -> Result<(), RecordError> {
        finite(at, || "moving_share".to_owned(), &[moving_share])?;
        let id = self.ids.bed().activity;
        Fields::begin(&mut self.buffer, at.step, at.time_s).number(moving_share);
        self.run.write(id, at.encode()?, &self.buffer)
    }

    /// Writes the fields of the bed and the profile of its surface after a step.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If the setup has no bed with fields.
    pub fn bed_fields(
        &mut self,
        at: Stamp,
        fields: &[FieldPoint],
        crater: &[CraterPoint],
    ) -> Result<(), RecordError> {
        let ids = self.ids.bed().fields.expect("the setup has fields");
        let stamp = at.encode()?;
        for (id, message) in ids.into_iter().zip([
            points::field_cloud(stamp.1, fields, &self.scene),
            points::crater_cloud(stamp.1, crater, &self.scene),
        ]) {
            let message = message.ok_or_else(|| RecordError::NonFinite {
                step: at.step,
                what: "a field of the bed".to_owned(),
            })?;
            scene::encode(&message, &mut self.buffer);
            self.run.write(id, stamp, &self.buffer)?;
        }
        Ok(())
    }

    /// Writes a frame: every body, in the order of the setup, and the grains if they are logged.
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If there is not one `BodyFrame` per body.
    pub fn frame(
        &mut self,
        at: Stamp,
        bodies: &[BodyFrame],
        grains: &mut dyn Iterator<Item = GrainSample>,
    ) -> Result<(), RecordError> {
        assert_eq!(bodies.len(), self.bodies.len(), "one frame per body");
        for (BodyFrame { state, orientation, force }, name) in bodies.iter().zip(&self.bodies) {
            finite_state(at, name, state)?;
            finite(at, || format!("orientation of {name}"), orientation.coords.as_slice())?;
            finite(at, || format!("force on {name}"), force.as_slice())?;
        }
        let stamp = at.encode()?;
        self.scene.place(stamp.1, bodies);
        if let (Some(file), Some(frames)) = (&mut self.grains, &self.grain_ids.frames) {
            self.scene.clear_grains();
            for grain in grains {
                let GrainSample { position: p, velocity: v, radius, force, id } = grain;
                let values = [p.x, p.y, p.z, v.x, v.y, v.z, radius, force];
                finite(at, || format!("grain {id}"), &values)?;
                self.scene.push_grain(&grain);
            }
            write_frame(file, frames, &self.scene, stamp, &mut self.buffer)?;
            for (body, &id) in bodies.iter().zip(&self.grain_ids.states) {
                encode_state(at, &body.state, &self.scene, &mut self.buffer);
                file.write(id, stamp, &self.buffer)?;
            }
            self.scene.encode_grains(&mut self.buffer);
            file.write(self.grain_ids.grains, stamp, &self.buffer)?;
        }
        write_frame(&mut self.run, &self.ids.frames, &self.scene, stamp, &mut self.buffer)
    }

    /// Writes an event.
    pub fn event(&mut self, at: Stamp, level: EventLevel, text: &str) -> Result<(), RecordError> {
        let stamp = at.encode()?;
        let level = match level {
            EventLevel::Info => Level::Info,
            EventLevel::Warning => Level::Warning,
            EventLevel::Error => Level::Error,
        };
        let log = Log {
            timestamp: Some(scene::timestamp(stamp.1)),
            level: level as i32,
            message: text.to_owned(),
            name: "plunge".to_owned(),
            ..Default::default()
        };
        scene::encode(&log, &mut self.buffer);
        self.run.write(self.ids.events, stamp, &self.buffer)
    }

    /// Ends the chunks of both files and brings them to the disk, as before a checkpoint.
    ///
    /// Chunk ends are part of the bytes: call it after the last message of a multiple of
    /// [`LogSetup::checkpoint_every`], or at any step if the process then leaves and the run is
    /// later resumed, since resuming cuts the chunks anew.
    pub fn flush(&mut self) -> Result<(), RecordError> {
        self.run.flush()?;
        self.grains.as_mut().map_or(Ok(()), LogFile::flush)
    }

    /// Completes both files and gives them their final names, `run.mcap` last.
    ///
    /// # Errors
    /// The file system's refusal; the partial files then stay.
    pub fn finish(mut self) -> Result<(), RecordError> {
        let Self { run, grains, .. } = &mut self;
        run.close()?;
        if let Some(grains) = grains {
            grains.close()?;
            grains.publish()?;
        }
        run.publish()?;
        sync_folder(&self.dir)
    }

    fn open(
        dir: &Path,
        setup: &LogSetup,
        Layouts { budget, load, closure_identity }: Layouts,
        working: fn([PathBuf; 3]) -> PathBuf,
    ) -> Result<Self, RecordError> {
        let state = Layout::intruder_state();
        let (estimate, activity) = (Layout::estimate(), Layout::bed_activity());
        setup.check(&[&budget, &state, &load, &estimate, &activity])?;

        let LogSetup { flush_every, checkpoint_every, .. } = *setup;
        let start = |name, cut| {
            let working = working(LogFile::names(dir, name));
            let mut file = LogFile::create(dir, name, &working, cut)?;
            file.with(|writer| writer.write_metadata(&metadata(setup, closure_identity.as_ref())))?;
            Ok(file)
        };
        let cut = Cut { every: vec![flush_every, checkpoint_every], chunk_bytes: 1 << 20 };
        let mut run = start(RUN_LOG, cut)?;
        for LogAttachment { name, media_type, data } in &setup.attachments {
            let attachment = mcap::Attachment {
                log_time: 0,
                create_time: 0,
                name: name.clone(),
                media_type: media_type.clone(),
                data: Cow::Borrowed(data),
            };
            run.with(|writer| writer.attach(&attachment))?;
        }
        let layouts = [&budget, &state, &load, &estimate, &activity];
        let ids = RunChannels::define(&mut run, setup, layouts)?;
        let mut grain_ids = GrainChannels::default();
        let mut grains = None;
        if setup.grains {
            let cut = Cut { every: vec![checkpoint_every], chunk_bytes: 4 << 20 };
            let mut file = start(GRAIN_LOG, cut)?;
            grain_ids.grains = file.define(drawn::<PointCloud>("/grains"))?;
            grain_ids.states = define_states(&mut file, setup, &state)?;
            grain_ids.frames = Some(define_frames(&mut file, setup)?);
            grains = Some(file);
        }
        Ok(Self {
            dir: dir.to_owned(),
            run,
            grains,
            ids,
            grain_ids,
            n_origins: setup.force_origins.len(),
            energy_terms: setup.energy_terms.clone(),
            bodies: setup.bodies.iter().map(|body| body.name.clone()).collect(),
            scene: Scene::new(setup),
            buffer: Vec::new(),
        })
    }
}

impl RunChannels {
    /// The channels of `run`, whose own messages are laid out so.
    fn define(
        run: &mut LogFile,
        setup: &LogSetup,
        [budget, state, load, estimate, activity]: [&Layout; 5],
    ) -> Result<Self, RecordError> {
        let of_bed = |run: &mut LogFile, channels| {
            Ok(BedIds {
                activity: run.define(own("/bed/activity", activity))?,
                estimates: per_body(setup, |name| {
                    run.define(own(&format!("/intruder/{name}/estimate"), estimate))
                })?,
                fields: match channels {
                    BedChannels::Scalars => None,
                    BedChannels::ScalarsAndFields => Some([
                        run.define(drawn::<PointCloud>("/bed/field"))?,
                        run.define(drawn::<PointCloud>("/bed/crater"))?,
                    ]),
                },
            })
        };
        Ok(Self {
            energy: run.define(own("/energy/budget", budget))?,
            states: define_states(run, setup, state)?,
            loads: per_body(setup, |name| {
                run.define(own(&format!("/intruder/{name}/load"), load))
            })?,
            bed: setup.bed.map(|channels| of_bed(run, channels)).transpose()?,
            frames: define_frames(run, setup)?,
            events: run.define(drawn::<Log>("/log"))?,
        })
    }

    fn bed(&self) -> &BedIds {
        self.bed.as_ref().expect("the setup has a bed")
    }
}

/// The metadata record `run`.
fn metadata(setup: &LogSetup, closure_identity: Option<&String>) -> Metadata {
    let mut metadata = setup.metadata.clone();
    let identity = closure_identity.map(|text| ("closure_identity".to_owned(), text.clone()));
    metadata.extend(identity);
    metadata.insert("arrow_m_per_newton".to_owned(), setup.arrow_m_per_newton.to_string());
    Metadata { name: "run".to_owned(), metadata }
}

fn own(topic: &str, layout: &Layout) -> Definition {
    Definition {
        topic: topic.to_owned(),
        schema: layout.name.to_owned(),
        descriptor: layout.descriptor_set(),
    }
}

fn drawn<M: Encode>(topic: &str) -> Definition {
    let schema = M::get_schema().expect("every Foxglove message has a schema");
    Definition {
        topic: topic.to_owned(),
        schema: schema.name,
        descriptor: schema.data.into_owned(),
    }
}

fn per_body(
    setup: &LogSetup,
    mut define: impl FnMut(&str) -> Result<u16, RecordError>,
) -> Result<Vec<u16>, RecordError> {
    setup.bodies.iter().map(|body| define(&body.name)).collect()
}

fn define_states(
    file: &mut LogFile,
    setup: &LogSetup,
    state: &Layout,
) -> Result<Vec<u16>, RecordError> {
    per_body(setup, |name| file.define(own(&format!("/intruder/{name}/state"), state)))
}

fn define_frames(file: &mut LogFile, setup: &LogSetup) -> Result<FrameChannels, RecordError> {
    Ok(FrameChannels {
        transforms: file.define(drawn::<FrameTransforms>("/tf"))?,
        scene: file.define(drawn::<SceneUpdate>("/scene"))?,
        poses: per_body(setup, |name| {
            file.define(drawn::<PoseInFrame>(&format!("/intruder/{name}/pose")))
        })?,
    })
}

/// Writes what both files have of a frame: where the bodies are.
fn write_frame(
    file: &mut LogFile,
    ids: &FrameChannels,
    scene: &Scene,
    stamp: (u32, u64),
    buffer: &mut Vec<u8>,
) -> Result<(), RecordError> {
    scene.encode_transforms(buffer);
    file.write(ids.transforms, stamp, buffer)?;
    for (body, &id) in ids.poses.iter().enumerate() {
        scene.encode_pose(body, buffer);
        file.write(id, stamp, buffer)?;
    }
    scene.encode_update(buffer);
    file.write(ids.scene, stamp, buffer)
}

/// Brings renamed files to the disk, where folders can be synced.
fn sync_folder(dir: &Path) -> Result<(), RecordError> {
    if cfg!(unix) {
        let sync = File::open(dir).and_then(|folder| folder.sync_all());
        sync.map_err(|e| RecordError::io(dir, "sync", e))?;
    }
    Ok(())
}
