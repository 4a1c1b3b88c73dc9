//! What an accelerometer in a body reads, with the errors of its clock and its scale.

use resistive::{Accelerometer, Impact};

use crate::forward::Scatter;

/// Longer than any impact (s): what has not stopped then never does.
pub(super) const DURATION: f64 = 10.0;

/// Readings (m/s²) of `impact` at `times` (s), in rising order.
pub(super) fn readings(
    impact: &Impact,
    times: &[f64],
    scatter: &Scatter,
) -> Result<Vec<f64>, String> {
    let times: Vec<f64> = times.iter().map(|time| time + scatter.clock).collect();
    let (before, after) = times.split_at(times.partition_point(|&time| time < 0.0));
    let backward: Vec<f64> = before.iter().rev().copied().collect();
    let mut felt = impact.felt_in_flight(&backward).map_err(|error| error.to_string())?;
    felt.reverse();
    let mut seen = Accelerometer::at(after, impact.bed().gravity);
    // What is not read is not integrated: a body in water comes to no rest.
    let last = after.last().map_or(0.0, |last| last.min(DURATION));
    impact.run(last, &mut seen).map_err(|error| error.to_string())?;
    felt.extend(seen.into_readings());
    let scaled = felt.iter().map(|reading| reading * (1.0 + scatter.scale));
    Ok(scaled.collect())
}
