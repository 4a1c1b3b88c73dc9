//! Prepared beds, kept under a key of everything they depend on.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use engine::checkpoint::{self, FORMAT, with_suffix};
use engine::grain_bed::RestingBed;

use super::{Control, Progress, RunError};
use crate::model::Model;

/// Steps between two looks at the control while a bed settles.
const LOOK_EVERY: u64 = 100;

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

/// The key of the bed of `model`: canonical recipe, version and format.
#[must_use]
pub fn bed_key(model: &Model) -> [u8; 32] {
    let text = format!("{}\n{FORMAT}\n{}", env!("CARGO_PKG_VERSION"), model.bed_key_text());
    *blake3::hash(text.as_bytes()).as_bytes()
}

/// The bed of `model`: read from its table, or from the cache below `folder`, or prepared now and put
/// there. Nothing if `control` wants to stop.
///
/// # Errors
/// If it cannot be prepared or stored.
pub fn prepare(
    model: &Model,
    folder: &Path,
    control: &mut dyn Control,
) -> Result<Option<PreparedBed>, RunError> {
    if let Some(resting) = model.read_bed() {
        return Ok(Some(PreparedBed { resting, cache: "file", path: None }));
    }
    let key = bed_key(model);
    let beds = folder.join("beds");
    let path = beds.join(format!("{}.bed", blake3::Hash::from_bytes(key).to_hex()));
    match checkpoint::load(&path, &key) {
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
    let Some(resting) = settle(model, control)? else { return Ok(None) };
    // What is there is damaged, and not worth keeping as the one before.
    let _ = fs::remove_file(&path);
    checkpoint::save(&path, &key, &resting)?;
    // Whoever waits for this lock, or makes a new one, finds the bed.
    let _ = fs::remove_file(&lock_path);
    drop(lock);
    Ok(Some(PreparedBed { resting, cache: "miss", path: Some(path) }))
}

/// The bed of `model`, settled now. Nothing if `control` wants to stop.
fn settle(model: &Model, control: &mut dyn Control) -> Result<Option<RestingBed>, RunError> {
    let Some(mut settling) = model.settling()? else {
        unreachable!("a bed is read from a table or settles")
    };
    while !settling.is_at_rest() {
        settling.advance().map_err(|source| RunError::Settling { source })?;
        let clock = settling.clock();
        if clock.step.is_multiple_of(LOOK_EVERY) {
            control.progress(&Progress::Settling {
                step: clock.step,
                time: clock.time(),
                restlessness: settling.restlessness(),
            });
            if control.wants_to_stop() {
                return Ok(None);
            }
        }
    }
    Ok(Some(settling.bed().resting()))
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
