//! Beds of grains on the workbench: many impacts, cached, and the statistics of measurements on them.
//!
//! A [`BedModel`] says which [`Job`](runner::beds::Job) stands for which condition and draw of a bed; a
//! [`Place`](runner::beds::Place) runs them.

mod baseline;
mod bed_candidate;
mod bed_candidates;
mod bed_model;
mod changes;
mod clarity;
mod confirmation;
mod design;
mod emulator;
mod error;
mod found;
mod leaders;
mod line_search;
mod located;
mod modes;
pub mod observables;
mod plan;
pub mod preparation;
mod response;
mod screening;
mod searches;
mod shared;
mod variation;
mod work;
mod workflow;

pub use baseline::BaselineError;
pub use bed_candidate::BedCandidate;
pub use bed_candidates::BED_CANDIDATES;
pub use bed_model::{BedModel, BedModelError, Draw};
pub use confirmation::{Channel, Confirmation};
pub use emulator::BedForward;
pub use error::BedError;
pub use found::BedDiagnosis;
pub use plan::{Plan, PlannedStage, SIZES, Size, Wish, unaffordable};
pub use variation::Variation;
pub use workflow::{COMPARED, bed_forward, compare_jobs, diagnose_bed};
