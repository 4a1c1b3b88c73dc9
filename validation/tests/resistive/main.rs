//! Impacts on resistive media against closed forms.

mod closed_forms;
mod formulas;
#[path = "../../examples/late_drag.rs"]
mod late_drag;
mod ledger;
mod own_candidates;
mod own_effects;
mod rest;
mod rig;
