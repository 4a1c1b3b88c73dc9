//! Force errors over parts of what was varied.

use serde::Serialize;

use crate::rounding::six_digits;

/// A force error over a part of what was varied.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForceError {
    /// What was varied: `speed`, `angle_deg`, `z`, …
    pub over: &'static str,
    /// Least value of the part (SI, angles in degrees).
    #[serde(serialize_with = "six_digits")]
    pub from: f64,
    /// Greatest value.
    #[serde(serialize_with = "six_digits")]
    pub to: f64,
    /// By how much the force is larger than the model has it (1 = 100 %).
    #[serde(serialize_with = "six_digits")]
    pub force_error: f64,
    /// Its standard error.
    #[serde(serialize_with = "six_digits")]
    pub se: f64,
}

/// A force error and whether to believe it.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The error.
    pub error: ForceError,
    /// Whether it is a discovery at a rate of 5 % false ones.
    pub significant: bool,
}

/// A force error in one condition around one depth.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceCell {
    /// Index of the condition in the set.
    pub condition: usize,
    /// Where the part of the path begins (m).
    pub from: f64,
    /// Where it ends (m).
    pub to: f64,
    /// By how much the force is larger than the model has it (1 = 100 %).
    pub force_error: f64,
    /// Its standard error.
    pub se: f64,
    /// Whether it is a discovery at a rate of 5 % false ones.
    pub significant: bool,
}

/// Two-sided, of a normal number.
pub(super) fn p_value(value: f64, se: f64) -> f64 {
    if se > 0.0 { libm::erfc((value / se).abs() / std::f64::consts::SQRT_2) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::p_value;

    #[test]
    fn an_error_of_1_96_standard_errors_of_either_sign_happens_once_in_twenty() {
        for value in [1.959964, -1.959964] {
            assert!((p_value(value, 1.0) - 0.05).abs() < 1e-6);
        }
        assert!((p_value(0.0, 1.0) - 1.0).abs() < 1e-12 && p_value(1.0, 0.0) > 0.99);
    }
}
