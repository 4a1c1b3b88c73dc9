//! Dimensions as something that a formula can be evaluated with.

use std::str::FromStr;

use engine::units::Dimension;
use thiserror::Error;

/// Powers closer than this are equal: they are sums and products of decimal numbers.
const ROUND_OFF: f64 = 1e-9;

/// Why a formula has no dimension, or not the one that is wanted.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "each says itself what it is")]
pub enum DimensionError {
    #[error("`{left}` is {left_is} and `{right}` is {right_is}: they cannot be {verb}")]
    Unlike { left: String, left_is: String, right: String, right_is: String, verb: &'static str },
    #[error("`{function}` wants a pure number, and `{argument}` is {argument_is}")]
    NotPure { function: &'static str, argument: String, argument_is: String },
    #[error("the exponent `{exponent}` is {exponent_is}; expected a pure number")]
    Exponent { exponent: String, exponent_is: String },
    #[error("`{base}` is {base_is}, so its exponent must be a number, and `{exponent}` changes")]
    ChangingExponent { base: String, base_is: String, exponent: String },
    #[error("this is {found}; expected {wanted}")]
    Whole { found: String, wanted: String },
}

/// How tightly a text holds together when it becomes part of a larger one.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
enum Bond {
    Sum,
    Product,
    Power,
    Whole,
}

/// A step of a formula: its dimension, or what is wrong with it.
#[derive(Clone, Debug)]
pub(super) struct Quantity(Result<Step, DimensionError>);

#[derive(Clone, Debug)]
struct Step {
    /// Of kilogram, metre and second.
    powers: [f64; 3],
    /// Its value, where it is the same in every state.
    number: Option<f64>,
    text: String,
    bond: Bond,
}

impl Step {
    fn is_pure(&self) -> bool {
        self.powers.iter().all(|power| power.abs() < ROUND_OFF)
    }

    /// Zero is of every dimension.
    fn is_zero(&self) -> bool {
        self.is_pure() && self.number == Some(0.0)
    }

    fn is_like(&self, other: &Self) -> bool {
        self.powers.iter().zip(other.powers).all(|(a, b)| (a - b).abs() < ROUND_OFF)
    }

    fn describe(&self) -> String {
        describe(self.powers)
    }

    /// Its text as part of something that holds together as `bond` says.
    fn within(&self, bond: Bond) -> String {
        match self.bond < bond {
            true => format!("({})", self.text),
            false => self.text.clone(),
        }
    }

    fn in_function(&self, function: &str, powers: [f64; 3]) -> Quantity {
        Quantity::step(powers, None, format!("{function}({})", self.text), Bond::Whole)
    }
}

impl Default for Quantity {
    fn default() -> Self {
        Self::number("0", 0.0)
    }
}

impl FromStr for Quantity {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(Self::number(text, text.parse()?))
    }
}

impl Quantity {
    /// The pure number `value`, written as `text`.
    pub(super) fn number(text: &str, value: f64) -> Self {
        Self::step([0.0; 3], Some(value), text.to_owned(), Bond::Whole)
    }

    /// A variable.
    pub(super) fn named(name: &str, dimension: Dimension, constant: Option<f64>) -> Self {
        Self::step(powers(dimension), constant, name.to_owned(), Bond::Whole)
    }

    /// Whether this has the dimension `wanted`.
    pub(super) fn expect(self, wanted: Dimension) -> Result<(), DimensionError> {
        let found = self.0?;
        let wanted = Step { powers: powers(wanted), ..found.clone() };
        match found.is_like(&wanted) || found.is_zero() {
            true => Ok(()),
            false => {
                Err(DimensionError::Whole { found: found.describe(), wanted: wanted.describe() })
            }
        }
    }

    pub(super) fn times(self, other: Self) -> Self {
        self.with(other, |a, b| {
            let text = format!("{} * {}", a.within(Bond::Product), b.within(Bond::Product));
            Self::step(
                zip(a.powers, b.powers, |a, b| a + b),
                both(&a, &b, |a, b| a * b),
                text,
                Bond::Product,
            )
        })
    }

    pub(super) fn over(self, other: Self) -> Self {
        self.with(other, |a, b| {
            let text = format!("{} / {}", a.within(Bond::Product), b.within(Bond::Power));
            Self::step(
                zip(a.powers, b.powers, |a, b| a - b),
                both(&a, &b, |a, b| a / b),
                text,
                Bond::Product,
            )
        })
    }

