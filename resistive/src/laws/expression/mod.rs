//! A user-defined effect: a force along a named direction, as a formula in a model file.

mod law;
mod variables;

use crate::{Immersion, Motion, Space, Surroundings};
use engine::params::{ParamSpec, Range};
use engine::units::Dimension;
use thiserror::Error;

use super::approach::Approach;
use super::facts::Needs;
use super::{RESISTANCE_LAWS, find_resistance};
use crate::formula::{DimensionError, Formula, FormulaError, Known, is_reserved};
pub use variables::{STATE_VARIABLES, StateVariable};
use variables::{Seen, find};

/// The amplitude of every effect.
const AMPLITUDE: &str = "q";

/// Longest name of a user-defined effect (byte).
const ID_BYTES: usize = 64;

/// Along what the force of a user-defined effect acts, and whether it holds a body at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Against the motion, and gone at rest: a drag.
    AgainstMotion,
    /// Against the motion, and at rest anything up to this: a friction.
    Friction,
    /// Against gravity.
    Up,
    /// With gravity.
    Down,
    /// The way of the horizontal motion at the start.
    Forward,
    /// Against it.
    Backward,
    /// Across the motion, out of the bed for a body that sinks.
    Normal,
}

/// Where the force of a user-defined effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// On what is in the bed.
    InBed,
    /// In the bed and above.
    Everywhere,
}

/// A parameter that a user-defined effect declares.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnParameter {
    /// As the formula spells it.
    pub name: String,
    /// Angles count as pure numbers.
    pub dimension: Dimension,
    /// (SI); of the amplitude of a candidate none.
    pub value: Option<f64>,
    /// The values that it may have (SI).
    pub range: Range,
}

/// What a model file says of a user-defined effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Its name, kebab-case.
    pub id: String,
    /// One sentence; may be empty.
    pub summary: String,
    /// The force (N), as a formula.
    pub force: String,
    /// Along what.
    pub direction: Direction,
    /// Where.
    pub acts: Acts,
    /// The amplitude `q`, and constants.
    pub parameters: Vec<OwnParameter>,
    /// Planar or spatial: areas, volumes and densities differ.
    pub space: Space,
}

/// Why there is no such effect.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum OwnEffectError {
    #[error("invalid effect name `{0}`: use lowercase letters, digits and hyphens")]
    Id(String),
    #[error(
        "`{0}` is the name of a law, an effect or an account of energy that comes with the program"
    )]
    Taken(String),
    #[error("a parameter cannot be called `{name}`: {why}")]
    Name { name: String, why: &'static str },
    #[error("the parameter `q`, the amplitude, is missing")]
    NoAmplitude,
    #[error("the range of `q` leaves out 0, which it is without the effect")]
    NeverAbsent,
    #[error("the range of `q` has nothing above 0; turn the sign of the force around")]
    NeverPresent,
    #[error(transparent)]
    Formula(#[from] FormulaError),
    #[error(transparent)]
    Dimension(#[from] DimensionError),
    #[error("the formula does not use `{0}`")]
    Unused(String),
}

/// Why the force of an effect cannot be what it is said to be.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum ForceError {
    #[error("is not finite")]
    NotFinite,
    #[error("does not vanish with q = 0: {0:.3e} N are left")]
    WithoutAmplitude(f64),
    #[error("is {0:.3e} N at rest: only a friction is there without motion")]
    AtRest(f64),
    #[error("is {0:.3e} N: a friction cannot be negative")]
    NegativeFriction(f64),
}

/// An effect that a model file defines: listed, fitted and ranked like those of the table.
#[derive(Clone, Debug)]
pub struct OwnEffect {
    draft: Draft,
    force: Formula,
    /// One per variable of the formula.
    sources: Vec<Source>,
    amplitude: ParamSpec,
}

/// Where the value of a variable of the formula comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    State(usize),
    Amplitude,
    Constant(f64),
}

impl OwnEffect {
    /// Reads the formula and checks that it is a force; `is_taken` knows the names of laws and effects
    /// elsewhere in the program.
    ///
    /// # Errors
    /// If a name is unfit or taken, the formula cannot be read or is not in newtons, or a parameter is
    /// missing or not used.
    pub fn new(draft: Draft, is_taken: impl Fn(&str) -> bool) -> Result<Self, OwnEffectError> {
        check_id(&draft.id, is_taken)?;
        for parameter in &draft.parameters {
            check_name(&parameter.name)?;
        }
        let own = |name: &str| draft.parameters.iter().find(|one| one.name == name);
        let q = own(AMPLITUDE).ok_or(OwnEffectError::NoAmplitude)?;
        if !q.range.contains(0.0) {
            return Err(OwnEffectError::NeverAbsent);
        }
        if q.range.max <= 0.0 {
            return Err(OwnEffectError::NeverPresent);
        }
        let amplitude =
            ParamSpec::required(AMPLITUDE, q.dimension, "the amplitude; 0 without the effect")
                .allowed(q.range)
                .plausible(q.range);
        let names: Vec<&str> = STATE_VARIABLES
            .iter()
            .flat_map(|variable| [variable.name, variable.alias])
            .filter(|name| !name.is_empty())
            .chain(draft.parameters.iter().map(|one| one.name.as_str()))
            .collect();
        let force = Formula::parse(&draft.force, &names)?;
        if let Some(unused) =
            draft.parameters.iter().find(|one| !force.variables().contains(&one.name))
        {
            return Err(OwnEffectError::Unused(unused.name.clone()));
        }
        force.check_dimension(Dimension::FORCE, |name| match (own(name), find(name)) {
            (Some(own), _) => Known {
                dimension: own.dimension.without_angle(),
                constant: own.value.filter(|_| name != AMPLITUDE),
            },
            (None, Some(state)) => {
                Known { dimension: state.dimension(draft.space), constant: None }
            }
            (None, None) => Known { dimension: Dimension::NONE, constant: None },
        })?;
        let source = |name: &String| match (name.as_str(), own(name)) {
            (AMPLITUDE, _) => Source::Amplitude,
            (_, Some(constant)) => Source::Constant(constant.value.unwrap_or(f64::NAN)),
            (name, None) => Source::State(
                STATE_VARIABLES
                    .iter()
                    .position(|one| one.name == name || one.alias == name)
                    .unwrap_or_default(),
            ),
        };
        let sources = force.variables().iter().map(source).collect();
        Ok(Self { force, sources, amplitude, draft })
    }

