//! The engine of plunge: grain beds, rigid intruders, contacts, the energy ledger and the log.
//!
//! Open [`simulation`] first, then [`step`]: a run is a loop of steps, and a step a list of phases.
//! [`contact`] says what a contact law is. The engine knows no law, no shape and no TOML; it defines
//! the traits that those implement.

pub mod activity;
mod at_walls;
pub mod bed;
pub mod body;
pub mod boundary;
pub mod checkpoint;
pub mod clock;
pub mod coarse_graining;
pub mod contact;
mod contacts;
pub mod course;
pub mod crater;
mod dimension;
pub mod driven;
pub mod error;
pub mod feature;
pub mod fluid;
pub mod footprint;
pub mod grain_bed;
pub mod grain_force;
mod grain_pass;
pub mod grains;
pub mod lanes;
pub mod launch;
pub mod ledger;
pub mod math;
mod neighbours;
pub mod parallel;
pub mod params;
mod prefetch;
mod recessive;
pub mod record;
pub mod simulation;
mod space;
pub mod step;
pub mod stopping;
pub mod surface;
pub mod units;
pub mod world;

pub use contacts::{rebound, stage};
