//! What must hold for every run, whatever it is a run of.

mod beds;
mod boundaries;
mod closure;
mod cloud;
mod conservation;
mod determinism;
mod fused;
mod grain_forces;
mod neighbours;
mod symmetry;
