//! One impact on a bed of grains: the loop that steps, logs, and writes checkpoints.

use std::time::Instant;

use configs::{Condition, Container, GrainModel};
use engine::body::RigidBody;
use engine::checkpoint;
use engine::error::StepError;
use engine::math::Vec3;
use engine::parallel::n_threads;
use engine::record::{
    BedChannels, BodyFrame, BodyLoad, BodySample, EventLevel, GrainSample, LogPosition, LogSetup,
    LoggedBody, RecordError, RunLog, Stamp,
};
use engine::simulation::{Simulation, Snapshot};
use serde::{Deserialize, Serialize};

use super::drawing::shape_of;
use super::folder::OutputFolder;
use super::intrusion::Push;
use super::log_texts::{arrow_m_per_newton, attachments, metadata, opening};
use super::model_file::model_text;
use super::observables::Observables;
use super::summary::near_the_floor;
use super::{
    BedSummary, Control, CostSummary, FinalEnergy, PreparedBed, Progress, RunError, Summary, Task,
    bed_key, result_key,
};

/// Steps between two looks at the control.
const LOOK_EVERY: u64 = 50;

/// Everything of one impact but the impact itself.
pub(super) struct Setting<'a> {
    pub(super) grains: GrainModel<'a>,
    pub(super) task: Task<'a>,
    pub(super) bed: &'a PreparedBed,
    pub(super) bed_summary: &'a BedSummary,
}

/// The state of a run on disk.
#[derive(Serialize, Deserialize)]
struct Saved {
    simulation: Snapshot,
    log: LogPosition,
    push: Option<Push>,
}

