//! The contact laws and effects of plunge, each in a file of its own and one line of [`LAWS`].

mod adhesion;
mod candidate;
mod capillary_bridge;
mod cohesion_dmt;
mod cohesion_jkr;
mod damped;
mod grain_force;
mod hertz;
mod hertz_mindlin;
mod hertz_mindlin_viscous;
mod linear_spring_dashpot;
mod registry;
mod rolling_constant_torque;
mod rolling_resistance;
mod twisting_resistance;
mod velocity_restitution;

pub use candidate::{Candidacy, Candidate, MeanGrain, Need};
pub use grain_force::{GRAIN_FORCES, GrainForceEntry, find_grain_force};
pub use hertz::damping_ratio;
pub use hertz_mindlin::restitution_key;
pub use registry::{ActsOn, FromParams, LawEntry};

/// Every law and effect, in the order of the docs.
pub static LAWS: &[&LawEntry] = &[
    &linear_spring_dashpot::ENTRY,
    &hertz_mindlin::ENTRY,
    &hertz_mindlin_viscous::ENTRY,
    &velocity_restitution::ENTRY,
    &cohesion_dmt::ENTRY,
    &cohesion_jkr::ENTRY,
    &capillary_bridge::ENTRY,
    &rolling_resistance::ENTRY,
    &rolling_constant_torque::ENTRY,
    &twisting_resistance::ENTRY,
];

/// The law or effect called `name`.
pub fn find(name: &str) -> Option<&'static LawEntry> {
    LAWS.iter().find(|entry| entry.name == name).copied()
}
