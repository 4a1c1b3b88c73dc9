//! How often the diagnosis of a bed of grains is right: small beds in which something is hidden, measured
//! on seeds of their own and diagnosed like anything else.

mod case;
mod hidden;
mod lammps;
mod prepared;
mod table;
mod world;

pub use case::{Case, CaseError, Grains, Outcome, all, by_lammps, of_spheres, prepared, quick};
pub use hidden::Hidden;
pub use prepared::Prepared;
pub use table::table;
pub use world::{campaign, measure};
