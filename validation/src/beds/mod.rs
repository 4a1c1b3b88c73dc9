//! Beds of grains on the workbench: many impacts, cached, and the statistics of measurements on them.
//!
//! A [`Stand`] says which [`Job`] stands for which condition and draw of a bed; a [`Place`] runs jobs side
//! by side and keeps their [`Record`]s.

mod baseline;
pub mod benchmark;
mod campaign;
mod confirmation;
mod design;
mod emulator;
mod job;
mod line_search;
mod plan;
mod rate;
mod record;
mod screening;
mod stand;
mod switches;
mod variation;
mod workflow;

pub use baseline::BaselineError;
pub use campaign::{
    CampaignError, Impacts, Outstanding, Place, Progress, Stage, Unattended, Watch,
};
pub use confirmation::{Channel, Confirmation};
pub use emulator::BedForward;
pub use job::Job;
pub use plan::{Plan, PlannedStage, SIZES, Size, Wish};
pub use record::Record;
pub use stand::{Draw, Stand, StandError};
pub use switches::{SWITCHES, Switch};
pub use variation::Variation;
pub use workflow::{
    BedDiagnosis, BedError, COMPARED, bed_forward, compare_jobs, diagnose_bed, unaffordable,
};
