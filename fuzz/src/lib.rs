//! What has to hold of any bytes that a user may hand to plunge, whatever they are.
//!
//! Each [`Target`] reads bytes as the program would and panics where something does not hold: a panic of
//! the reader, an accepted model that prints as another one, a recovered log that needs recovery.
//! `tests/readers.rs` tries changes of files that ship, by bolero. What broke a reader, or the program behind it, is
//! kept in `found/`, and `tests/found.rs` tries it again.

pub mod checkpoint;
pub mod edit;
pub mod formula;
pub mod log;
pub mod model;
pub mod seeds;
pub mod set;

/// Something that reads bytes.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// Reads bytes and says in words what came of it.
    ///
    /// It panics where something does not hold.
    pub outcome: fn(&[u8]) -> String,
}

/// All of them.
pub const TARGETS: [Target; 5] = [
    Target { name: "model", outcome: model::outcome },
    Target { name: "formula", outcome: formula::outcome },
    Target { name: "set", outcome: set::outcome },
    Target { name: "log", outcome: log::outcome },
    Target { name: "checkpoint", outcome: checkpoint::outcome },
];
