//! One impact to be run, or found in the cache.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use configs::{Condition, Model, StartX};
use engine::checkpoint::{self, CheckpointError};
use engine::simulation::Simulation;

use super::record::{Record, Recorder};
use crate::error::CampaignError;
use crate::hexadecimal;
use crate::run::{Control, bed_key, prepare, result_key};

/// Time between two looks at whether to stop while another process runs the same impact.
const WAIT: Duration = Duration::from_millis(50);

/// Counts the changes of what is kept of an impact.
const KEPT: u32 = 4;

/// Share of the grains in motion below which a bed lies still.
const STILL: f64 = 0.01;

/// One impact: a model of grains, with the speed, the angle and the place of its `[impact]`.
#[derive(Clone, Debug)]
pub struct Job {
    /// The model.
    pub model: Arc<Model>,
    /// The model whose bed it falls on: the same, or one that differs in what acts during the impact
    /// alone, so that both fall on the same grains.
    pub bed: Arc<Model>,
    /// How long it is expected to take, as simulated time (s).
    pub expected: f64,
    /// Whether it goes on until the bed lies still, as its crater is measured.
    pub settles: bool,
}

impl Job {
    /// The key of its bed.
    ///
    /// # Errors
    /// If the model is no bed of grains.
    pub(super) fn bed_key(&self) -> Result<[u8; 32], CampaignError> {
        let grains = self.bed.grains().ok_or_else(|| CampaignError::no_grains(&self.bed))?;
        Ok(bed_key(grains))
    }

    /// The key of its record: whatever the impact and its bed depend on, and the engine.
    pub(super) fn key(&self) -> Result<[u8; 32], CampaignError> {
        let bed = hexadecimal(&self.bed_key()?);
        let settled = if self.settles { " settled" } else { "" };
        Ok(result_key(&format!("impact {KEPT}{settled}\n{}\n{bed}", self.model.hash())))
    }

    /// Work that it takes (grain-steps), if it lasts as long as expected.
    pub fn work(&self) -> f64 {
        let grains = self.model.grains();
        let step = grains.and_then(|grains| Some((grains.n_grains(), grains.time_step().ok()?)));
        step.map_or(0.0, |(n, dt)| n as f64 * self.expected / dt)
    }

    /// Where its record is kept below `cache`.
    pub(super) fn path(cache: &Path, key: &[u8; 32]) -> PathBuf {
        cache.join("impacts").join(format!("{}.impact", hexadecimal(key)))
    }

    /// Prepares its bed in `cache`. `false` if it was stopped.
    pub(super) fn prepare_bed(
        &self,
        cache: &Path,
        signals: &mut dyn Control,
    ) -> Result<bool, CampaignError> {
        let grains = self.bed.grains().ok_or_else(|| CampaignError::no_grains(&self.bed))?;
        Ok(prepare(grains, cache, signals)?.is_some())
    }

    /// Runs it, on a bed that is found or made in `cache`. Nothing if it was stopped.
    fn run(
        &self,
        cache: &Path,
        signals: &mut dyn Control,
    ) -> Result<Option<Record>, CampaignError> {
        let grains = self.model.grains().ok_or_else(|| CampaignError::no_grains(&self.model))?;
        let of_bed = self.bed.grains().ok_or_else(|| CampaignError::no_grains(&self.bed))?;
        let Some(bed) = prepare(of_bed, cache, signals)? else { return Ok(None) };
        let start = Instant::now();
        let x = grains.medium.start.x.unwrap_or(0.5 * grains.medium.container.width);
        let configs::Impact { speed, angle_rad, .. } = self.model.impact;
        let condition = Condition { speed, angle_rad, position_index: 0, x: StartX::At(x) };
        let mut simulation = grains.simulation(&bed.resting, &condition)?;
        let is_pushed = self.model.impact.pushed_to.is_some();
        let mut recorder = Recorder::new(&simulation, is_pushed);
        recorder.observe(&simulation);
        let has_time = |now: &Simulation| now.clock().step < now.last_step();
        let settles =
            |now: &Simulation| self.settles && has_time(now) && now.bed().moving_share() > STILL;
        while !simulation.is_over() || settles(&simulation) {
            simulation.advance()?;
            recorder.observe(&simulation);
            if signals.wants_to_stop() {
                return Ok(None);
            }
        }
        let share = simulation.bed().moving_share();
        if self.settles && share > STILL {
            return Err(CampaignError::Moving { share, end: simulation.clock().time() });
        }
        Ok(Some(recorder.record(&simulation, start.elapsed().as_secs_f64())))
    }

    /// Its record, which `cache` has afterwards, and whether it was run for it now. Processes that want the same
    /// impact at the same time run it once. Nothing if it was stopped.
    pub(super) fn kept_or_run(
        &self,
        (cache, key): (&Path, &[u8; 32]),
        signals: &mut dyn Control,
    ) -> Result<Option<(Record, bool)>, CampaignError> {
        let lock_path = Self::path(cache, key).with_extension("lock");
        let Some(lock) = lock(&lock_path, signals)? else { return Ok(None) };
        let (record, is_new) = match Self::kept(cache, key) {
            Some(record) => (record, false),
            None => {
                let Some(record) = self.run(cache, signals)? else { return Ok(None) };
                Self::keep(cache, key, &record)?;
                (record, true)
            }
        };
        // A process that waits for this lock, or makes a new one, finds the record.
        drop(fs::remove_file(&lock_path));
        drop(lock);
        Ok(Some((record, is_new)))
    }

    /// Its record, if `cache` has it. A damaged one is as good as none.
    pub(super) fn kept(cache: &Path, key: &[u8; 32]) -> Option<Record> {
        checkpoint::load::<Record>(&Self::path(cache, key), key).ok()
    }

    /// Why its record is there and cannot be used.
    pub(super) fn damage(cache: &Path, key: &[u8; 32]) -> Option<CheckpointError> {
        let found = checkpoint::load::<Record>(&Self::path(cache, key), key);
        found.err().filter(|error| !error.is_missing())
    }

    /// Keeps `record` in `cache`, whole or not at all; its lock is held.
    fn keep(cache: &Path, key: &[u8; 32], record: &Record) -> Result<(), CampaignError> {
        let path = Self::path(cache, key);
        // What is there is damaged, and not worth keeping as the one before.
        let _ = fs::remove_file(&path);
        Ok(checkpoint::save(&path, key, record)?)
    }
}

/// Holds the lock at `path`, once it is free. Nothing if `heed` wants to stop before.
fn lock(path: &Path, signals: &dyn Control) -> Result<Option<File>, CampaignError> {
    let io = |action| move |source| CampaignError::Io { action, path: path.to_owned(), source };
    let file = File::create(path).map_err(io("make"))?;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::WouldBlock) if signals.wants_to_stop() => return Ok(None),
            Err(TryLockError::WouldBlock) => sleep(WAIT),
            Err(TryLockError::Error(source)) => return Err(io("lock")(source)),
        }
    }
}
