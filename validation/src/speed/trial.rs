//! One trial: a problem stepped for a while, in a process of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Instant;

use configs::{LoadOptions, Loaded, Model, ModelSource};
use engine::parallel::with_threads;
use runner::run::{Control, Existing, Places, Progress, run};
use serde::{Deserialize, Serialize};

use runner::CampaignError;

use super::SpeedError;
use super::clock::{cpu_seconds, memory};

/// Which steps are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Steps before.
    pub warm_up: u64,
    /// Steps that are timed.
    pub steps: u64,
}

impl Span {
    /// The step at which it ends.
    pub fn end(&self) -> u64 {
        self.warm_up + self.steps
    }
}

/// What came of a trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Grains of the bed.
    pub grains: usize,
    /// Steps that were timed.
    pub steps: u64,
    /// Wall time of those steps (s).
    pub wall_s: f64,
    /// CPU time of those steps (s), on all threads or ranks together.
    pub cpu_s: f64,
    /// Largest memory of the process (byte), where it is known.
    pub peak_bytes: Option<u64>,
    /// Memory that the process holds after the steps (byte), where it is known.
    pub held_bytes: Option<u64>,
    /// Velocity of the intruder at the end (m/s), in the axes of plunge, where it is known.
    pub velocity_m_per_s: Option<[f64; 3]>,
}

impl Trial {
    /// Grains times steps (–).
    pub fn grain_steps(&self) -> f64 {
        self.grains as f64 * self.steps as f64
    }

    /// Grain-steps per second of CPU time (1/s).
    pub fn per_cpu_second(&self) -> f64 {
        self.grain_steps() / self.cpu_s
    }

    /// Grain-steps per second of wall time (1/s).
    pub fn per_wall_second(&self) -> f64 {
        self.grain_steps() / self.wall_s
    }
}

/// How much of a run is done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Steps alone, without the energy ledger.
    Forces,
    /// Steps alone.
    Steps,
    /// All that `plunge run` does, with its log and its summary in this folder.
    Run(PathBuf),
}

/// What is done in a trial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// The model of the problem.
    pub model: PathBuf,
    /// The steps.
    pub span: Span,
    /// On how many threads.
    pub threads: usize,
    /// How much of a run.
    pub extent: Extent,
}

impl Order {
    /// Carries it out, in a process of its own: memory starts from nothing, and no trial profits from
    /// another.
    ///
    /// # Errors
    /// If the process fails.
    pub fn in_a_process(&self) -> Result<Trial, SpeedError> {
        let (program, mut command) = self.command()?;
        let output = command.output().map_err(|source| SpeedError::Start { program, source })?;
        read(&output)
    }

    /// Carries it out in `n` processes at the same time.
    ///
    /// # Errors
    /// If one of them fails.
    pub fn in_processes(&self, n: usize) -> Result<Vec<Trial>, SpeedError> {
        let start = |_| {
            let (program, mut command) = self.command()?;
            command.spawn().map_err(|source| SpeedError::Start { program, source })
        };
        let children = (0..n).map(start).collect::<Result<Vec<_>, _>>()?;
        let finish = |child: std::process::Child| {
            let output = child.wait_with_output();
            read(&output.map_err(|source| SpeedError::Start { program: own(), source })?)
        };
        children.into_iter().map(finish).collect()
    }

    fn command(&self) -> Result<(PathBuf, Command), SpeedError> {
        let program = own();
        let mut command = Command::new(&program);
        command.arg("trial").arg(&self.model);
        for number in [self.span.warm_up, self.span.steps, self.threads as u64] {
            command.arg(number.to_string());
        }
        match &self.extent {
            Extent::Forces => command.arg("forces"),
            Extent::Steps => command.arg("steps"),
            Extent::Run(folder) => command.arg("run").arg(folder),
        };
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        Ok((program, command))
    }

    /// Carries it out in this process.
    ///
    /// # Errors
    /// If the problem cannot be read or run.
    pub fn here(&self) -> Result<Trial, SpeedError> {
        match &self.extent {
            Extent::Run(folder) => {
                with_threads(self.threads, || logged(self, folder)).map_err(CampaignError::from)?
            }
            Extent::Forces | Extent::Steps => {
                with_threads(self.threads, || bare(self)).map_err(CampaignError::from)?
            }
        }
    }
}

/// This program.
fn own() -> PathBuf {
    std::env::current_exe().unwrap_or_else(|_| "speed".into())
}

