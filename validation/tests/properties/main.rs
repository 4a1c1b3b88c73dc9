//! What must hold for every run, whatever it is a run of.

mod closure;
mod cloud;
mod conservation;
mod determinism;
mod neighbours;
mod symmetry;
