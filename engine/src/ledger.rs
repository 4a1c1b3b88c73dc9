//! The energy ledger: every joule of a run, by channel, at every step.
//!
//! `kinetic + potential + Σ stored + Σ dissipated − Σ input = E₀ + unaccounted`
//!
//! No term is found as a difference of others: kinetic and potential energy come from the state,
//! stored and dissipated energy from the laws, where the force is computed. So `unaccounted` is a
//! measure of the integration, and goes to zero as the square of the time step.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// How a channel enters the closure identity
/// `kinetic + potential + Σ stored + Σ dissipated − Σ input = E₀ + unaccounted`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ChannelKind {
    /// Energy held now (J).
    Stored,
    /// Energy lost since the start (J).
    Dissipated,
    /// Energy put in since the start (J).
    Input,
}

/// A named account of the ledger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// kebab-case, as in reports; files spell it in `snake_case` with a unit.
    pub name: &'static str,
    /// How it enters the closure.
    pub kind: ChannelKind,
}

/// What a term of the ledger is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermKind {
    /// Energy of motion, held now.
    Kinetic,
    /// Energy in the field of gravity, held now.
    Potential,
    /// A law's channel.
    Channel(ChannelKind),
}

/// One term of the ledger.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// kebab-case.
    pub name: Cow<'static, str>,
    /// What it is.
    pub kind: TermKind,
}

impl Term {
    /// The name in logs and JSON: `kinetic_grains_translation_J`, `dissipated_sliding_J`.
    pub fn key(&self) -> String {
        let group = match self.kind {
            TermKind::Kinetic => "kinetic",
            TermKind::Potential => "potential",
            TermKind::Channel(ChannelKind::Stored) => "elastic",
            TermKind::Channel(ChannelKind::Dissipated) => "dissipated",
            TermKind::Channel(ChannelKind::Input) => "input",
        };
        format!("{group}_{}_J", self.name.replace('-', "_"))
    }

    /// +1 where the term counts as energy that is there or was lost, −1 where it was put in.
    pub fn sign(&self) -> f64 {
        if self.kind == TermKind::Channel(ChannelKind::Input) { -1.0 } else { 1.0 }
    }
}

/// The state of every term, and how well they add up.
#[derive(Clone, Debug, PartialEq)]
pub struct Ledger {
    terms: Vec<Term>,
    balance: Balance,
}

/// What changes in a ledger.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Per term (J).
    pub values: Vec<f64>,
    /// E₀ (J).
    pub initial: f64,
    /// (J), since the start.
    pub unaccounted: f64,
    /// Largest |unaccounted| so far (J).
    pub worst: f64,
}

impl Ledger {
    /// A ledger of these terms, all zero.
    pub fn new(terms: Vec<Term>) -> Self {
        let values = vec![0.0; terms.len()];
        Self { terms, balance: Balance { values, ..Balance::default() } }
    }

    /// The terms, in the order of the log.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The values of the terms and of the closure.
    pub fn balance(&self) -> &Balance {
        &self.balance
    }

    /// The value (J) of the term called `key` in logs.
    pub fn value(&self, key: &str) -> Option<f64> {
        let index = self.terms.iter().position(|term| term.key() == key)?;
        Some(self.balance.values[index])
    }

    /// Sum (J) of the terms for which `of` holds.
    pub fn sum(&self, of: impl Fn(&Term) -> bool) -> f64 {
        let terms = self.terms.iter().zip(&self.balance.values);
        terms.filter(|(term, _)| of(term)).map(|(_, value)| value).sum()
    }

    /// Largest |unaccounted| so far in units of `scale` (J).
    pub fn closure(&self, scale: f64) -> f64 {
        self.balance.worst / scale
    }

    /// Takes the present values as the start: dissipation counts from here.
    pub fn open(&mut self, entries: &[f64]) {
        self.balance.values.fill(0.0);
        self.post(entries);
        for (term, value) in self.terms.iter().zip(&mut self.balance.values) {
            if accumulates(term) {
                *value = 0.0;
            }
        }
        self.balance.initial = self.total();
        self.balance.unaccounted = 0.0;
        self.balance.worst = 0.0;
    }

    /// Closes a step: `entries` hold what is there now, or what was lost or put in during the step.
    pub fn close(&mut self, entries: &[f64]) {
        self.post(entries);
        self.balance.unaccounted = self.total() - self.balance.initial;
        self.balance.worst = self.balance.worst.max(self.balance.unaccounted.abs());
    }

    /// Takes back a saved balance; `false` if it does not fit.
    pub(crate) fn restore(&mut self, balance: Balance) -> bool {
        let fits = balance.values.len() == self.terms.len();
        if fits {
            self.balance = balance;
        }
        fits
    }

    fn post(&mut self, entries: &[f64]) {
        debug_assert_eq!(entries.len(), self.terms.len());
        for ((term, value), &entry) in self.terms.iter().zip(&mut self.balance.values).zip(entries)
        {
            *value = if accumulates(term) { *value + entry } else { entry };
        }
    }

    fn total(&self) -> f64 {
        self.terms.iter().zip(&self.balance.values).map(|(term, value)| term.sign() * value).sum()
    }
}

fn accumulates(term: &Term) -> bool {
    matches!(term.kind, TermKind::Channel(ChannelKind::Dissipated | ChannelKind::Input))
}
