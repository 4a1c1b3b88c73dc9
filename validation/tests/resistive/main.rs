//! Impacts on resistive media: closed forms, ledgers, rest, and every effect.

mod accelerations;
mod closed_forms;
mod effects;
mod fluid;
mod forces;
mod formulas;
#[path = "../../examples/late_drag/effect.rs"]
mod late_drag;
mod ledger;
mod own_candidates;
mod own_effects;
mod pushed;
mod rest;
mod rig;
mod sets;
mod spins;
mod velocities;
