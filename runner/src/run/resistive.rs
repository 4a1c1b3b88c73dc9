//! One impact on a resistive medium: integrated at once, in milliseconds, and so without checkpoints.

use std::time::Instant;

use configs::{Condition, ResistiveModel};
use engine::ledger::Ledger;
use engine::math::{Quat, Vec3};
use engine::parallel::n_threads;
use engine::record::{
    BodyFrame, BodyLoad, BodySample, EventLevel, LogSetup, LoggedBody, RecordError, RunLog, Stamp,
};
use resistive::{Ending, Impact, Recorder, Sample};

use super::drawing::shape_of;
use super::folder::OutputFolder;
use super::intrusion::Push;
use super::log_texts::{arrow_m_per_newton, attachments, metadata, opening};
use super::summary::Watched;
use super::{Control, CostSummary, Progress, RunError, Summary, Task};

/// Origins of force in the log: of the terms that vary smoothly with the velocity, of the frictions.
const ORIGINS: [&str; 3] = ["dynamic", "static", "gravity"];

/// Samples of an impact on which its forces are compared.
const SAMPLES_OF_FORCE: f64 = 2000.0;

/// Runs the impact `condition`. Nothing if `control` wanted to stop before.
pub(super) fn run(
    resistive: ResistiveModel<'_>,
    task: Task<'_>,
    folder: &OutputFolder,
    condition: &Condition,
    control: &mut dyn Control,
) -> Result<Option<Summary>, RunError> {
    if control.wants_to_stop() {
        return Ok(None);
    }
    let clock = Instant::now();
    let impact = resistive.impact(condition);
    let interval = resistive.medium.log_interval;
    let terms = Recorder::new(&impact, interval, |_| {}).ledger().clone();
    let setup = log_setup(resistive, task, condition, &impact, &terms);
    let mut log = RunLog::create(folder.path(), &setup)?;
    let start = Stamp { step: 0, time_s: 0.0 };
    log.event(start, EventLevel::Info, &opening(resistive.model, condition))?;

    let scale = energy_scale(&impact);
    let frames_per_s = resistive.model.log.frames_per_s;
    let samples_per_frame = (1.0 / (frames_per_s * interval)).round().max(1.0) as u64;
    let mut writer = Writer { impact: &impact, log, samples_per_frame, scale, last: start };
    let mut failed = None;
    let mut recorder = Recorder::new(&impact, interval, |sample| {
        if failed.is_none() {
            failed = writer.write(sample).err();
        }
    });
    let ended = impact.run(resistive.model.time(condition), &mut recorder);
    let (ledger, given) = (recorder.ledger().clone(), *recorder.given());
    let given = &given[..impact.assembly().n_parts()];
    drop(recorder);
    if let Some(error) = failed {
        return Err(error.into());
    }
    let ending = match ended {
        Ok(ending) => ending,
        Err(error) => return Err(writer.give_up(error)),
    };
    // A drive puts in what the medium takes, however slow it is.
    let scale = scale + if impact.assembly().is_driven() { given.iter().sum::<f64>() } else { 0.0 };
    let (closure, limit) = (ledger.closure(scale), resistive.model.energy.abort_above);
    if closure > limit {
        return Err(writer.give_up(RunError::OpenBudget { closure, limit }));
    }
    let watched = watch(&impact, &ending, Push::of(resistive.model, condition))?;
    control.progress(&progress(task, &ending, &impact));
    writer.conclude(&ending)?;
    let cost = CostSummary {
        steps: ending.steps,
        dt_s: None,
        threads: Some(n_threads()),
        wall_s: Some(clock.elapsed().as_secs_f64()),
        grain_steps_per_s: None,
    };
    let ended = watched.end(&impact, ending, ledger, given);
    let summary = Summary::of_resistance(resistive, condition, &ended, scale, cost);
    folder.write_json("summary.json", &summary)?;
    folder.tidy()?;
    Ok(Some(summary))
}

/// The forces of an impact that ends as `ending` says, on samples of its own: what the summary says does
/// not hang on the interval of the log.
fn watch(impact: &Impact, ending: &Ending, push: Option<Push>) -> Result<Watched, RunError> {
    let mut watched = Watched::new(push);
    // A body that is held where it starts has no time to divide.
    let interval = if ending.time > 0.0 { ending.time / SAMPLES_OF_FORCE } else { 1.0 };
    let mut recorder = Recorder::new(impact, interval, |sample| watched.see(sample));
    impact.run(ending.time, &mut recorder)?;
    drop(recorder);
    Ok(watched)
}

/// Energy of the impact (J); of a body let go from rest, what it gains in falling its own size, and
/// without gravity, where nothing moves, one joule.
fn energy_scale(impact: &Impact) -> f64 {
    let (assembly, start) = (impact.assembly(), impact.start());
    let parts = 0..assembly.n_parts();
    let kinetic: f64 = parts.clone().flat_map(|part| assembly.kinetic_energy(part, start)).sum();
    let fall: f64 = parts
        .map(|part| {
            let (_, mass) = assembly.weight_at(part, start);
            mass * impact.bed().gravity * assembly.part(part, start).immersion.diameter
        })
        .sum();
    [kinetic, fall].into_iter().find(|energy| *energy > 0.0).unwrap_or(1.0)
}

