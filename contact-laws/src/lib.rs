//! The contact laws and effects of plunge, each in a file of its own and one line of [`LAWS`].

mod linear_spring_dashpot;
mod registry;
mod resistance;
mod rolling_resistance;

pub use registry::{ActsOn, FromParams, LawEntry};
pub use resistance::{
    Coefficients, Expression, ExpressionError, Facts, Needs, RESISTANCE_LAWS, ResistanceEntry,
    Role, Twin, find_resistance, twins,
};

/// Every law and effect, in the order of the docs.
pub static LAWS: &[&LawEntry] = &[&linear_spring_dashpot::ENTRY, &rolling_resistance::ENTRY];

/// The law or effect called `name`.
#[must_use]
pub fn find(name: &str) -> Option<&'static LawEntry> {
    LAWS.iter().find(|entry| entry.name == name).copied()
}
