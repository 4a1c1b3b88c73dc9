//! Downward velocity over time, as a Doppler velocimeter or a light gate reads it.

use configs::Diagnostic;
use engine::units::Dimension;

use super::columns::ColumnSpec;
use super::conditions::ConditionPlaces;
use super::contradiction::{Contradiction, ContradictionKind};
use super::curve::{Along, Axis, Curve, Written};
use super::findings::Findings;
use super::median;
use super::reading::Reading;
use super::smooth::slope;
use super::{Condition, Kind, MeasurementSet, Run, over_time};

static OF_MANY: [ColumnSpec; 4] =
    over_time::columns("velocity", "sigma_velocity", Dimension::SPEED, true);
static OF_ONE: [ColumnSpec; 4] =
    over_time::columns("velocity", "sigma_velocity", Dimension::SPEED, false);

/// The line of the kind.
pub(super) static CURVE: Curve = Curve {
    kind: Kind::Velocity,
    word: "velocity",
    plural: "velocities over time",
    function: "v(t)",
    along: Along::Time,
    value: Axis { name: "velocity", unit: "m/s", scale: 1.0 },
    files: "velocities",
    columns: [&OF_MANY, &OF_ONE],
    sigma_key: "velocity_sigma_m_s",
    sigma: |instrument| instrument.velocity_sigma,
    lacks_speed: "no run has velocities before contact, counted downward, that would show it",
    shown_speed,
    check,
};

/// Greatest velocity over that of the stated speed and a fall by a diameter, beyond which a unit is wrong.
const MOST: f64 = 2.0;

/// Readings before contact that show how a velocity grows, at least.
const FALLING: usize = 6;

/// Growth of the velocity over gravity before contact, at least and at most, beyond which a unit is wrong; and the largest
/// error of it that counts.
const GROWTH: [f64; 2] = [0.2, 5.0];
const KNOWN: f64 = 0.05;

/// From the readings before contact, each brought forward to it in free fall.
fn shown_speed(set: &MeasurementSet, condition: &Condition, run: &Run) -> Option<Reading> {
    // How fast a body falls in a fluid depends on the speed that is looked for: there a set states it.
    let is_dry = set.bed_of(condition).stated.fluid.is_none();
    let fall = set.bed_of(condition).gravity;
    let before = run.samples.iter().filter(|one| one.at < 0.0);
    let each: Vec<Reading> = before
        .map(|one| Reading {
            value: one.value - fall * one.at,
            se: one.sigma.or(set.instrument.velocity_sigma).unwrap_or(0.0),
        })
        .collect();
    let speed = Reading::mean(each.iter().copied());
    (is_dry && !each.is_empty() && speed.value > 0.0).then_some(speed)
}

fn check(
    set: &MeasurementSet,
    (places, columns): Written<'_>,
    findings: &mut Findings,
) -> Vec<Contradiction> {
    let why = "a velocity is read along one axis, which has to be that of the motion";
    over_time::check_vertical(set, places, ("velocities", why), findings);
    over_time::check_times(set, places, findings);
    if findings.errors() > 0 {
        return Vec::new();
    }
    let largest = |run: &Run| {
        let values = run.samples.iter().map(|one| one.value);
        values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    };
    let all = set.runs.len();
    let contrary: Vec<&Run> = set.runs.iter().filter(|run| largest(run) < 0.0).collect();
    if 2 * contrary.len() > all {
        let n = contrary.len();
        findings.report(
            Diagnostic::error(format!(
                "the velocity is negative where it is largest in {n} of {all} runs"
            ))
            .at(places[contrary[0].condition].id, "a velocity counts downward")
            .help(format!(
                "does it count upward? then say below [columns]: {}",
                columns.turned("velocity", "m/s")
            )),
        );
        return Vec::new();
    }
    if let Some(wrong) = check_fall(set, places) {
        return vec![wrong];
    }
    let ratio = |run: &Run| {
        let condition = &set.conditions[run.condition];
        let fall = (2.0 * set.gravity_of(run) * condition.diameter).sqrt();
        largest(run) / (condition.speed + fall)
    };
    let told = |ratio| {
        format!(
            "the largest velocities are {ratio:.1} times those of the stated speed and a fall by a diameter"
        )
    };
    let help = "are they in mm/s or cm/s?";
    over_time::check_unit(set, places, (MOST, ratio), (told, help)).into_iter().collect()
}

/// Names units with which no body falls: before contact a velocity grows at gravity.
fn check_fall(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let growth = |run: &Run| {
        let is_dry = set.bed_of(&set.conditions[run.condition]).stated.fluid.is_none();
        let gravity = set.gravity_of(run);
        let before = || run.samples.iter().filter(|one| one.at < 0.0);
        let sigma = set.instrument.velocity_sigma.unwrap_or(0.0);
        let slope = slope(before().map(|one| (one.at, one.value)), sigma);
        let ratio = slope.value / gravity;
        let is_known = slope.se < KNOWN * slope.value.abs().max(gravity);
        (is_dry && gravity > 0.0 && is_known && before().count() >= FALLING).then_some(ratio)
    };
    let (ratio, run) = median::of_runs(set, growth)?;
    let condition = set.runs[run].condition;
    let [least, most] = GROWTH;
    let (times, how) = match ratio.abs() < 1.0 {
        true => (ratio.abs().recip(), "slowly"),
        false => (ratio.abs(), "fast"),
    };
    (!(least..=most).contains(&ratio)).then(|| Contradiction {
        kind: ContradictionKind::Speeds,
        diagnostic: Diagnostic::error(format!(
            "before contact the velocities grow {times:.0} times as {how} as in a fall"
        ))
        .at(places[condition].id, "measured under this condition")
        .help("are the velocities in cm/s or mm/s, or the times in ms? [columns] gives the units of a table"),
    })
}
