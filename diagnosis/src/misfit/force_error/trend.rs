//! Whether a force error rises or falls with what was varied.

use serde::Serialize;

use super::normal::{NODES, Normal, solve};
use super::part::p_value;
use crate::misfit::covariate::{Covariate, DEPTH};
use crate::rounding::six_digits;

/// A straight line of the force error over a covariate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trend {
    /// What was varied: `speed`, `angle_deg`, `z`, `order`, …
    pub over: &'static str,
    /// Unit of its values; 1 where it has none.
    pub unit: &'static str,
    /// How many conditions (over `order` and `previous_run`, runs) the line runs through.
    pub n: usize,
    /// Middle of the values (in their unit).
    #[serde(serialize_with = "six_digits")]
    pub centre: f64,
    /// Force error there (1 = 100 %).
    #[serde(serialize_with = "six_digits")]
    pub force_error: f64,
    /// Change of the force error per unit.
    #[serde(serialize_with = "six_digits")]
    pub slope: f64,
    /// Its standard error.
    #[serde(serialize_with = "six_digits")]
    pub se: f64,
    /// Probability of a slope as large by chance, of either sign.
    #[serde(serialize_with = "six_digits")]
    pub p: f64,
    /// Whether it is a discovery at a rate of 5 % false ones.
    pub significant: bool,
}

/// Over depth, if every condition tells its depths apart.
pub(super) fn over_depth(normals: &[Normal]) -> Option<Trend> {
    let resolved = normals.iter().all(|normal| normal.resolved);
    resolved.then(|| line(normals, DEPTH, |normal, node| Some(normal.depth(node))))?
}

/// Over a covariate of the conditions that has `value` in each, if it was varied.
pub(super) fn over_conditions(
    normals: &[Normal],
    over: Covariate,
    value: impl Fn(usize) -> Option<f64>,
) -> Option<Trend> {
    line(normals, over, |normal, _| value(normal.condition))
}

/// The line through what has a value.
fn line(
    normals: &[Normal],
    over: Covariate,
    value: impl Fn(&Normal, usize) -> Option<f64>,
) -> Option<Trend> {
    let values =
        || normals.iter().flat_map(|normal| (0..NODES).filter_map(|node| value(normal, node)));
    let low = values().fold(f64::INFINITY, f64::min);
    let high = values().fold(f64::NEG_INFINITY, f64::max);
    if low >= high {
        return None;
    }
    // From -1 to 1, so that both unknowns are of one size.
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let coefficient = |normal: &Normal, node: usize, unknown: usize| {
        let place = value(normal, node).map(|value| (value - centre) / half);
        place.map_or(0.0, |place| if unknown == 0 { 1.0 } else { place })
    };
    let solved = solve(normals, 2, coefficient)?;
    let ((force_error, _), (slope, se)) = (solved.get(0)?, solved.get(1)?);
    let has_value = |normal: &&Normal| (0..NODES).any(|node| value(normal, node).is_some());
    Some(Trend {
        over: over.name,
        unit: over.unit,
        n: normals.iter().filter(has_value).count(),
        centre,
        force_error,
        slope: slope / half,
        se: se / half,
        p: p_value(slope, se),
        significant: false,
    })
}
