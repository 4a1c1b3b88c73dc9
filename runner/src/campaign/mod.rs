//! Campaigns: many impacts, as one file says them.

pub mod file;
