//! Pictures of a comparison and of a diagnosis, drawn on [`plots`].

mod comparison;
mod covariates;
mod curves;
mod depth;
mod errors;
mod measured;
mod missing_force;
mod multiples;
mod panel;
mod residuals;
mod revisions;
mod signatures;
mod signed;
mod speed_angle;
mod trajectories;

pub use self::comparison::comparison;
pub(crate) use self::covariates::covariates;
pub(crate) use self::depth::depth;
pub(crate) use self::errors::errors;
pub use self::measured::measured;
pub(crate) use self::missing_force::missing_force;
pub(crate) use self::residuals::residuals;
pub(crate) use self::revisions::revisions;
pub(crate) use self::signatures::signatures;
pub(crate) use self::speed_angle::speed_angle;
pub(crate) use self::trajectories::trajectories;
