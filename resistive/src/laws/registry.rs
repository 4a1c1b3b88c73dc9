//! What a law of a resistive medium says of itself, and how it is built by name.

use crate::{Account, ResistanceLaw};
use engine::params::{ParamSpec, Range};

use super::coefficients::Coefficients;
use super::facts::{Facts, Needs};

/// One baseline or effect: its line in [`super::RESISTANCE_LAWS`] makes it exist for `run`, `compare`,
/// `diagnose`, `effects`, the docs and the shared tests.
pub struct ResistanceEntry {
    /// The name in TOML, kebab-case.
    pub name: &'static str,
    /// Whether a model starts from it or adds it.
    pub role: Role,
    /// What it is, in one sentence.
    pub summary: &'static str,
    /// The law as a formula, in plain text.
    pub formula: &'static str,
    /// What it does to depth, stopping time and forces.
    pub signature: &'static str,
    /// Paper and equation.
    pub source: &'static str,
    /// The parameters it takes.
    pub params: &'static [ParamSpec],
    /// Other forms of an effect, which a diagnosis tries beside the one of the defaults: what they set beside the amplitude.
    pub forms: &'static [OtherForm],
    /// What an expression in place of a parameter may depend on.
    pub variables: &'static [&'static str],
    /// The accounts it books energy to.
    pub accounts: &'static [Account],
    /// Makes it from SI values that fill `params`.
    pub build: fn(&Coefficients) -> Box<dyn ResistanceLaw>,
}

/// A form of an effect beside that of the defaults.
#[derive(Clone, Copy, Debug)]
pub struct OtherForm {
    /// What it sets beside the amplitude.
    pub values: &'static [(&'static str, f64)],
    /// What data must contain to tell it from the others.
    pub needs: &'static [Needs],
}

/// What a law is to a model.
#[derive(Clone, Copy, Debug)]
pub enum Role {
    /// The law that a model starts from.
    Baseline,
    /// Something added to it, with one amplitude `q` that is 0 when it is absent.
    Effect(Facts),
}

/// The amplitude of an effect.
pub(super) const fn amplitude(
    allowed: Range,
    plausible: Range,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec::number("q", meaning).allowed(allowed).plausible(plausible)
}
