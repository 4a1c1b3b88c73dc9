//! One impact: the loop that steps, logs, and writes checkpoints.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Instant;

use engine::checkpoint;
use engine::error::StepError;
use engine::math::Vec3;
use engine::parallel::n_threads;
use engine::record::{
    BodyFrame, BodyLoad, BodySample, EventLevel, GrainSample, LogAttachment, LogPosition, LogSetup,
    LoggedBody, LoggedShape, RecordError, RunLog, Stamp,
};
use engine::simulation::{Simulation, Snapshot};
use serde::{Deserialize, Serialize};
use toml_edit::{DocumentMut, value};

use super::folder::OutputFolder;
use super::{
    BedSummary, Control, CostSummary, FinalEnergy, PreparedBed, Progress, RunError, Summary,
    bed_key, result_key,
};
use crate::load::{LoadOptions, ModelSource};
use crate::model::{BedSource, Condition, Model};

/// Steps between two looks at the control.
const LOOK_EVERY: u64 = 50;

/// Name of the table of grains in an output folder.
const GRAINS: &str = "grains.csv";

/// A force of this many weights of the intruder is drawn as long as the intruder is wide.
const WEIGHTS_PER_ARROW: f64 = 10.0;

/// `model.toml` of an output folder: the resolved model, its table of grains beside it.
pub(super) fn model_text(model: &Model) -> String {
    edited(model, |document| {
        if matches!(model.bed.source, BedSource::Csv(_)) {
            document["bed"]["file"] = value(GRAINS);
        }
    })
}

/// The table of grains of `model` as it was when the model was read; none if the bed settles.
///
/// It may lie in the output folder, so it is read before anything is written there.
pub(super) fn table_of(model: &Model) -> Result<Option<Vec<u8>>, RunError> {
    let BedSource::Csv(csv) = &model.bed.source else { return Ok(None) };
    let table = fs::read(&csv.file).map_err(|source| RunError::io("read", &csv.file, source))?;
    match blake3::hash(&table).to_hex().as_str() == csv.blake3 {
        true => Ok(Some(table)),
        false => Err(RunError::TableChanged { path: csv.file.clone() }),
    }
}

/// Writes `model.toml`, and the table of grains that it reads.
pub(super) fn write_model(
    folder: &OutputFolder,
    model: &Model,
    table: Option<&[u8]>,
) -> Result<(), RunError> {
    // The model first: a folder with a table but no model would not be known as ours.
    folder.write("model.toml", model_text(model).as_bytes())?;
    table.map_or(Ok(()), |table| folder.write(GRAINS, table))
}

fn edited(model: &Model, edit: impl FnOnce(&mut DocumentMut)) -> String {
    let mut document: DocumentMut =
        model.resolved_toml().parse().expect("the resolved model is TOML");
    edit(&mut document);
    document.to_string()
}

impl Model {
    /// This model with the single impact `condition`; `folder` holds its table of grains, if it has
    /// one.
    pub(super) fn single(&self, condition: &Condition, folder: &Path) -> Result<Self, RunError> {
        let text = edited(self, |document| {
            document.remove("conditions");
            let impact = &mut document["impact"];
            impact["speed"] = value(format!("{} m/s", condition.speed));
            impact["angle"] = value(format!("{} rad", condition.angle_rad));
            impact["x"] = value(format!("{} m", self.start_x(condition)));
            if matches!(self.bed.source, BedSource::Csv(_)) {
                document["bed"]["file"] = value(GRAINS);
            }
        });
        let source = ModelSource::Text {
            name: format!("one impact of {}", self.run.name),
            text,
            folder: folder.to_owned(),
        };
        Ok(Self::load(source, &LoadOptions::default())?.model)
    }
}

/// Everything of one impact but the impact itself.
pub(super) struct Setting<'a> {
    pub(super) model: &'a Model,
    /// The model file as its author wrote it.
    pub(super) original: &'a str,
    pub(super) bed: &'a PreparedBed,
    pub(super) bed_summary: &'a BedSummary,
    /// Which condition, of how many.
    pub(super) of: (usize, usize),
}

/// The state of a run on disk.
#[derive(Serialize, Deserialize)]
struct Saved {
    simulation: Snapshot,
    log: LogPosition,
}

/// A run between two steps.
struct Run<'a> {
    simulation: Simulation,
    log: RunLog,
    folder: &'a OutputFolder,
    key: [u8; 32],
    steps_per_frame: u64,
    checkpoint_every: u64,
}