fn read(output: &Output) -> Result<Trial, SpeedError> {
    let failed = |what: String| SpeedError::Program {
        program: own(),
        what,
        said: String::from_utf8_lossy(&output.stderr).trim_end().to_owned(),
    };
    if !output.status.success() {
        return Err(failed(format!("ended with {}", output.status)));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(error.to_string()))
}

fn load(path: &Path, sets: Vec<String>) -> Result<Loaded, SpeedError> {
    let options = LoadOptions { sets, ..LoadOptions::default() };
    Ok(Model::load(ModelSource::Path(path.to_owned()), &options).map_err(CampaignError::from)?)
}

/// Steps alone, as a run takes them, without a log.
fn bare(order: &Order) -> Result<Trial, SpeedError> {
    let model = load(&order.model, Vec::new())?.model;
    let missing = || SpeedError::NoTable(order.model.clone());
    let grains = model.grains().ok_or_else(missing)?;
    let resting = grains.read_bed().ok_or_else(missing)?;
    let mut simulation =
        grains.simulation(&resting, &model.conditions()[0]).map_err(CampaignError::from)?;
    // A bed has a recipe as a rule: no table of grains is there while it is stepped.
    drop((resting, model));
    if order.extent == Extent::Forces {
        simulation = simulation.without_ledger();
    }
    for _ in 0..order.span.warm_up {
        simulation.advance().map_err(CampaignError::from)?;
    }
    let (wall, cpu) = (Instant::now(), cpu_seconds());
    for _ in 0..order.span.steps {
        simulation.advance().map_err(CampaignError::from)?;
    }
    let (wall_s, cpu_s) = (wall.elapsed().as_secs_f64(), cpu_seconds() - cpu);
    let velocity = simulation.intruder().bodies()[0].velocity.into();
    let memory = memory();
    Ok(Trial {
        grains: simulation.bed().grains.len(),
        steps: order.span.steps,
        wall_s,
        cpu_s,
        peak_bytes: memory.as_ref().map(|memory| memory.peak),
        held_bytes: memory.as_ref().map(|memory| memory.held),
        velocity_m_per_s: Some(velocity),
    })
}

/// A run with everything that it writes.
fn logged(order: &Order, folder: &Path) -> Result<Trial, SpeedError> {
    let missing = || SpeedError::NoTable(order.model.clone());
    let model = load(&order.model, Vec::new())?.model;
    let dt = model.grains().ok_or_else(missing)?.time_step().map_err(CampaignError::from)?;
    let duration = order.span.end() as f64 * dt;
    let loaded = load(&order.model, vec![format!("run.duration=\"{duration} s\"")])?;
    let n_grains = loaded.model.grains().ok_or_else(missing)?.n_grains();
    let places =
        Places { out: folder.to_owned(), cache: folder.join("cache"), existing: Existing::Replace };
    let mut laps = Laps { from: order.span.warm_up, ..Laps::default() };
    run(&loaded.model, &loaded.original, &places, &mut laps).map_err(CampaignError::from)?;
    let too_short = || SpeedError::TooShort { steps: order.span.steps };
    let (Some(first), Some(last)) = (laps.first, laps.last) else { return Err(too_short()) };
    let memory = memory();
    Ok(Trial {
        grains: n_grains as usize,
        steps: last.step - first.step,
        wall_s: last.wall.duration_since(first.wall).as_secs_f64(),
        cpu_s: last.cpu - first.cpu,
        peak_bytes: memory.as_ref().map(|memory| memory.peak),
        held_bytes: memory.as_ref().map(|memory| memory.held),
        velocity_m_per_s: None,
    })
}

/// When a run passed a step.
#[derive(Clone, Copy)]
struct Lap {
    step: u64,
    wall: Instant,
    cpu: f64,
}

/// The first and the last progress of a run after its warm-up.
#[derive(Default)]
struct Laps {
    from: u64,
    first: Option<Lap>,
    last: Option<Lap>,
}

impl Control for Laps {
    fn progress(&mut self, progress: &Progress) {
        if let Progress::Impact { step, .. } = *progress
            && step >= self.from
        {
            let lap = Lap { step, wall: Instant::now(), cpu: cpu_seconds() };
            self.first.get_or_insert(lap);
            self.last = Some(lap);
        }
    }

    fn warn(&mut self, _: &str) {}

    fn wants_to_stop(&self) -> bool {
        false
    }
}
