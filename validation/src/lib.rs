//! What plunge is checked against: cases with a known answer.
//!
//! A [`Case`] is one file in `validation/cases` and one line in [`CASES`]. `cargo xtask validate`
//! runs them and prints what was measured beside what is right.

pub mod case;
mod cases;
pub mod encounter;
pub mod fixed;
pub mod rig;

pub use case::{Case, Expected, Outcome};
pub use cases::CASES;
