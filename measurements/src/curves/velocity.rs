//! Downward velocity over time, as a Doppler velocimeter or a light gate reads it.

use configs::Diagnostic;
use engine::units::Dimension;

use crate::contact::smooth::slope;
use crate::contradiction::{Contradiction, ContradictionKind};
use crate::curves::curve::{Along, Axis, Curve, Written};
use crate::curves::over_time;
use crate::document::conditions::ConditionPlaces;
use crate::median;
use crate::reading::Reading;
use crate::table::columns::ColumnSpec;
use crate::table::findings::Findings;
use crate::{Condition, Kind, MeasurementSet, Run, Sample};

static OF_MANY: [ColumnSpec; 4] =
    over_time::columns("velocity", "sigma_velocity", Dimension::SPEED, true);
static OF_ONE: [ColumnSpec; 4] =
    over_time::columns("velocity", "sigma_velocity", Dimension::SPEED, false);

/// The line of the kind.
pub(crate) static CURVE: Curve = Curve {
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

/// Standard deviations of a reading below the line of free fall, and share of gravity that rails and air may take, from which
/// a body is braked.
const NOISE: f64 = 4.0;
const BRAKED: f64 = 0.15;

/// Relative difference from gravity up to which a growth of velocities is a fall.
const SHARE: f64 = 0.3;

/// Longest time between contact and a velocity that shows it, in times that a body takes for its diameter at the speed at
/// contact; and in steps between readings.
const SOON: f64 = 0.5;
const STEPS: f64 = 3.0;

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
    if let Some(wrong) = check_clock(set, places).or_else(|| check_fall(set, places)) {
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

/// When the velocities of `run` leave the line of its free fall; `None` where they show no such line.
fn leaves_fall(set: &MeasurementSet, run: &Run) -> Option<f64> {
    let gravity = set.gravity_of(run);
    let is_dry = set.bed_of(&set.conditions[run.condition]).stated.fluid.is_none();
    let all = &run.samples;
    let first = all.first().filter(|_| is_dry && gravity > 0.0 && all.len() > FALLING)?;
    let fallen = |one: &Sample| one.value - gravity * (one.at - first.at);
    let start = all[..FALLING].iter().map(fallen).sum::<f64>() / FALLING as f64;
    let sigma = |one: &Sample| one.sigma.or(set.instrument.velocity_sigma);
    // Rails and air may take a share of gravity away.
    let is_below = |one: &Sample| {
        let known = NOISE * sigma(one)? + BRAKED * gravity * (one.at - first.at);
        Some(fallen(one) < start - known)
    };
    let leaves = (FALLING..all.len().saturating_sub(2))
        .find(|&at| all[at..at + 3].iter().all(|one| is_below(one) == Some(true)))?;
    let slope = slope(all[..leaves].iter().map(|one| (one.at, one.value)), sigma(first)?);
    let falls = slope.value - 2.0 * slope.se < (1.0 + SHARE) * gravity
        && slope.value + 2.0 * slope.se > (1.0 - SHARE) * gravity;
    (falls && slope.se < SHARE * gravity).then_some(all[leaves - 1].at)
}

/// Names a clock that does not begin at first contact: bodies leave free fall long before or behind t = 0.
fn check_clock(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let contact = |run: &Run| {
        let at = leaves_fall(set, run)?;
        let steps = run.samples.windows(2).map(|pair| pair[1].at - pair[0].at);
        let step = median::median(steps)?;
        let of = &set.conditions[run.condition];
        let soon = (SOON * of.diameter / of.speed).max(STEPS * step);
        Some((at, at < -STEPS * step || at > soon))
    };
    over_time::check_clock(set, places, contact, |run, at| {
        format!("the velocities of `{run}` leave free fall at about t = {at:.4} s")
    })
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
