//! Prepared beds, kept under a key of everything they depend on.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use configs::{BedSource, GrainModel};
use engine::bed::{SavedSettling, Settling};
use engine::checkpoint::{self, with_suffix};
use engine::grain_bed::RestingBed;

use super::{Control, Progress, RunError, result_key};

/// Steps between two messages of progress while a bed settles.
const LOOK_EVERY: u64 = 100;

/// Steps between two checkpoints of a settling bed.
const SAVE_EVERY: u64 = 20_000;

/// A bed that has not come to rest in this many times the fall through its own height never will.
const PATIENCE: f64 = 60.0;

/// Overlap of two grains of a table, in radii of the smaller, that no bed at rest has.
const DEEPEST_IN_TABLE: f64 = 0.1;

/// Time between two looks at the control while another run prepares the bed.
const WAIT: Duration = Duration::from_millis(50);

/// A bed and where it came from: `"hit"`, `"miss"` (prepared now) or `"file"` (read from a table).
pub struct PreparedBed {
    /// The bed.
    pub resting: RestingBed,
    /// Where it came from.
    pub cache: &'static str,
    /// The file in the cache.
    pub path: Option<PathBuf>,
}

/// The key of the bed of `model`.
pub fn bed_key(model: GrainModel<'_>) -> [u8; 32] {
    result_key(model.bed_key_text())
}

/// Where the bed of `key` lies in the cache below `folder`.
pub fn bed_file(folder: &Path, key: &[u8; 32]) -> PathBuf {
    folder.join("beds").join(format!("{}.bed", blake3::Hash::from_bytes(*key).to_hex()))
}

/// The bed of `model`: read from its table, or from the cache below `folder`, or prepared now and put
/// there. Nothing if `control` wants to stop.
///
/// # Errors
/// If it cannot be prepared or stored.
pub fn prepare(
    model: GrainModel<'_>,
    folder: &Path,
    control: &mut dyn Control,
) -> Result<Option<PreparedBed>, RunError> {
    if let Some(resting) = model.read_bed() {
        refuse_overlaps(model, &resting)?;
        return Ok(Some(PreparedBed { resting, cache: "file", path: None }));
    }
    let key = bed_key(model);
    let (beds, path) = (folder.join("beds"), bed_file(folder, &key));
    match checkpoint::load::<RestingBed>(&path, &key) {
        Ok(resting) if !resting.is_sound(model.n_grains()) => {
            control.warn(&format!("{} is not this bed; it is prepared again", path.display()));
        }
        Ok(resting) => return Ok(Some(PreparedBed { resting, cache: "hit", path: Some(path) })),
        Err(error) if error.is_missing() => {}
        Err(error) => control.warn(&format!("{error}; the bed is prepared again")),
    }
    fs::create_dir_all(&beds)
        .map_err(|source| RunError::Folder { folder: beds.clone(), source })?;
    // Runs that need the same bed at the same time prepare it once.
    let lock_path = with_suffix(&path, ".lock");
    let Some(lock) = lock(&lock_path, control)? else { return Ok(None) };
    if let Ok(resting) = checkpoint::load(&path, &key) {
        return Ok(Some(PreparedBed { resting, cache: "hit", path: Some(path) }));
    }
    let unfinished = with_suffix(&path, ".settling");
    let Some(resting) = settle(model, &unfinished, &key, control)? else { return Ok(None) };
    // What is there is damaged, and not worth keeping as the one before.
    let _ = fs::remove_file(&path);
    checkpoint::save(&path, &key, &resting)?;
    for leftover in [with_suffix(&unfinished, ".prev"), unfinished] {
        let _ = fs::remove_file(leftover);
    }
    // Whoever waits for this lock, or makes a new one, finds the bed.
    let _ = fs::remove_file(&lock_path);
    drop(lock);
    Ok(Some(PreparedBed { resting, cache: "miss", path: Some(path) }))
}

/// Refuses a table whose grains lie in each other: its first step would throw them apart.
fn refuse_overlaps(model: GrainModel<'_>, resting: &RestingBed) -> Result<(), RunError> {
    let BedSource::Csv(table) = &model.medium.bed.source else { return Ok(()) };
    let bed = model.bed(resting);
    match bed.pair_deeper_than(DEEPEST_IN_TABLE) {
        // The identity of a grain of a table is its place in it; line 1 is the header.
        Some((grains, overlap)) => Err(RunError::TableOverlaps {
            table: table.file.clone(),
            lines: grains.map(|grain| grain + 2),
            overlap,
        }),
        None => Ok(()),
    }
}

/// The bed of `model`, settled now, from the checkpoint `unfinished` if there is one. Nothing if
/// `control` wants to stop.
fn settle(
    model: GrainModel<'_>,
    unfinished: &Path,
    key: &[u8; 32],
    control: &mut dyn Control,
) -> Result<Option<RestingBed>, RunError> {
    let mut settling = recipe(model)?;
    let height = settling.bed().grains.positions().fold(0.0_f64, |top, x| top.max(x.z));
    let patience = PATIENCE * (2.0 * height / model.medium.gravity).sqrt();
    if let Ok((saved, _)) = checkpoint::load_latest::<SavedSettling>(unfinished, key)
        && !settling.restore(saved)
    {
        settling = recipe(model)?;
    }
    while !settling.is_at_rest() {
        settling.advance().map_err(|source| RunError::Settling { source })?;
        let clock = settling.clock();
        if settling.time_since_tap() > patience {
            let restlessness = settling.restlessness();
            return Err(RunError::Restless { time: clock.time(), restlessness });
        }
        if clock.step.is_multiple_of(SAVE_EVERY) {
            checkpoint::save(unfinished, key, &settling.save())?;
        }
        if clock.step.is_multiple_of(LOOK_EVERY) {
            control.progress(&Progress::Settling {
                step: clock.step,
                time: clock.time(),
                restlessness: settling.restlessness(),
            });
        }
        // After every step: of a large bed one alone may take a good part of a second.
        if control.wants_to_stop() {
            checkpoint::save(unfinished, key, &settling.save())?;
            return Ok(None);
        }
    }
    Ok(Some(settling.bed().resting()))
}

fn recipe(model: GrainModel<'_>) -> Result<Settling, RunError> {
    match model.settling()? {
        Some(settling) => Ok(settling),
        None => unreachable!("a bed is read from a table or settles"),
    }
}

/// Holds the lock at `path`, once it is free. Nothing if `control` wants to stop before.
fn lock(path: &Path, control: &dyn Control) -> Result<Option<File>, RunError> {
    let file = File::create(path).map_err(|source| RunError::io("create", path, source))?;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(Some(file)),
            Err(TryLockError::WouldBlock) if control.wants_to_stop() => return Ok(None),
            Err(TryLockError::WouldBlock) => sleep(WAIT),
            Err(TryLockError::Error(source)) => return Err(RunError::io("lock", path, source)),
        }
    }
}
