//! Impacts on beds of grains, each run once and kept: a [`Job`] is one of them, a [`Record`] what is kept of it, and
//! a [`Place`] runs jobs side by side or has other machines do it.

mod job;
mod lie;
mod place;
mod rate;
mod record;
mod task;

pub use job::Job;
pub use lie::Lie;
pub use place::{Impacts, Outstanding, Place};
pub use rate::SETTLING;
pub use record::{Record, STOPPED};
pub use task::BedTask;