    /// Its name.
    pub fn id(&self) -> &str {
        &self.draft.id
    }

    /// What the model file says of it.
    pub fn draft(&self) -> &Draft {
        &self.draft
    }

    /// The amplitude `q` and what it may be.
    pub fn amplitude(&self) -> &ParamSpec {
        &self.amplitude
    }

    /// What data must contain to show it.
    pub fn visible(&self) -> Vec<Needs> {
        let mut all: Vec<Needs> = Vec::new();
        for need in self.used().filter_map(|variable| variable.needs) {
            if !all.contains(&need) {
                all.push(need);
            }
        }
        all
    }

    /// The state variables that its formula uses, in the order of the table.
    pub fn used(&self) -> impl Iterator<Item = &'static StateVariable> + '_ {
        STATE_VARIABLES.iter().enumerate().filter_map(|(index, variable)| {
            let is_used = |source: &Source| matches!(source, Source::State(used) if *used == index);
            self.sources.iter().any(is_used).then_some(variable)
        })
    }

    /// Whether the force in a state is of the kind that it is said to be.
    ///
    /// # Errors
    /// If it is not finite, is there at `q` = 0, is there at rest though a drag, or is a negative friction.
    pub fn check(
        &self,
        at: &Immersion,
        motion: &Motion,
        bed: &Surroundings,
        approach: Approach,
    ) -> Result<(), ForceError> {
        if !self.is_informed(bed) {
            return Ok(());
        }
        let seen = Seen { at, motion, bed, speed: motion.speed, approach };
        let q = self.value_in_file().unwrap_or(self.amplitude.allowed.max);
        let (force, without) = (self.value(q, &seen), self.value(0.0, &seen));
        let is_still = motion.velocity.norm() == 0.0;
        match self.draft.direction {
            _ if !force.is_finite() => Err(ForceError::NotFinite),
            _ if without != 0.0 => Err(ForceError::WithoutAmplitude(without)),
            Direction::AgainstMotion if is_still && force != 0.0 => Err(ForceError::AtRest(force)),
            Direction::Friction if force < 0.0 => Err(ForceError::NegativeFriction(force)),
            _ => Ok(()),
        }
    }

    fn value_in_file(&self) -> Option<f64> {
        let q = self.draft.parameters.iter().find(|one| one.name == AMPLITUDE)?;
        q.value.filter(|value| *value != 0.0)
    }

    fn direction(&self) -> Direction {
        self.draft.direction
    }

    fn acts(&self) -> Acts {
        self.draft.acts
    }

    /// Whether the bed says all that the formula asks of it; if not, the effect does nothing.
    fn is_informed(&self, bed: &Surroundings) -> bool {
        self.used().all(|variable| match variable.needs {
            Some(Needs::Packings) => bed.packing.is_some(),
            Some(Needs::BedDepth) => bed.bed_depth.is_some(),
            _ => true,
        })
    }

    /// The formula in a state.
    fn value(&self, q: f64, seen: &Seen<'_>) -> f64 {
        let values: Vec<f64> = self
            .sources
            .iter()
            .map(|source| match *source {
                Source::State(index) => (STATE_VARIABLES[index].value)(seen),
                Source::Amplitude => q,
                Source::Constant(value) => value,
            })
            .collect();
        self.force.value(&values)
    }
}

impl PartialEq for OwnEffect {
    /// What a file says of them is the same.
    fn eq(&self, other: &Self) -> bool {
        self.draft == other.draft
    }
}

fn check_id(id: &str, is_taken: impl Fn(&str) -> bool) -> Result<(), OwnEffectError> {
    let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let is_kebab = id.starts_with(|c: char| c.is_ascii_lowercase())
        && id.len() <= ID_BYTES
        && id.chars().all(fits)
        && !id.ends_with('-')
        && !id.contains("--");
    if !is_kebab {
        return Err(OwnEffectError::Id(id.to_owned()));
    }
    let accounts = RESISTANCE_LAWS.iter().flat_map(|entry| entry.accounts);
    let is_account = |name: &str| accounts.clone().any(|account| account.channel.name == name);
    let taken = find_resistance(id).is_some() || is_taken(id) || is_account(id);
    match taken || id == "expression" {
        true => Err(OwnEffectError::Taken(id.to_owned())),
        false => Ok(()),
    }
}

fn check_name(name: &str) -> Result<(), OwnEffectError> {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let why = match name {
        _ if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || !name.chars().all(fits) => {
            "expected letters, digits and underscores, a letter first"
        }
        _ if is_reserved(name) => {
            "it is a function or a number of formulas, or begins with min or max"
        }
        _ if find(name).is_some() => "it is a variable of the state",
        _ => return Ok(()),
    };
    Err(OwnEffectError::Name { name: name.to_owned(), why })
}

#[cfg(test)]
mod tests;
