//! What readings of any kind over time have to be: of one body, and in order.

use configs::{Diagnostic, shorten};

use super::MeasurementSet;
use super::conditions::ConditionPlaces;
use super::findings::Findings;

/// Refuses impacts that are not straight down, and bodies of two parts; `what` was read, and `why` tells the reason.
pub(super) fn check_vertical(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    (what, why): (&str, &str),
    findings: &mut Findings,
) {
    for (condition, place) in set.conditions.iter().zip(places) {
        let id = shorten(&condition.id);
        if condition.angle_deg < 90.0 || condition.shape.contains("link") {
            let message = format!("the {what} of `{id}` are not of a vertical impact of one body");
            findings.report(Diagnostic::error(message).at(place.angle, "expected 90").help(why));
        }
    }
}

/// Refuses times that do not rise.
pub(super) fn check_times(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    findings: &mut Findings,
) {
    for run in &set.runs {
        if !findings.full() && run.samples.windows(2).any(|pair| pair[0].at >= pair[1].at) {
            let name = shorten(&run.name);
            findings.report(
                Diagnostic::error(format!("the time does not go on in the run `{name}`"))
                    .at(places[run.condition].id, "measured under this condition")
                    .help("the times of a run rise from row to row"),
            );
        }
    }
}
