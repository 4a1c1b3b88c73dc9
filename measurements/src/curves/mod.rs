//! The kinds of curves that a set may hold.

pub(crate) mod acceleration;
pub(crate) mod accelerometers;
pub(crate) mod angular_velocity;
pub(crate) mod curve;
pub(crate) mod force_depth;
pub(crate) mod over_time;
pub(crate) mod pushes;
pub(crate) mod velocity;

use crate::Kind;
use crate::curves::curve::Curve;

/// Every kind; a line here makes one known.
static CURVES: [&Curve; 4] =
    [&force_depth::CURVE, &acceleration::CURVE, &velocity::CURVE, &angular_velocity::CURVE];

/// Every kind of curve.
pub fn curves() -> impl Iterator<Item = &'static Curve> {
    CURVES.into_iter()
}

impl Kind {
    /// What is known of the kind, if its runs are curves.
    #[must_use]
    pub fn curve(self) -> Option<&'static Curve> {
        CURVES.into_iter().find(|curve| curve.kind == self)
    }

    /// Whether runs have readings along their way.
    #[must_use]
    pub fn has_readings(self) -> bool {
        self != Self::Scalar
    }

    /// The words for all kinds.
    pub(crate) fn words() -> Vec<&'static str> {
        ["trajectory", "scalar"].into_iter().chain(CURVES.map(|curve| curve.word)).collect()
    }

    /// The kind that `word` is of, of curves.
    pub(crate) fn of_curve(word: &str) -> Option<Self> {
        CURVES.into_iter().find(|curve| curve.word == word).map(|curve| curve.kind)
    }
}
