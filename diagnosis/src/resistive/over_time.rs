//! What is read over time of a body in a resistive medium, with the errors of its clock and its scale.

use resistive::{Accelerometer, Impact, State, Trajectory};

use crate::forward::Scatter;
use crate::forward::observable::{Curve, Observable};

/// Longer than any impact (s): what has not stopped then never does.
pub(super) const DURATION: f64 = 10.0;

/// Readings of `curve` in `impact`, whose times rise, in their order (SI).
pub(super) fn readings(
    impact: &Impact,
    curve: &Curve,
    scatter: &Scatter,
) -> Result<Vec<f64>, String> {
    let times: Vec<f64> = curve.at.iter().map(|time| time + scatter.clock).collect();
    let (before, after) = times.split_at(times.partition_point(|&time| time < 0.0));
    let backward: Vec<f64> = before.iter().rev().copied().collect();
    // What is not read is not integrated: a body in water comes to no rest.
    let last = after.last().map_or(0.0, |last| last.min(DURATION));
    let part = |state: &State| impact.assembly().part(0, state);
    let read = match curve.observable {
        Observable::Velocity => {
            moving(impact, [&backward, after], last, |state| -part(state).tip_velocity.z)
        }
        Observable::Spin => moving(impact, [&backward, after], last, |state| part(state).spin),
        _ => felt(impact, [&backward, after], last),
    };
    // Lengths are seen through the scale; a turn is not.
    let scale = match curve.observable {
        Observable::Spin => 0.0,
        _ => scatter.scale,
    };
    Ok(read?.iter().map(|reading| reading * (1.0 + scale)).collect())
}

/// What an accelerometer reads (m/s²) at times before contact, in falling order, and after it, up to the `last` (s).
fn felt(impact: &Impact, [backward, after]: [&[f64]; 2], last: f64) -> Result<Vec<f64>, String> {
    let mut felt = impact.felt_in_flight(backward).map_err(|error| error.to_string())?;
    felt.reverse();
    let mut seen = Accelerometer::at(after, impact.bed().gravity);
    impact.run(last, &mut seen).map_err(|error| error.to_string())?;
    felt.extend(seen.into_readings());
    Ok(felt)
}

/// What `of` tells of the state likewise.
fn moving(
    impact: &Impact,
    [backward, after]: [&[f64]; 2],
    last: f64,
    of: impl Fn(&State) -> f64,
) -> Result<Vec<f64>, String> {
    let mut flight = impact.flight(backward).map_err(|error| error.to_string())?;
    flight.reverse();
    let mut seen = Trajectory::at(after);
    impact.run(last, &mut seen).map_err(|error| error.to_string())?;
    Ok(flight.iter().chain(seen.states()).map(of).collect())
}
