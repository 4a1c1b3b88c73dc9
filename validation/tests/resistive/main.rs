//! Impacts on resistive media against closed forms.

mod closed_forms;
mod ledger;
mod rest;
mod rig;