impl Setting<'_> {
    /// Runs the impact, from its last checkpoint if there is one. Nothing if `control` wanted to stop.
    pub(super) fn run(
        &self,
        folder: &OutputFolder,
        condition: &Condition,
        control: &mut dyn Control,
    ) -> Result<Option<Summary>, RunError> {
        let mut run = self.open(folder, condition, control)?;
        // The ledger of a resumed run stands elsewhere, but its start is that of a new one.
        let start = FinalEnergy::held_by(&self.model.simulation(&self.bed.resting, condition)?);
        let (clock, first_step) = (Instant::now(), run.simulation.clock().step);
        while !run.simulation.is_over() {
            run.advance()?;
            if run.simulation.clock().step.is_multiple_of(LOOK_EVERY) {
                control.progress(&self.progress(&run.simulation));
                if control.wants_to_stop() {
                    run.save()?;
                    return Ok(None);
                }
            }
        }
        let step = run.simulation.clock().step;
        let wall = clock.elapsed().as_secs_f64();
        let grain_steps = (step - first_step) as f64 * self.bed_summary.grains as f64;
        let cost = CostSummary {
            steps: step,
            dt_s: run.simulation.clock().dt,
            threads: n_threads(),
            wall_s: wall,
            grain_steps_per_s: if wall > 0.0 { grain_steps / wall } else { 0.0 },
        };
        let summary =
            Summary::new(self.model, condition, &run.simulation, &start, self.bed_summary, cost);
        run.log.finish()?;
        folder.write_json("summary.json", &summary)?;
        folder.tidy()?;
        Ok(Some(summary))
    }

    fn progress(&self, simulation: &Simulation) -> Progress {
        let body = &simulation.intruder().bodies()[0];
        Progress::Impact {
            index: self.of.0,
            of: self.of.1,
            step: simulation.clock().step,
            last_step: simulation.last_step(),
            time: simulation.clock().time(),
            depth: simulation.surface() - body.lowest(),
            speed: body.velocity.norm(),
        }
    }

    /// The run at its last checkpoint, or at the start.
    fn open<'f>(
        &self,
        folder: &'f OutputFolder,
        condition: &Condition,
        control: &mut dyn Control,
    ) -> Result<Run<'f>, RunError> {
        let key = result_key(&model_text(self.model));
        let mut simulation = self.model.simulation(&self.bed.resting, condition)?;
        let setup = self.log_setup(&simulation, condition);
        let steps_per_frame =
            (1.0 / (self.model.log.frames_per_s * simulation.clock().dt)).round().max(1.0) as u64;
        let checkpoint_every = self.model.run.checkpoint_every;
        let path = folder.file("checkpoint");
        let saved = match checkpoint::load_latest::<Saved>(&path, &key) {
            Ok((saved, None)) => Some(saved),
            Ok((saved, Some(why))) => {
                control.warn(&format!("{why}; going on from the checkpoint before"));
                Some(saved)
            }
            Err(why) if why.is_missing() => None,
            Err(why) => {
                control.warn(&format!("{why}; starting again"));
                None
            }
        };
        if let Some(Saved { simulation: snapshot, log }) = saved {
            match RunLog::resume(folder.path(), &setup, &log) {
                Ok(log) => {
                    if !simulation.restore(snapshot) {
                        return Err(RunError::Misfit { path });
                    }
                    return Ok(Run {
                        simulation,
                        log,
                        folder,
                        key,
                        steps_per_frame,
                        checkpoint_every,
                    });
                }
                // What the log lacks can only be made again; a full disk is no reason to drop it.
                Err(
                    why @ (RecordError::Missing { .. }
                    | RecordError::Damaged { .. }
                    | RecordError::OtherRun { .. }),
                ) => control.warn(&format!("{why}; starting again")),
                Err(RecordError::Io { path, ref source, .. })
                    if source.kind() == std::io::ErrorKind::NotFound =>
                {
                    control.warn(&format!("{} is missing; starting again", path.display()));
                }
                Err(why) => return Err(why.into()),
            }
        }
        let log = RunLog::create(folder.path(), &setup)?;
        let mut run = Run { simulation, log, folder, key, steps_per_frame, checkpoint_every };
        let (speed, angle) = (condition.speed, condition.angle_deg());
        run.log.event(
            run.stamp(),
            EventLevel::Info,
            &format!("impact at {speed} m/s, {angle} deg from the horizontal"),
        )?;
        run.record()?;
        Ok(run)
    }

    fn log_setup(&self, simulation: &Simulation, condition: &Condition) -> LogSetup {
        let model = self.model;
        let bodies = simulation.intruder().bodies();
        let radius = bodies[0].surface().bounding_radius();
        let weight = model.intruder.mass * model.medium.gravity;
        let top = simulation.surface() + 2.0 * radius;
        let metadata = BTreeMap::from(
            [
                ("plunge_version", env!("CARGO_PKG_VERSION").to_owned()),
                ("name", model.run.name.clone()),
                ("model_hash", model.hash()),
                ("bed_key", blake3::Hash::from_bytes(bed_key(model)).to_hex().to_string()),
                ("seed", model.run.seed.to_string()),
                ("speed_m_per_s", condition.speed.to_string()),
                ("angle_deg", condition.angle_deg().to_string()),
                ("dt_s", simulation.clock().dt.to_string()),
                ("grains", self.bed_summary.grains.to_string()),
            ]
            .map(|(key, value)| (key.to_owned(), value)),
        );
        let attachment = |name: &str, text: String| LogAttachment {
            name: name.to_owned(),
            media_type: "application/toml".to_owned(),
            data: text.into_bytes(),
        };
        LogSetup {
            flush_every: model.log.flush_every,
            checkpoint_every: model.run.checkpoint_every,
            grains: model.log.grains,
            surface_z_m: simulation.surface(),
            bodies: bodies
                .iter()
                .map(|body| LoggedBody {
                    name: body.name.clone(),
                    shape: LoggedShape::Disc { radius, thickness: 0.2 * radius },
                })
                .collect(),
            container: Some((Vec3::zeros(), Vec3::new(model.container.width, 0.0, top))),
            energy_terms: simulation.ledger().terms().iter().map(|term| term.key()).collect(),
            force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
            arrow_m_per_newton: 2.0 * radius / (WEIGHTS_PER_ARROW * weight),
            metadata,
            attachments: vec![
                attachment("model.toml", self.original.to_owned()),
                attachment("model.resolved.toml", model_text(model)),
            ],
        }
    }
}