/// A run between two steps.
struct Run<'a> {
    simulation: Simulation,
    observables: Observables<'a>,
    push: Option<Push>,
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
        let start = FinalEnergy::held_by(&self.grains.simulation(&self.bed.resting, condition)?);
        let (clock, first_step) = (Instant::now(), run.simulation.clock().step);
        while !run.simulation.is_over() {
            run.advance()?;
            if run.simulation.clock().step.is_multiple_of(LOOK_EVERY) {
                control.progress(&self.progress(&run.simulation));
            }
            // After every step: of a large bed one alone may take a good part of a second.
            if control.wants_to_stop() {
                run.save()?;
                return Ok(None);
            }
        }
        let step = run.simulation.clock().step;
        let wall = clock.elapsed().as_secs_f64();
        let grain_steps = (step - first_step) as f64 * self.bed_summary.grains as f64;
        let cost = CostSummary {
            steps: step,
            dt_s: Some(run.simulation.clock().dt),
            threads: Some(n_threads()),
            wall_s: Some(wall),
            grain_steps_per_s: Some(if wall > 0.0 { grain_steps / wall } else { 0.0 }),
        };
        let mut summary = Summary::of_grains(
            self.grains,
            condition,
            &run.simulation,
            &start,
            (self.bed_summary, run.push.as_ref()),
            cost,
        );
        if let Some(warning) = self.floor_warning(&run.simulation) {
            control.warn(&warning);
            summary.bed.iter_mut().for_each(|bed| bed.warnings.push(warning.clone()));
        }
        run.log.finish()?;
        folder.write_json("summary.json", &summary)?;
        folder.tidy()?;
        Ok(Some(summary))
    }

    /// What to say where the floor may have stopped the intruder.
    fn floor_warning(&self, simulation: &Simulation) -> Option<String> {
        let grains = &simulation.bed().grains;
        let mean_diameter = grains.mean_diameter();
        let left = simulation.intruder().bodies().iter().map(|body| body.lowest());
        near_the_floor(left.fold(f64::INFINITY, f64::min), mean_diameter, 2.0 * self.drawn_radius())
    }

    /// Radius (m) of the intruder without the shaft of a recessive wall, which is not drawn.
    fn drawn_radius(&self) -> f64 {
        let GrainModel { model, medium } = self.grains;
        let shape = (model.intruder.shape.build)(&model.intruder.params, medium.space);
        shape.surface.bounding_radius()
    }

    fn progress(&self, simulation: &Simulation) -> Progress {
        let bodies = simulation.intruder().bodies();
        let lowest = bodies.iter().map(RigidBody::lowest).fold(f64::INFINITY, f64::min);
        Progress::Impact {
            index: self.task.of.0,
            of: self.task.of.1,
            step: simulation.clock().step,
            last_step: simulation.last_step(),
            time: simulation.clock().time(),
            depth: simulation.surface() - lowest,
            speed: bodies[0].velocity.norm(),
        }
    }

    /// The run at its last checkpoint, or at the start.
    fn open<'f>(
        &self,
        folder: &'f OutputFolder,
        condition: &Condition,
        control: &mut dyn Control,
    ) -> Result<Run<'f>, RunError>
    where
        Self: 'f,
    {
        let key = result_key(&model_text(self.grains.model));
        let mut simulation = self.grains.simulation(&self.bed.resting, condition)?;
        let setup = self.log_setup(&simulation, condition);
        let observables = Observables::new(self.grains, &simulation);
        let steps_per_frame = (1.0 / (self.grains.model.log.frames_per_s * simulation.clock().dt))
            .round()
            .max(1.0) as u64;
        let checkpoint_every = self.grains.medium.stepping.checkpoint_every;
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
        let run = |simulation, log, push| Run {
            simulation,
            observables,
            push,
            log,
            folder,
            key,
            steps_per_frame,
            checkpoint_every,
        };
        if let Some(Saved { simulation: snapshot, log, push }) = saved {
            match RunLog::resume(folder.path(), &setup, &log) {
                Ok(log) => {
                    if !simulation.restore(snapshot) {
                        return Err(RunError::Misfit { path });
                    }
                    return Ok(run(simulation, log, push));
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
        let push = Push::of(self.grains.model, condition);
        let mut run = run(simulation, log, push);
        run.log.event(run.stamp(), EventLevel::Info, &opening(self.grains.model, condition))?;
        run.record()?;
        Ok(run)
    }

    fn log_setup(&self, simulation: &Simulation, condition: &Condition) -> LogSetup {
        let GrainModel { model, medium } = self.grains;
        let bodies = simulation.intruder().bodies();
        let radius = self.drawn_radius();
        let weight = model.intruder.mass * medium.gravity;
        let Container { width, depth, .. } = medium.container;
        let top = simulation.surface() + 2.0 * radius;
        let mut metadata = metadata(model, condition);
        let bed_key = blake3::Hash::from_bytes(bed_key(self.grains));
        metadata.extend(
            [
                ("bed_key", bed_key.to_hex().to_string()),
                ("dt_s", simulation.clock().dt.to_string()),
                ("grains", self.bed_summary.grains.to_string()),
            ]
            .map(|(key, value)| (key.to_owned(), value)),
        );
        LogSetup {
            flush_every: medium.log.flush_every,
            checkpoint_every: medium.stepping.checkpoint_every,
            grains: medium.log.grains,
            bed: Some(match medium.log.fields_at.is_empty() {
                true => BedChannels::Scalars,
                false => BedChannels::ScalarsAndFields,
            }),
            surface_z_m: simulation.surface(),
            bodies: bodies
                .iter()
                .map(|body| LoggedBody {
                    name: body.name.clone(),
                    shape: shape_of(model.intruder.shape, &model.intruder.params, medium.space),
                })
                .collect(),
            container: Some((Vec3::zeros(), Vec3::new(width, depth, top))),
            energy_terms: simulation.ledger().terms().iter().map(|term| term.key()).collect(),
            force_origins: vec!["contact".to_owned(), "gravity".to_owned()],
            arrow_m_per_newton: arrow_m_per_newton(2.0 * radius, weight),
            metadata,
            attachments: attachments(&self.task),
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
        let stopped = self.stopping_times();
        if let Err(error) = self.simulation.advance() {
            return Err(self.give_up(error));
        }
        self.record()?;
        for (index, (before, now)) in stopped.into_iter().zip(self.stopping_times()).enumerate() {
            if let (None, Some(time)) = (before, now) {
                let text = self.stop_text(index, time);
                self.log.event(self.stamp(), EventLevel::Info, &text)?;
            }
        }
        if self.simulation.clock().step.is_multiple_of(self.checkpoint_every) {
            self.log.event(self.stamp(), EventLevel::Info, "checkpoint")?;
            self.save()?;
        }
        Ok(())
    }

    fn stopping_times(&self) -> Vec<Option<f64>> {
        let courses = self.simulation.courses().iter();
        courses.map(|course| course.stopping().stopping_time()).collect()
    }

    /// That body `index` stopped at `time` (s), by name where there are several.
    fn stop_text(&self, index: usize, time: f64) -> String {
        let depth = self.simulation.courses()[index].stopping().depth();
        let bodies = self.simulation.intruder().bodies();
        let who =
            if bodies.len() == 1 { String::new() } else { format!("{} ", bodies[index].name) };
        format!("{who}stopped after {time:.6} s, {depth:.6} m deep")
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
        let push = self.push.clone();
        let saved = Saved { simulation: self.simulation.save(), log: self.log.position(), push };
        checkpoint::save(&self.folder.file("checkpoint"), &self.key, &saved)?;
        Ok(())
    }

    fn record(&mut self) -> Result<(), RunError> {
        let at = self.stamp();
        let Self { simulation, observables, log, push, .. } = self;
        if let (Some(push), [body, ..]) = (push, simulation.intruder().bodies()) {
            let depth = simulation.surface() - body.lowest();
            push.see(depth, body.contact.force, body.contact.torque);
        }
        let balance = simulation.ledger().balance();
        log.energy(at, &balance.values, balance.unaccounted, simulation.closure())?;
        let footprints = simulation.bed().footprints();
        for (index, (body, footprint)) in
            simulation.intruder().bodies().iter().zip(footprints).enumerate()
        {
            log.body_state(at, index, &state_of(body, simulation.surface()))?;
            let load = BodyLoad {
                forces: &[body.contact.force, body.weight],
                torques: &[body.contact.torque, Vec3::zeros()],
                contacts: body.contact.contacts,
                area: footprint.covered_area,
            };
            log.body_load(at, index, &load)?;
        }
        observables.record(at, simulation, log)?;
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
                state: state_of(body, self.simulation.surface()),
                orientation: body.orientation,
                force: body.contact.force,
            })
            .collect();
        let mut samples = (0..grains.len()).map(|i| GrainSample {
            position: grains.position(i),
            radius: grains.radius(i),
            velocity: grains.velocity(i),
            force: (grains.force(i) - bed.gravity * grains.mass[i]).norm(),
            id: grains.id[i],
        });
        self.log.frame(at, &frames, &mut samples)?;
        Ok(())
    }
}

/// Where `body` is and how it moves, above a bed whose surface lies at `surface` (m).
fn state_of(body: &RigidBody, surface: f64) -> BodySample {
    BodySample {
        position: body.position,
        velocity: body.velocity,
        spin: body.spin(),
        depth_m: surface - body.lowest(),
    }
}
