//! How often the diagnosis of a bed of grains is right: small beds in which something is hidden, measured
//! on seeds of their own and diagnosed like anything else.

mod world;

pub use world::{campaign, measure, model};