impl Run<'_> {
    fn stamp(&self) -> Stamp {
        let clock = self.simulation.clock();
        Stamp { step: clock.step, time_s: clock.time() }
    }

    /// One step, its messages, and a checkpoint where one is due.
    fn advance(&mut self) -> Result<(), RunError> {
        let stopped = self.simulation.stopping().stopping_time().is_some();
        if let Err(error) = self.simulation.advance() {
            return Err(self.give_up(error));
        }
        self.record()?;
        if let (false, Some(time)) = (stopped, self.simulation.stopping().stopping_time()) {
            let depth = self.simulation.stopping().depth();
            let text = format!("stopped after {time:.6} s, {depth:.6} m deep");
            self.log.event(self.stamp(), EventLevel::Info, &text)?;
        }
        if self.simulation.clock().step.is_multiple_of(self.checkpoint_every) {
            self.log.event(self.stamp(), EventLevel::Info, "checkpoint")?;
            self.save()?;
        }
        Ok(())
    }

    /// Leaves a readable log behind; what it cannot say any more is in the error.
    fn give_up(&mut self, error: StepError) -> RunError {
        let told = self.log.event(self.stamp(), EventLevel::Error, &error.to_string());
        match told.and_then(|()| self.log.flush()) {
            Ok(()) => error.into(),
            Err(second) => second.into(),
        }
    }

    fn save(&mut self) -> Result<(), RunError> {
        self.log.flush()?;
        let saved = Saved { simulation: self.simulation.save(), log: self.log.position() };
        checkpoint::save(&self.folder.file("checkpoint"), &self.key, &saved)?;
        Ok(())
    }

    fn record(&mut self) -> Result<(), RunError> {
        let at = self.stamp();
        let Self { simulation, log, .. } = self;
        let balance = simulation.ledger().balance();
        log.energy(at, &balance.values, balance.unaccounted, simulation.closure())?;
        for (index, body) in simulation.intruder().bodies().iter().enumerate() {
            let state = BodySample {
                position: body.position,
                velocity: body.velocity,
                spin: body.spin(),
                depth_m: simulation.surface() - body.lowest(),
            };
            log.body_state(at, index, &state)?;
            let load = BodyLoad {
                forces: &[body.contact.force, body.weight],
                torques: &[body.contact.torque, Vec3::zeros()],
                contacts: body.contact.contacts,
            };
            log.body_load(at, index, &load)?;
        }
        if at.step.is_multiple_of(self.steps_per_frame) {
            self.record_frame(at)?;
        }
        Ok(())
    }

    fn record_frame(&mut self, at: Stamp) -> Result<(), RunError> {
        let bed = self.simulation.bed();
        let grains = &bed.grains;
        let frames: Vec<BodyFrame> = self
            .simulation
            .intruder()
            .bodies()
            .iter()
            .map(|body| BodyFrame {
                position: body.position,
                orientation: body.orientation,
                force: body.contact.force,
            })
            .collect();
        let mut samples = (0..grains.len()).map(|i| GrainSample {
            position: grains.position[i],
            radius: grains.radius[i],
            speed: grains.velocity[i].norm(),
            force: (grains.load[i].force - bed.gravity * grains.mass[i]).norm(),
            id: grains.id[i],
        });
        self.log.frame(at, &frames, &mut samples)?;
        Ok(())
    }
}
