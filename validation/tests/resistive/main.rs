//! Impacts on resistive media: closed forms, ledgers, rest, and every effect.

mod closed_forms;
mod effects;
mod ledger;
mod rest;
mod rig;
