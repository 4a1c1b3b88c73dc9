//! How far a fitted model is from the runs, where, and whether noise explains it.

pub mod covariate;
pub(crate) mod directions;
pub(crate) mod discovery;
pub mod error_unit;
pub mod errors;
pub mod force_error;
pub mod held_out;
pub mod lack_of_fit;
pub(crate) mod noise_floor;
pub(crate) mod redraw;
pub mod residual;
