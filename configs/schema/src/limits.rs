//! How much a model file may ask for; each limit is refused by name.

/// Largest model file (byte).
pub const FILE_BYTES: u64 = 10_000_000;
/// Largest data file that a model may name (byte).
pub(crate) const DATA_FILE_BYTES: u64 = 512_000_000;
/// Longest string in a model file (byte).
pub(crate) const STRING_BYTES: usize = 4096;
/// Most `[[effect]]` tables.
pub(crate) const EFFECTS: usize = 1000;
/// Most `[[candidate]]` tables.
pub(crate) const CANDIDATES: usize = 100;
/// Most `[[bed.grains]]` tables.
pub(crate) const GRAIN_KINDS: usize = 1000;
/// Most grains of one kind that a file may write down; memory refuses far fewer.
pub(crate) const GRAINS_OF_A_KIND: u64 = 1_000_000_000_000_000;
/// Most impact conditions of one model.
pub const CONDITIONS: usize = 10_000;

/// Most `[[bed]]` tables of a measurement set.
pub const BEDS: usize = 100;
/// Most memory (byte) that the size of a container may ask for; that of the machine refuses far less.
pub(crate) const CONTAINER_BYTES: f64 = 1e13;
/// Most steps of one run: what the log can number.
pub const STEPS: f64 = u32::MAX as f64;
/// Most messages about one file.
pub(crate) const DIAGNOSTICS: usize = 50;
