//! The coefficients of a law: numbers, or expressions of what an impact is made with.

use engine::params::ParamTable;

use crate::formula::{Formula, FormulaError};

/// SI values of a law's parameters; some may be functions of depth.
#[derive(Clone, Debug, std::default::Default)]
pub struct Coefficients {
    numbers: ParamTable,
    functions: Vec<(&'static str, Expression)>,
}

impl Coefficients {
    /// Plain numbers.
    pub fn new(numbers: ParamTable) -> Self {
        Self { numbers, functions: Vec::new() }
    }

    /// The same with `key` as a function of the variable `depth` (m).
    #[must_use]
    pub fn with_function(mut self, key: &'static str, function: Expression) -> Self {
        self.functions.retain(|(name, _)| *name != key);
        self.functions.push((key, function));
        self
    }

    /// The SI value of `key`.
    ///
    /// # Panics
    /// If the table was not filled from the specs of whoever asks.
    pub fn get(&self, key: &str) -> f64 {
        self.numbers.get(key)
    }

    /// The function of depth that stands for `key`, if one does.
    pub fn function(&self, key: &str) -> Option<&Expression> {
        self.functions.iter().find(|(name, _)| *name == key).map(|(_, function)| function)
    }

    /// Whether `key` is a function of depth.
    pub fn is_function(&self, key: &str) -> bool {
        self.function(key).is_some()
    }

    /// `key` as a function of depth (m): the expression that was given, or a constant.
    pub(super) fn of_depth(&self, key: &str) -> OfDepth {
        match self.function(key) {
            Some(function) => OfDepth::Expression(function.clone()),
            None => OfDepth::Constant(self.get(key)),
        }
    }
}

/// A coefficient that may depend on depth.
#[derive(Clone, Debug)]
pub(super) enum OfDepth {
    Constant(f64),
    Expression(Expression),
}

impl OfDepth {
    /// The value at `depth` (m).
    pub(super) fn at(&self, depth: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Expression(expression) => expression.eval(&[("depth", depth)]),
        }
    }
}

/// A formula of named variables, in SI, some of which may have values already.
#[derive(Clone, Debug)]
pub struct Expression {
    formula: Formula,
    bound: Vec<(&'static str, f64)>,
}

impl Expression {
    /// Reads `text`, which may use `variables`.
    ///
    /// # Errors
    /// If it is no formula, or uses anything else.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, FormulaError> {
        Ok(Self { formula: Formula::parse(text, variables)?, bound: Vec::new() })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        self.formula.text()
    }

    /// Whether it uses `variable`.
    pub fn uses(&self, variable: &str) -> bool {
        self.formula.variables().iter().any(|name| name == variable)
    }

    /// The same with a value for `variable` wherever it is not given one.
    #[must_use]
    pub fn bind(mut self, variable: &'static str, value: f64) -> Self {
        self.bound.retain(|(name, _)| *name != variable);
        self.bound.push((variable, value));
        self
    }

    /// Its value; `variables` hold at least those that it uses and that are not bound, and NaN stands
    /// for any other.
    pub fn eval(&self, variables: &[(&str, f64)]) -> f64 {
        let values: Vec<f64> = self
            .formula
            .variables()
            .iter()
            .map(|name| {
                let found = variables.iter().chain(&self.bound).find(|(known, _)| known == name);
                found.map_or(f64::NAN, |(_, value)| *value)
            })
            .collect();
        self.formula.value(&values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expression_is_what_it_says() {
        let expression = Expression::parse("2 * depth^1.5 + 1", &["depth"]).unwrap();
        assert!((expression.eval(&[("depth", 4.0)]) - 17.0).abs() < 1e-14);
        assert!(expression.uses("depth") && !expression.uses("angle"));
    }

    #[test]
    fn a_bound_variable_need_not_be_given_and_may_be() {
        let expression = Expression::parse("depth * density", &["depth", "density"]).unwrap();
        let bound = expression.bind("density", 1.0).bind("density", 3.0);
        assert!((bound.eval(&[("depth", 2.0)]) - 6.0).abs() < 1e-14);
        assert!((bound.eval(&[("depth", 2.0), ("density", 5.0)]) - 10.0).abs() < 1e-14);
    }

    #[test]
    fn a_stranger_is_named_with_what_is_known() {
        let error = Expression::parse("dpeth", &["depth", "angle"]).unwrap_err();
        assert_eq!(error.to_string(), "`dpeth` is not known here; known: depth, angle");
    }
}
