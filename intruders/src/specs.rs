//! Parameters that several shapes take, and the measures of a round or a planar section.

use std::f64::consts::PI;

use engine::grains::Space;
use engine::params::{ParamSpec, Range};
use engine::units::Dimension;

/// The diameter (m) of a shape.
pub(crate) const DIAMETER: ParamSpec =
    length("diameter", Range::closed(1e-3, 1.0), "the diameter of the intruder");

/// A required length (m).
pub(crate) const fn length(
    key: &'static str,
    plausible: Range,
    meaning: &'static str,
) -> ParamSpec {
    ParamSpec::required(key, Dimension::LENGTH, meaning)
        .allowed(Range::POSITIVE)
        .plausible(plausible)
}

/// Area (m²) of a circle of radius `half` (m); planar, the width (m) of a strip.
pub(crate) fn section(half: f64, space: Space) -> f64 {
    match space {
        Space::Planar => 2.0 * half,
        Space::Spatial => PI * half * half,
    }
}
