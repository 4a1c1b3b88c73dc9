//! Beds of grains on the workbench, with small beds.

mod campaign;
mod diagnosis;
mod imitation;
mod world;
