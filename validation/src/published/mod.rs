//! The published results, run again and judged.
//!
//! A [`Row`] is one file in `rows/` and one line in [`ROWS`]: it says where a result was published, runs it
//! and holds what comes out against it. Every [`Check`] has its band and the reason for it, and a
//! [`Verdict`]; a deviation needs a cause and a size that a source stated before the row was run.
//! `cargo xtask validate` runs them.

pub mod check;
pub mod document;
pub mod laboratory;
pub mod links;
pub mod oblique;
pub mod planar;
pub mod plot;
pub mod regression;
pub mod row;
mod rows;
pub mod shapes;
pub mod signatures;

pub use check::{Check, Estimate, Verdict};
pub use document::{Judged, checks_csv, markdown, tally, to_json};
pub use laboratory::{Effort, Laboratory, Missing};
pub use row::{Findings, PublishedError, Row};
pub use rows::ROWS;
