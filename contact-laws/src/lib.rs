//! The contact laws and effects of plunge, each in a file of its own and one line of [`LAWS`].

mod registry;

pub use registry::{ActsOn, LawEntry};

/// Every law and effect, in the order of the docs.
pub static LAWS: &[&LawEntry] = &[];
