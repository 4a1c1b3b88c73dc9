//! Formulas of named variables in a model file: read once, checked for their dimension, evaluated many
//! times.
//!
//! `exmex` reads and evaluates them; `syntax` goes before it and points at what is wrong, `operators`
//! gives it arithmetic of `libm`, and `quantity` the same operators on dimensions.

mod operators;
mod quantity;
mod syntax;

use std::sync::Arc;

use engine::units::Dimension;
use exmex::{Express, FlatEx};

use operators::{Literals, Numeric, Symbolic};
pub use quantity::DimensionError;
use quantity::Quantity;
pub use syntax::{FUNCTIONS, FormulaError, MOST_DEPTH, MOST_NODES, SyntaxError, is_reserved};

/// A formula that was read.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    parsed: Arc<FlatEx<f64, Numeric, Literals>>,
}

/// What is known of a variable before any value: its dimension, and its value where that never changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Angles count as pure numbers.
    pub dimension: Dimension,
    /// (SI).
    pub constant: Option<f64>,
}

impl Formula {
    /// Reads `text`, which may use `variables`.
    ///
    /// # Errors
    /// If it is no formula, uses anything else, or is too large.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, FormulaError> {
        syntax::check(text, variables)?;
        let parsed = FlatEx::parse(&spaced(text)).map_err(|why| FormulaError {
            at: 0..text.len(),
            fault: SyntaxError::Other(why.to_string()),
        })?;
        Ok(Self { text: text.to_owned(), parsed: Arc::new(parsed) })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The variables that it uses, in the order in which [`Self::value`] takes their values.
    pub fn variables(&self) -> &[String] {
        self.parsed.var_names()
    }

    /// Its value; NaN if `values` are not one per variable.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.parsed.eval(values).unwrap_or(f64::NAN)
    }

    /// Whether its value is a quantity of the dimension `wanted`.
    ///
    /// # Errors
    /// If it is another, or if some step of it means nothing: a length plus a speed, the sine of a mass.
    pub(crate) fn check_dimension(
        &self,
        wanted: Dimension,
        known: impl Fn(&str) -> Known,
    ) -> Result<(), DimensionError> {
        let quantities: Vec<Quantity> = self
            .variables()
            .iter()
            .map(|name| {
                let Known { dimension, constant } = known(name);
                Quantity::named(name, dimension, constant)
            })
            .collect();
        let symbolic = FlatEx::<Quantity, Symbolic, Literals>::parse(&spaced(&self.text));
        let found = symbolic.and_then(|symbolic| symbolic.eval(&quantities)).ok();
        // The same text was read as numbers.
        found.map_or(Ok(()), |found| found.expect(wanted))
    }
}

/// The text with a blank for every line break and tabulator: `exmex` knows no other white space.
fn spaced(text: &str) -> String {
    text.replace(|c: char| c.is_ascii_whitespace(), " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEED: Known = Known { dimension: Dimension::SPEED, constant: None };

    fn value(text: &str) -> f64 {
        Formula::parse(text, &["a", "b"]).unwrap_or_else(|e| panic!("{text}: {e}")).value(&[])
    }

    fn dimension(text: &str, wanted: Dimension) -> String {
        let formula = Formula::parse(text, &["v", "z", "n"]).unwrap_or_else(|e| panic!("{e}"));
        let known = |name: &str| match name {
            "v" => SPEED,
            "z" => Known { dimension: Dimension::LENGTH, constant: None },
            _ => Known { dimension: Dimension::NONE, constant: Some(1.5) },
        };
        match formula.check_dimension(wanted, known) {
            Ok(()) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn arithmetic_is_that_of_school() {
        // What has an exact value has it; the others are two roundings away.
        for (text, expected) in [
            ("1 + 2 * 3 - 4 / 8", 6.5),
            ("2 - 3 - 4", -5.0),
            ("16 / 4 / 2", 2.0),
            ("2 * 3 / 4 * 2", 3.0),
            ("-(2^2)", -4.0),
            ("2^-1 * 8", 4.0),
            ("(-2)^2 + -1", 3.0),
            ("max(min(3, 2), 1) * 2", 4.0),
            ("1.5e-3 * 2e3 + .5", 3.5),
            ("sqrt(abs(-9)) - exp(0)", 2.0),
            ("cos(2 * pi) +\n\tsign(-3)", 0.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-15, "{text} is {}", value(text));
        }
    }

    #[test]
    fn what_does_not_fit_is_said_by_its_parts() {
        assert_eq!(dimension("v^2 / z", Dimension::ACCELERATION), "");
        assert_eq!(
            dimension("max(v, 0) * sqrt(z * z)^n", Dimension::NONE),
            dimension("v * z^n", Dimension::NONE)
        );
        assert_eq!(dimension("exp(z / z) * v", Dimension::SPEED), "");
        assert_eq!(
            dimension("2 * v + z", Dimension::SPEED),
            "`2 * v` is a speed (m/s) and `z` is a length (m): they cannot be added"
        );
        assert_eq!(
            dimension("sin(z * v)", Dimension::NONE),
            "`sin` wants a pure number, and `z * v` is a quantity in m^2*s^-1"
        );
        assert_eq!(
            dimension("v^z", Dimension::SPEED),
            "the exponent `z` is a length (m); expected a pure number"
        );
        assert_eq!(
            dimension("(1 + v / v)^(z / z) * v^(v / v)", Dimension::SPEED),
            "`v` is a speed (m/s), so its exponent must be a number, and `v / v` changes"
        );
        assert_eq!(
            dimension("v * z", Dimension::FORCE),
            "this is a quantity in m^2*s^-1; expected a force (N)"
        );
    }

    #[test]
    fn angles_are_pure_numbers_and_powers_need_not_be_halves() {
        assert_eq!(dimension("z^0.3 * z^0.7", Dimension::LENGTH), "");
        assert_eq!(dimension("sin(v / v)", Dimension::ANGLE), "");
    }
}
