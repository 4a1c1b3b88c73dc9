//! What a law says of itself, and how it is built by name.

use engine::contact::{ContactLaw, Slot};
use engine::ledger::Channel;
use engine::params::{ParamSpec, ParamTable};
use engine::stage::{ContactStage, Stage};

use crate::candidate::Candidacy;

/// What a law acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActsOn {
    /// Contacts of grains with grains, walls and intruders: the base law of a bed.
    ContactBase,
    /// Contacts, as an effect added to a base law.
    ContactEffect,
}

/// One law or effect: its one line in [`crate::LAWS`] makes it exist for `run`, `diagnose`,
/// `effects`, the docs and the shared tests.
pub struct LawEntry {
    /// The name in TOML, kebab-case.
    pub name: &'static str,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// When it acts.
    pub slot: Slot,
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
    /// The accounts it books energy to.
    pub channels: &'static [Channel],
    /// Whether the diagnosis of a bed looks for it.
    pub candidacy: Candidacy,
    /// Makes it from SI values that fill `params`.
    pub build: fn(&ParamTable) -> Box<dyn ContactStage>,
}

impl LawEntry {
    /// The parts of an entry that follow from the law itself; the texts and parameters, and the candidacy
    /// of an effect, are to be filled in.
    pub const fn of<L: FromParams>() -> Self {
        Self {
            name: L::NAME,
            acts_on: ActsOn::ContactBase,
            slot: L::SLOT,
            summary: "",
            formula: "",
            signature: "",
            source: "",
            params: &[],
            channels: L::CHANNELS,
            candidacy: Candidacy::None("a model has one contact law from the start"),
            build: |params| Box::new(Stage::new(&L::from_params(params))),
        }
    }
}

/// A law that can be made from the parameters of its entry.
pub trait FromParams: ContactLaw {
    /// Takes SI values that fill the entry's specs and lie in their allowed ranges.
    fn from_params(params: &ParamTable) -> Self;
}
