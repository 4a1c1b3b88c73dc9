//! The engine of plunge: grain beds, rigid intruders, contacts, the energy ledger and the log.
//!
//! It knows no contact law, no shape and no TOML; it defines the traits that those implement.

pub mod contact;
pub mod ledger;
pub mod math;
pub mod params;
pub mod record;
pub mod units;
