//! Beds of grains on the workbench: many impacts, cached, and the statistics of measurements on them.
//!
//! A [`Stand`] says which [`Job`](runner::beds::Job) stands for which condition and draw of a bed; a
//! [`Place`](runner::beds::Place) runs them.

mod baseline;
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
mod stand;
mod switch;
mod switches;
mod variation;
mod work;
mod workflow;

pub use baseline::BaselineError;
pub use confirmation::{Channel, Confirmation};
pub use emulator::BedForward;
pub use error::BedError;
pub use found::BedDiagnosis;
pub use plan::{Plan, PlannedStage, SIZES, Size, Wish, unaffordable};
pub use stand::{Draw, Stand, StandError};
pub use switch::Switch;
pub use switches::SWITCHES;
pub use variation::Variation;
pub use workflow::{COMPARED, bed_forward, compare_jobs, diagnose_bed};