    pub(super) fn plus(self, other: Self) -> Self {
        self.alike(other, "added", |a, b| {
            let text = format!("{} + {}", a.text, b.text);
            (both(a, b, |a, b| a + b), text, Bond::Sum)
        })
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.alike(other, "subtracted", |a, b| {
            let text = format!("{} - {}", a.text, b.within(Bond::Product));
            (both(a, b, |a, b| a - b), text, Bond::Sum)
        })
    }

    pub(super) fn either(self, function: &'static str, other: Self) -> Self {
        self.alike(other, "compared", |a, b| {
            (None, format!("{function}({}, {})", a.text, b.text), Bond::Whole)
        })
    }

    pub(super) fn negative(self) -> Self {
        self.map(|a| {
            let text = format!("-{}", a.within(Bond::Power));
            Self::step(a.powers, a.number.map(|a| -a), text, Bond::Product)
        })
    }

    pub(super) fn power(self, exponent: Self) -> Self {
        self.with(exponent, |base, exponent| {
            if !exponent.is_pure() {
                let exponent_is = exponent.describe();
                return Self(Err(DimensionError::Exponent {
                    exponent: exponent.text,
                    exponent_is,
                }));
            }
            let text = format!("{}^{}", base.within(Bond::Whole), exponent.within(Bond::Whole));
            let number = both(&base, &exponent, libm::pow);
            match exponent.number {
                _ if base.is_pure() => Self::step(base.powers, number, text, Bond::Power),
                Some(to) => {
                    Self::step(base.powers.map(|power| power * to), number, text, Bond::Power)
                }
                None => Self(Err(DimensionError::ChangingExponent {
                    base_is: base.describe(),
                    base: base.text,
                    exponent: exponent.text,
                })),
            }
        })
    }

    pub(super) fn root(self, function: &'static str, of: f64) -> Self {
        self.map(|a| a.in_function(function, a.powers.map(|power| power / of)))
    }

    pub(super) fn size(self, function: &'static str) -> Self {
        self.map(|a| a.in_function(function, a.powers))
    }

    pub(super) fn sign(self) -> Self {
        self.map(|a| a.in_function("sign", [0.0; 3]))
    }

    /// A function of pure numbers.
    pub(super) fn pure(self, function: &'static str) -> Self {
        self.map(|a| match a.is_pure() {
            true => a.in_function(function, a.powers),
            false => Self(Err(DimensionError::NotPure {
                function,
                argument_is: a.describe(),
                argument: a.text,
            })),
        })
    }

    fn step(powers: [f64; 3], number: Option<f64>, text: String, bond: Bond) -> Self {
        Self(Ok(Step { powers, number, text, bond }))
    }

    fn map(self, of: impl FnOnce(Step) -> Self) -> Self {
        match self.0 {
            Ok(step) => of(step),
            Err(error) => Self(Err(error)),
        }
    }

    fn with(self, other: Self, of: impl FnOnce(Step, Step) -> Self) -> Self {
        self.map(|a| other.map(|b| of(a, b)))
    }

    /// Both of one dimension, or one of them zero.
    fn alike(
        self,
        other: Self,
        verb: &'static str,
        of: impl FnOnce(&Step, &Step) -> (Option<f64>, String, Bond),
    ) -> Self {
        self.with(other, |a, b| {
            if !(a.is_like(&b) || a.is_zero() || b.is_zero()) {
                return Self(Err(DimensionError::Unlike {
                    left_is: a.describe(),
                    right_is: b.describe(),
                    left: a.text,
                    right: b.text,
                    verb,
                }));
            }
            let (number, text, bond) = of(&a, &b);
            Self::step(if a.is_zero() { b.powers } else { a.powers }, number, text, bond)
        })
    }
}

fn both(a: &Step, b: &Step, of: fn(f64, f64) -> f64) -> Option<f64> {
    Some(of(a.number?, b.number?))
}

fn zip(a: [f64; 3], b: [f64; 3], of: fn(f64, f64) -> f64) -> [f64; 3] {
    std::array::from_fn(|index| of(a[index], b[index]))
}

/// Angles are pure numbers here.
fn powers(dimension: Dimension) -> [f64; 3] {
    [dimension.kilogram_2, dimension.metre_2, dimension.second_2]
        .map(|twice| 0.5 * f64::from(twice))
}

/// `a speed (m/s)`, `a pure number`, `a quantity in m^0.3`.
fn describe(powers: [f64; 3]) -> String {
    Dimension::from_powers(powers).map_or_else(
        || {
            let atoms: Vec<String> = ["kg", "m", "s"]
                .iter()
                .zip(powers)
                .filter(|(_, power)| power.abs() >= ROUND_OFF)
                .map(|(atom, power)| format!("{atom}^{power}"))
                .collect();
            format!("a quantity in {}", atoms.join("*"))
        },
        Dimension::describe,
    )
}