fn progress(task: Task<'_>, ending: &Ending, impact: &Impact) -> Progress {
    Progress::Impact {
        index: task.of.0,
        of: task.of.1,
        step: ending.steps,
        last_step: ending.steps,
        time: ending.time,
        depth: ending.parts[0].depth,
        speed: impact.assembly().part(0, &ending.state).velocity.norm(),
    }
}

fn log_setup(
    resistive: ResistiveModel<'_>,
    task: Task<'_>,
    condition: &Condition,
    impact: &Impact,
    ledger: &Ledger,
) -> LogSetup {
    let intruder = &resistive.model.intruder;
    let n_parts = impact.assembly().n_parts();
    let wide = impact.assembly().part(0, impact.start()).immersion.diameter;
    let weight = intruder.mass * resistive.medium.gravity;
    let mut metadata = metadata(resistive.model, condition);
    metadata.insert("interval_s".to_owned(), resistive.medium.log_interval.to_string());
    LogSetup {
        flush_every: u64::MAX,
        checkpoint_every: u64::MAX,
        grains: false,
        bed: None,
        surface_z_m: 0.0,
        bodies: (0..n_parts)
            .map(|part| LoggedBody {
                name: match n_parts {
                    1 => intruder.name.clone(),
                    _ => format!("{}-{}", intruder.name, part + 1),
                },
                shape: shape_of(intruder.shape, &intruder.params, resistive.medium.space),
            })
            .collect(),
        container: None,
        energy_terms: ledger.terms().iter().map(|term| term.key()).collect(),
        force_origins: ORIGINS.map(str::to_owned).into(),
        arrow_m_per_newton: arrow_m_per_newton(wide, weight),
        metadata,
        attachments: attachments(&task),
    }
}

/// Writes the samples of one impact into its log.
struct Writer<'a> {
    impact: &'a Impact,
    log: RunLog,
    samples_per_frame: u64,
    /// What the closure is counted in (J).
    scale: f64,
    last: Stamp,
}

impl Writer<'_> {
    fn write(&mut self, sample: &Sample<'_>) -> Result<(), RecordError> {
        let at = Stamp { step: sample.number, time_s: sample.time };
        self.last = at;
        let balance = sample.ledger.balance();
        let closure = sample.ledger.closure(self.scale);
        self.log.energy(at, &balance.values, balance.unaccounted, closure)?;
        let mut frames = Vec::with_capacity(sample.parts.len());
        for (index, part) in sample.parts.iter().enumerate() {
            let (centre, turned) = self.impact.assembly().placement(index, sample.state);
            let spin = Vec3::new(0.0, part.part.spin, 0.0);
            let arm = part.part.point - centre;
            let state = BodySample {
                position: centre,
                velocity: part.part.velocity - spin.cross(&arm),
                spin,
                depth_m: part.part.immersion.depth,
            };
            self.log.body_state(at, index, &state)?;
            let (_, mass) = self.impact.assembly().weight_at(index, sample.state);
            let weight = Vec3::new(0.0, 0.0, -mass * self.impact.bed().gravity);
            let by_friction = arm.cross(&part.friction);
            let load = BodyLoad {
                forces: &[part.dynamic, part.friction, weight],
                torques: &[part.torque - by_friction, by_friction, Vec3::zeros()],
                contacts: 0,
                area: part.part.immersion.immersed_area,
            };
            self.log.body_load(at, index, &load)?;
            frames.push(BodyFrame {
                state,
                orientation: about_y(turned),
                force: part.dynamic + part.friction,
            });
        }
        if at.step.is_multiple_of(self.samples_per_frame) {
            self.log.frame(at, &frames, &mut std::iter::empty())?;
        }
        Ok(())
    }

    /// Completes the log.
    fn conclude(mut self, ending: &Ending) -> Result<(), RecordError> {
        if ending.stopped {
            let depth = ending.parts.iter().map(|part| part.depth).fold(0.0, f64::max);
            let text = format!("stopped after {:.6} s, {depth:.6} m deep", ending.time);
            self.log.event(self.last, EventLevel::Info, &text)?;
        }
        self.log.finish()
    }

    /// Leaves a readable log behind; what it cannot say any more is in the error.
    fn give_up(mut self, error: impl Into<RunError>) -> RunError {
        let error = error.into();
        let told = self.log.event(self.last, EventLevel::Error, &error.to_string());
        match told.and_then(|()| self.log.flush()) {
            Ok(()) => error,
            Err(second) => second.into(),
        }
    }
}

/// The rotation by `angle` (rad) about y.
fn about_y(angle: f64) -> Quat {
    let half = 0.5 * angle;
    Quat::from_quaternion([0.0, libm::sin(half), 0.0, libm::cos(half)].into())
}
