//! Files in and out of plunge: what reads, repairs and converts logs.

pub mod export;
pub mod lammps;
pub mod read;
pub mod recover;
pub mod run_files;
pub mod table;
