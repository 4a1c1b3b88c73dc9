//! In which unit the errors of a set are.

use measurements::Kind;
use serde::{Deserialize, Serialize};

use crate::forward::observable::Observable;
use crate::misfit::errors::Errors;

/// Unit of an error over several kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Unit {
    /// Positions (m).
    #[serde(rename = "m")]
    Position,
    /// Scalars, relative (1 = 100 %).
    #[serde(rename = "1")]
    Relative,
    /// Forces (N).
    #[serde(rename = "N")]
    Force,
    /// Accelerations (m/s²).
    #[serde(rename = "m/s^2")]
    Acceleration,
    /// Velocities (m/s).
    #[serde(rename = "m/s")]
    Velocity,
    /// Angular velocities (rad/s).
    #[serde(rename = "rad/s")]
    Spin,
}

impl Unit {
    /// Of errors on a set of this kind.
    pub fn of(kind: Kind) -> Self {
        match kind {
            Kind::Trajectory => Self::Position,
            Kind::Scalar => Self::Relative,
            Kind::ForceDepth => Self::Force,
            Kind::Acceleration => Self::Acceleration,
            Kind::Velocity => Self::Velocity,
            Kind::Spin => Self::Spin,
        }
    }

    /// An error (SI) as it is told.
    #[must_use]
    pub fn told(self, error: f64) -> String {
        match self {
            Self::Position => format!("{:.3} mm", 1e3 * error),
            Self::Relative => format!("{:.1} %", 1e2 * error),
            Self::Force => format!("{error:.3} N"),
            Self::Acceleration => format!("{error:.3} m/s²"),
            Self::Velocity => format!("{error:.4} m/s"),
            Self::Spin => format!("{error:.3} rad/s"),
        }
    }

    /// The one of `errors` that is in this unit, where there is one.
    #[must_use]
    pub fn pick(self, errors: &Errors) -> Option<f64> {
        match self {
            Self::Position => errors.position,
            Self::Relative => errors.relative,
            Self::Force => errors.of(Observable::Force),
            Self::Acceleration => errors.of(Observable::Acceleration),
            Self::Velocity => errors.of(Observable::Velocity),
            Self::Spin => errors.of(Observable::Spin),
        }
    }
}
