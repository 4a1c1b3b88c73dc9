//! A case: an experiment whose answer is known.

use std::fmt;

/// An experiment whose answer is known from outside the program.
pub struct Case {
    /// kebab-case.
    pub name: &'static str,
    /// What holds, in one sentence.
    pub claim: &'static str,
    /// Makes the experiment.
    pub run: fn() -> Vec<Outcome>,
}

/// One row of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// What was measured, with its unit.
    pub what: String,
    /// What came out.
    pub measured: f64,
    /// What had to.
    pub expected: Expected,
    /// Where the tolerance or the limit comes from.
    pub why: &'static str,
}

/// What a measured value is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// A value, and how far from it is still right.
    Near {
        /// The value.
        value: f64,
        /// Largest distance from it.
        tolerance: f64,
    },
    /// No more than this in size: a residual whose right value is zero.
    AtMost(f64),
    /// No less than this: a ratio of errors.
    AtLeast(f64),
}

impl Outcome {
    /// A value that has to come out as `value` within `tolerance`.
    pub fn near(
        what: impl Into<String>,
        measured: f64,
        (value, tolerance): (f64, f64),
        why: &'static str,
    ) -> Self {
        Self { what: what.into(), measured, expected: Expected::Near { value, tolerance }, why }
    }

    /// A residual that has to stay within `limit`.
    pub fn at_most(what: impl Into<String>, measured: f64, limit: f64, why: &'static str) -> Self {
        Self { what: what.into(), measured, expected: Expected::AtMost(limit), why }
    }

    /// A ratio that has to reach `limit`.
    pub fn at_least(what: impl Into<String>, measured: f64, limit: f64, why: &'static str) -> Self {
        Self { what: what.into(), measured, expected: Expected::AtLeast(limit), why }
    }

    /// A line of a table in Markdown: what, measured, expected.
    pub fn markdown(&self) -> String {
        format!("| {} | {:.6e} | {} |", self.what, self.measured, self.expected)
    }

    /// Whether what was measured is right; what is not a number never is.
    pub fn holds(&self) -> bool {
        match self.expected {
            Expected::Near { value, tolerance } => (self.measured - value).abs() <= tolerance,
            Expected::AtMost(limit) => self.measured.abs() <= limit,
            Expected::AtLeast(limit) => self.measured >= limit,
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Near { value, tolerance } => write!(f, "{value:.6e} ± {tolerance:.1e}"),
            Self::AtMost(limit) => write!(f, "at most {limit:.1e}"),
            Self::AtLeast(limit) => write!(f, "at least {limit}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_never_holds() {
        for row in [
            Outcome::near("", f64::NAN, (0.0, 1.0), ""),
            Outcome::at_most("", f64::NAN, 1.0, ""),
            Outcome::at_least("", f64::NAN, 1.0, ""),
        ] {
            assert!(!row.holds(), "{row:?}");
        }
    }

    #[test]
    fn a_residual_is_judged_by_its_size() {
        assert!(Outcome::at_most("", -0.5, 1.0, "").holds());
        assert!(!Outcome::at_most("", -2.0, 1.0, "").holds());
    }
}
