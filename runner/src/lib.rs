//! Runs models: one impact or list into a folder of its own, and many as a campaign.
//!
//! [`run`](mod@run) makes the files of an output folder of a model; [`campaign::file`] reads a campaign file;
//! [`schedulers`] hands numbered tasks to SLURM or HyperQueue.

pub mod campaign;
pub mod run;
pub mod schedulers;
