//! JSON schemas of files, for editors that complete and check TOML.
//!
//! They are made of the questions that a reader asks: [`Gathered`] takes the notes of many readings and writes
//! one schema of them. What cannot be said in a schema stays to `plunge check`: values that have to fit each
//! other, and quantities in strings, whose ranges are said in words.

mod answers;
mod facts;
mod gathered;
mod model;
mod probes;
mod variation;

pub use gathered::{Format, Gathered};
pub use model::{loosened, model, read_model};
pub use variation::asked;

/// The comment that tells an editor where the schema of a file stands.
pub fn header(path: &str) -> String {
    format!("#:schema {path}\n")
}
