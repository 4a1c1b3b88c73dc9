//! Beds of grains on the workbench: many impacts, cached, and the statistics of measurements on them.
//!
//! A [`Stand`] says which [`Job`] stands for which condition and draw of a bed; a [`Place`] runs jobs side
//! by side and keeps their [`Record`]s.

mod campaign;
mod job;
mod rate;
mod record;
mod stand;
mod variation;

pub use campaign::{CampaignError, Outstanding, Place, Progress, Stage, Unattended, Watch};
pub use job::Job;
pub use rate::grain_steps_per_second;
pub use record::Record;
pub use stand::{Draw, Stand, StandError};
pub use variation::Variation;
