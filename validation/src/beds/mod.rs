//! Beds of grains on the workbench: many impacts, cached, and the statistics of measurements on them.
//!
//! A [`Stand`] says which [`Job`] stands for which condition and draw of a bed; a [`Place`] runs jobs side
//! by side and keeps their [`Record`]s, or has other machines do it ([`Elsewhere`]).

mod baseline;
pub mod benchmark;
mod campaign;
mod confirmation;
mod design;
mod elsewhere;
mod emulator;
mod job;
mod line_search;
mod modes;
mod plan;
mod rate;
mod record;
mod response;
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
pub use elsewhere::{Elsewhere, WORD, work};
pub(crate) use elsewhere::{ModelText, Task};
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
