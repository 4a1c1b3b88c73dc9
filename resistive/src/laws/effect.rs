//! An effect of a resistive medium, whoever defines it.

use std::fmt;
use std::sync::Arc;

use crate::ResistanceLaw;
use engine::params::{ParamDefault, ParamSpec, ParamTable};

use super::approach::Approach;
use super::coefficients::Coefficients;
use super::expression::OwnEffect;
use super::facts::Needs;
use super::registry::{ResistanceEntry, Role};
use super::{RESISTANCE_LAWS, find_resistance};

/// Something added to a force law, with one amplitude `q` that is 0 when it is absent.
#[derive(Clone)]
pub enum Effect {
    /// One of [`RESISTANCE_LAWS`], with what it takes beside its amplitude (SI).
    Listed(&'static ResistanceEntry, ParamTable),
    /// One that a model file defines.
    Own(Arc<OwnEffect>),
}

impl Effect {
    /// The listed effect called `name`.
    pub fn listed(name: &str) -> Option<Self> {
        let entry = find_resistance(name)?;
        matches!(entry.role, Role::Effect(_)).then(|| Self::with(entry, &[]))
    }

    /// The effect of `entry` with `values` in place of its defaults.
    fn with(entry: &'static ResistanceEntry, values: &[(&'static str, f64)]) -> Self {
        let mut given = ParamTable::new();
        for spec in &entry.params[1..] {
            if let ParamDefault::Value(value) = spec.default {
                given.set(spec.key, value);
            }
        }
        values.iter().for_each(|&(key, value)| given.set(key, value));
        Self::Listed(entry, given)
    }

    /// The other forms of it that its entry names, each with what data must contain to tell it from the others.
    pub fn other_forms(&self) -> Vec<(Self, &'static [Needs])> {
        match self {
            Self::Listed(entry, _) => entry
                .forms
                .iter()
                .map(|form| (Self::with(entry, form.values), form.needs))
                .collect(),
            Self::Own(_) => Vec::new(),
        }
    }

    /// What it takes beside its amplitude and differs from the defaults (SI): nothing for the form that is listed.
    pub fn form(&self) -> Vec<(&'static str, f64)> {
        let Self::Listed(entry, given) = self else { return Vec::new() };
        let is_default = |key: &str, value: f64| {
            let spec = entry.params.iter().find(|spec| spec.key == key);
            spec.is_some_and(|spec| spec.default == ParamDefault::Value(value))
        };
        given.iter().filter(|&(key, value)| key != "q" && !is_default(key, value)).collect()
    }

    /// Its name: in a ranking, in the names of files, in `effect.NAME.q`.
    pub fn name(&self) -> &str {
        match self {
            Self::Listed(entry, _) => entry.name,
            Self::Own(own) => own.id(),
        }
    }

    /// Its amplitude and what that may be.
    pub fn amplitude(&self) -> &ParamSpec {
        match self {
            Self::Listed(entry, _) => &entry.params[0],
            Self::Own(own) => own.amplitude(),
        }
    }

    /// Unit of its amplitude; "1" where it is a pure number.
    pub fn unit(&self) -> String {
        match self {
            Self::Listed(ResistanceEntry { role: Role::Effect(facts), .. }, _) => {
                facts.unit.to_owned()
            }
            _ => Some(self.amplitude().dimension.si_unit())
                .filter(|unit| !unit.is_empty())
                .unwrap_or_else(|| "1".to_owned()),
        }
    }

    /// What data must contain for it to act at all.
    pub fn visible(&self) -> Vec<Needs> {
        match self {
            Self::Listed(ResistanceEntry { role: Role::Effect(facts), .. }, _) => {
                facts.visible.to_vec()
            }
            Self::Listed(..) => Vec::new(),
            Self::Own(own) => own.visible(),
        }
    }

    /// Its term of the force with amplitude `q` (SI) on a body that comes as `approach` says.
    pub fn build(&self, q: f64, approach: Approach) -> Box<dyn ResistanceLaw> {
        match self {
            Self::Listed(entry, given) => {
                let mut numbers = given.clone();
                numbers.set("q", q);
                (entry.build)(&Coefficients::new(numbers))
            }
            Self::Own(own) => own.build(q, approach),
        }
    }

    /// Sorts effects as they act: those of the table in its order, then the others by their names.
    pub fn rank(&self) -> (usize, &str) {
        let listed = RESISTANCE_LAWS.iter().position(|entry| entry.name == self.name());
        (listed.unwrap_or(RESISTANCE_LAWS.len()), self.name())
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Listed(a, own), Self::Listed(b, other)) => a.name == b.name && own == other,
            (Self::Own(a), Self::Own(b)) => a == b,
            _ => false,
        }
    }
}

impl fmt::Debug for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Effect").field(&self.name()).finish()
    }
}
