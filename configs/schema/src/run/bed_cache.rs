//! Prepared beds, kept under a key of everything they depend on.

use std::fs;
use std::path::{Path, PathBuf};

use engine::checkpoint::{self, CheckpointError, FORMAT};
use engine::grain_bed::RestingBed;

use super::{Control, Progress, RunError};
use crate::model::Model;

/// Steps between two looks at the control while a bed settles.
const LOOK_EVERY: u64 = 100;

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
        Err(CheckpointError::Io { ref source, .. })
            if source.kind() == std::io::ErrorKind::NotFound => {}
        Err(error) => control.warn(&format!("{error}; the bed is prepared again")),
    }
    fs::create_dir_all(&beds).map_err(|source| RunError::io("create", &beds, source))?;
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
    let resting = settling.bed().resting();
    checkpoint::save(&path, &key, &resting)?;
    Ok(Some(PreparedBed { resting, cache: "miss", path: Some(path) }))
}
