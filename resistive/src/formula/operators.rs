//! The operators of formulas, on numbers and on dimensions.
//!
//! Numbers go by `libm`, whose bits are the same everywhere; priorities are those of `exmex`, under which
//! a division binds before a product, so that `a * b / c` is `a * (b / c)`.

use exmex::{BinOp, MakeOperators, MatchLiteral, Operator};

use super::quantity::Quantity;
use super::syntax::number_length;

/// Whole powers up to this one are products.
const MOST_PRODUCTS: f64 = 16.0;

/// The operators on numbers.
#[derive(Clone, Debug)]
pub(super) struct Numeric;

/// The operators on dimensions.
#[derive(Clone, Debug)]
pub(super) struct Symbolic;

/// Numbers with fraction and exponent.
#[derive(Clone, Debug)]
pub(super) struct Literals;

impl MatchLiteral for Literals {
    fn is_literal(text: &str) -> Option<&str> {
        text.get(..number_length(text)).filter(|number| !number.is_empty())
    }
}

/// Operators of a function of one argument.
macro_rules! functions {
    ($($name:literal: $apply:expr),* $(,)?) => {
        [$(Operator::make_unary($name, $apply)),*]
    };
}

impl MakeOperators<f64> for Numeric {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let mut all = vec![
            Operator::make_bin("^", binary(power, 4)),
            Operator::make_bin("*", BinOp { is_commutative: true, ..binary(|a, b| a * b, 2) }),
            Operator::make_bin("/", binary(|a, b| a / b, 3)),
            Operator::make_bin_unary(
                "+",
                BinOp { is_commutative: true, ..binary(|a, b| a + b, 0) },
                |a| a,
            ),
            Operator::make_bin_unary("-", binary(|a, b| a - b, 1), |a| -a),
            Operator::make_bin("min", binary(libm::fmin, 0)),
            Operator::make_bin("max", binary(libm::fmax, 0)),
            Operator::make_constant("pi", std::f64::consts::PI),
        ];
        all.extend(functions![
            "abs": f64::abs, "sign": sign, "sqrt": f64::sqrt, "cbrt": libm::cbrt,
            "exp": libm::exp, "ln": libm::log, "log10": libm::log10,
            "sin": libm::sin, "cos": libm::cos, "tan": libm::tan,
            "asin": libm::asin, "acos": libm::acos, "atan": libm::atan,
            "sinh": libm::sinh, "cosh": libm::cosh, "tanh": libm::tanh,
        ]);
        all
    }
}

impl MakeOperators<Quantity> for Symbolic {
    fn make<'a>() -> Vec<Operator<'a, Quantity>> {
        let mut all = vec![
            Operator::make_bin("^", binary(Quantity::power, 4)),
            Operator::make_bin("*", binary(Quantity::times, 2)),
            Operator::make_bin("/", binary(Quantity::over, 3)),
            Operator::make_bin_unary("+", binary(Quantity::plus, 0), |a| a),
            Operator::make_bin_unary("-", binary(Quantity::minus, 1), Quantity::negative),
            Operator::make_bin("min", binary(|a, b| a.either("min", b), 0)),
            Operator::make_bin("max", binary(|a, b| a.either("max", b), 0)),
            Operator::make_constant("pi", Quantity::number("pi", std::f64::consts::PI)),
        ];
        all.extend(functions![
            "abs": |a: Quantity| a.size("abs"), "sign": Quantity::sign,
            "sqrt": |a: Quantity| a.root("sqrt", 2.0), "cbrt": |a: Quantity| a.root("cbrt", 3.0),
            "exp": |a: Quantity| a.pure("exp"), "ln": |a: Quantity| a.pure("ln"),
            "log10": |a: Quantity| a.pure("log10"),
            "sin": |a: Quantity| a.pure("sin"), "cos": |a: Quantity| a.pure("cos"),
            "tan": |a: Quantity| a.pure("tan"),
            "asin": |a: Quantity| a.pure("asin"), "acos": |a: Quantity| a.pure("acos"),
            "atan": |a: Quantity| a.pure("atan"),
            "sinh": |a: Quantity| a.pure("sinh"), "cosh": |a: Quantity| a.pure("cosh"),
            "tanh": |a: Quantity| a.pure("tanh"),
        ]);
        all
    }
}

fn binary<T: Clone>(apply: fn(T, T) -> T, prio: i64) -> BinOp<T> {
    BinOp { apply, prio, is_commutative: false }
}

/// Zero at zero, which `f64::signum` is not.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

fn power(base: f64, exponent: f64) -> f64 {
    match exponent.fract() == 0.0 && exponent.abs() <= MOST_PRODUCTS {
        true => base.powi(exponent as i32),
        false => libm::pow(base, exponent),
    }
}

#[cfg(test)]
mod tests {
    use super::super::FUNCTIONS;
    use super::*;

    #[test]
    fn numbers_and_dimensions_know_the_functions_that_are_listed() {
        let functions = |names: Vec<&'static str>| {
            let mut all: Vec<&str> =
                names.into_iter().filter(|name| name.starts_with(char::is_alphabetic)).collect();
            all.sort_unstable();
            all
        };
        let mut listed: Vec<&str> = FUNCTIONS.iter().map(|(name, _)| *name).chain(["pi"]).collect();
        listed.sort_unstable();
        assert_eq!(functions(Numeric::make().iter().map(Operator::repr).collect()), listed);
        assert_eq!(functions(Symbolic::make().iter().map(Operator::repr).collect()), listed);
    }
}
