//! Formulas of any text, and of arithmetic that is known.

use proptest::prelude::*;
use resistive::formula::Formula;

const VARIABLES: [&str; 3] = ["z", "v", "rho"];
const VALUES: [f64; 3] = [0.02, 1.5, 3.0];

/// A formula as text, with every operation in parentheses, and its value.
fn tree() -> impl Strategy<Value = (String, f64)> {
    let leaf = prop_oneof![
        (0..3_usize).prop_map(|index| (VARIABLES[index].to_owned(), VALUES[index])),
        (1..999_u32).prop_map(|n| (format!("{n}e-2"), f64::from(n) / 1e2)),
    ];
    leaf.prop_recursive(5, 60, 2, |inner| {
        let binary = prop::sample::select(vec!['+', '-', '*', '/']);
        prop_oneof![
            (inner.clone(), binary, inner.clone()).prop_map(|((a, x), operator, (b, y))| {
                let value = match operator {
                    '+' => x + y,
                    '-' => x - y,
                    '*' => x * y,
                    _ => x / y,
                };
                (format!("({a} {operator} {b})"), value)
            }),
            inner.clone().prop_map(|(a, x)| (format!("sqrt(abs({a}))"), x.abs().sqrt())),
            inner.clone().prop_map(|(a, x)| (format!("-({a})"), -x)),
            (inner.clone(), inner).prop_map(|((a, x), (b, y))| {
                // What is inside a second argument may choose no more.
                match b.contains("max") {
                    true => (format!("({a})"), x),
                    false => (format!("max({a}, {b})"), libm::fmax(x, y)),
                }
            }),
        ]
    })
}

/// The value of `text` where the variables have [`VALUES`].
fn value(formula: &Formula) -> f64 {
    let values: Vec<f64> = formula
        .variables()
        .iter()
        .map(|name| VALUES[VARIABLES.iter().position(|one| one == name).expect("known")])
        .collect();
    formula.value(&values)
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC*") {
        if let Err(error) = Formula::parse(&text, &VARIABLES) {
            prop_assert!(error.at.end <= text.len());
            prop_assert!(text.get(error.at.clone()).is_some(), "{:?} cuts a character", error.at);
        }
    }

    #[test]
    fn no_text_that_looks_like_a_formula_makes_the_reader_panic_or_answer_twice(
        text in "([zv]|rho|pi|[0-9]{1,2}|\\.|[-+*/^(), ]|sin\\(|max\\(|min\\(|1e[-+]?[0-9]){1,24}",
    ) {
        if let Ok(formula) = Formula::parse(&text, &VARIABLES) {
            prop_assert_eq!(value(&formula).to_bits(), value(&formula).to_bits());
        }
    }

    #[test]
    fn a_formula_is_the_arithmetic_that_it_says((text, expected) in tree()) {
        let formula = Formula::parse(&text, &VARIABLES).map_err(|error| {
            TestCaseError::fail(format!("{text}: {error}"))
        })?;
        let found = value(&formula);
        let equal = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
        prop_assert!(equal, "{text} is {expected}, not {found}");
    }
}
