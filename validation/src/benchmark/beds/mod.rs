//! How often the diagnosis of a bed of grains is right: small beds in which something is hidden, measured
//! on seeds of their own and diagnosed like anything else.

mod case;
mod prepared;
mod table;
mod world;

pub use case::{Case, Hidden, Outcome, all, prepared, quick};
pub use prepared::Prepared;
pub use table::table;
pub use world::{campaign, measure, model, small};
