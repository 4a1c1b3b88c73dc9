//! Files in and out of plunge: what reads, repairs and converts logs.

pub mod export;
pub mod follow;
pub mod frames;
pub mod lammps;
pub mod read;
pub mod recover;
pub mod run_files;
pub mod staging;
pub mod table;
pub mod tracking;

/// Whether to end early: work that takes long asks it again and again, a few times a second or more often.
pub type Stop<'a> = &'a dyn Fn() -> bool;
