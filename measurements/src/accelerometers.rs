//! What no accelerometer in a falling body reads: order, signs, zeros and units.

use configs::Diagnostic;

use super::conditions::ConditionPlaces;
use super::contradiction::Contradiction;
use super::findings::Findings;
use super::{MeasurementSet, Run, over_time};

/// Share of gravity by which a reading before contact may miss that of free fall.
const FALLING: f64 = 0.5;

/// Change of the velocity over that of a stop from the stated speed, beyond which a unit is wrong.
const MOST: f64 = 3.0;

/// Refuses what is no vertical impact, times that run back and signs; names zeros and units.
pub(super) fn check(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    findings: &mut Findings,
) -> Vec<Contradiction> {
    let why = "an accelerometer reads along its own axis, which has to be that of the motion";
    over_time::check_vertical(set, places, ("accelerations", why), findings);
    over_time::check_times(set, places, findings);
    if findings.errors() == 0 {
        check_signs(set, places, findings);
    }
    match findings.errors() {
        0 => check_units(set, places).into_iter().collect(),
        _ => Vec::new(),
    }
}

/// Refuses readings that count downward, or from another zero.
fn check_signs(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    let largest = |run: &Run| {
        let after = run.samples.iter().filter(|one| one.at > 0.0).map(|one| one.value);
        after.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    };
    let all = set.runs.len();
    let contrary: Vec<&Run> = set.runs.iter().filter(|run| largest(run) < 0.0).collect();
    if 2 * contrary.len() > all {
        findings.report(
            Diagnostic::error(format!(
                "the acceleration is negative where it is largest in {} of {all} runs",
                contrary.len()
            ))
            .at(places[contrary[0].condition].id, "the bed pushes upward")
            .help(
                "does it count downward? then say below [columns]: \
                 acceleration = { name = \"acceleration\", unit = \"m/s^2\", sign = -1 }",
            ),
        );
        return;
    }
    let gravity = set.all_beds().map(|bed| bed.gravity).fold(0.0, f64::max);
    let before = || set.runs.iter().flat_map(|run| &run.samples).filter(|one| one.at < 0.0);
    let n = before().count();
    let mean = before().map(|one| one.value).sum::<f64>() / n.max(1) as f64;
    let falls_freely = set.all_beds().all(|bed| bed.stated.fluid.is_none());
    if n > 0 && falls_freely && mean.abs() > FALLING * gravity {
        findings.report(
            Diagnostic::error(format!(
                "the readings before contact are {mean:.2} m/s^2, and those of a body in free fall are 0"
            ))
            .at(places[0].id, "t = 0 is first contact")
            .help(
                "an accelerometer reads 0 in free fall and gravity at rest; `zero` below [columns] says what \
                 this one reads in free fall",
            ),
        );
    }
}

/// Names a unit with which bodies would be slowed down by far more than their speed.
fn check_units(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let ratio = |run: &Run| {
        let (condition, gravity) = (&set.conditions[run.condition], set.gravity_of(run));
        let pairs = run.samples.windows(2).filter(|pair| pair[0].at >= 0.0);
        let change = pairs.map(|pair| {
            let felt = 0.5 * (pair[0].value + pair[1].value);
            (pair[1].at - pair[0].at) * (felt - gravity)
        });
        let possible = condition.speed + (gravity * condition.diameter).sqrt();
        change.sum::<f64>() / possible
    };
    let told = |ratio| format!("the accelerations take {ratio:.1} times the speed at contact away");
    let help = "are they in g, or the times in ms?";
    over_time::check_unit(set, places, (MOST, ratio), (told, help))
}
