//! How laws, effects and intruders say which parameters they take, and how they receive them.

use crate::units::Dimension;

/// What a parameter is when the file does not give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamDefault {
    /// The file must give it.
    Required,
    /// This SI value.
    Value(f64),
    /// The value of another parameter of the same table, named here; it stands earlier in the table.
    SameAs(&'static str),
    /// For an effect on a contact law: the value of this parameter of the law, which must have it.
    FromBase(&'static str),
}

/// An interval of SI values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// Whether `min` itself is inside.
    pub includes_min: bool,
}

impl Range {
    /// Any finite number above zero.
    pub const POSITIVE: Self = Self { min: 0.0, max: f64::MAX, includes_min: false };
    /// Any finite number from zero on.
    pub const NOT_NEGATIVE: Self = Self { min: 0.0, max: f64::MAX, includes_min: true };

    /// From `min` to `max`, both included.
    pub const fn closed(min: f64, max: f64) -> Self {
        Self { min, max, includes_min: true }
    }

    /// Whether `value` lies inside; NaN never does.
    pub fn contains(&self, value: f64) -> bool {
        let above = if self.includes_min { value >= self.min } else { value > self.min };
        above && value <= self.max
    }
}

/// One parameter of a law, effect or shape: the same entry reads the file, documents the parameter
/// in `plunge effects` and bounds a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamSpec {
    /// The key in the TOML table, `snake_case`.
    pub key: &'static str,
    /// Its physical dimension.
    pub dimension: Dimension,
    /// What it is when not given.
    pub default: ParamDefault,
    /// The values that are accepted at all (SI).
    pub allowed: Range,
    /// The values that one would expect (SI): a value outside warns.
    pub plausible: Range,
    /// One line of meaning.
    pub meaning: &'static str,
}

impl ParamSpec {
    /// A quantity that the file must give, from zero on.
    pub const fn required(key: &'static str, dimension: Dimension, meaning: &'static str) -> Self {
        let (allowed, plausible) = (Range::NOT_NEGATIVE, Range::NOT_NEGATIVE);
        Self { key, dimension, default: ParamDefault::Required, allowed, plausible, meaning }
    }

    /// A pure number that the file must give, from zero on.
    pub const fn number(key: &'static str, meaning: &'static str) -> Self {
        Self::required(key, Dimension::NONE, meaning)
    }

    /// The same under another name.
    #[must_use]
    pub const fn named(self, key: &'static str, meaning: &'static str) -> Self {
        Self { key, meaning, ..self }
    }

    /// The same with this value (SI) where the file gives none.
    #[must_use]
    pub const fn or(self, value: f64) -> Self {
        Self { default: ParamDefault::Value(value), ..self }
    }

    /// The same with the value of `key`, of the same table, where the file gives none.
    #[must_use]
    pub const fn same_as(self, key: &'static str) -> Self {
        Self { default: ParamDefault::SameAs(key), ..self }
    }

    /// The same with these values accepted (SI).
    #[must_use]
    pub const fn allowed(self, allowed: Range) -> Self {
        Self { allowed, ..self }
    }

    /// The same with the values from `min` to `max` expected (SI).
    #[must_use]
    pub const fn usual(self, min: f64, max: f64) -> Self {
        Self { plausible: Range::closed(min, max), ..self }
    }

    /// The same with these values expected (SI).
    #[must_use]
    pub const fn plausible(self, plausible: Range) -> Self {
        Self { plausible, ..self }
    }
}

/// SI values by key, complete for the specs it was filled from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParamTable {
    entries: Vec<(&'static str, f64)>,
}

impl ParamTable {
    /// An empty table.
    pub const fn new() -> Self {
        Self { entries: Vec::new() }
    }

    /// Sets `key` to an SI value, replacing an earlier one.
    pub fn set(&mut self, key: &'static str, value: f64) {
        match self.entries.iter_mut().find(|(name, _)| *name == key) {
            Some(entry) => entry.1 = value,
            None => self.entries.push((key, value)),
        }
    }

    /// The SI value of `key`.
    ///
    /// # Panics
    /// If the table was not filled from the specs of whoever asks.
    pub fn get(&self, key: &str) -> f64 {
        self.entries
            .iter()
            .find(|(name, _)| *name == key)
            .unwrap_or_else(|| panic!("`{key}` is not among the parameter specs of this table"))
            .1
    }

    /// Keys and SI values in the order of the specs.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.entries.iter().copied()
    }
}

impl FromIterator<(&'static str, f64)> for ParamTable {
    fn from_iter<I: IntoIterator<Item = (&'static str, f64)>>(values: I) -> Self {
        let mut table = Self::new();
        values.into_iter().for_each(|(key, value)| table.set(key, value));
        table
    }
}
