//! What no accelerometer in a falling body reads: order, signs, zeros and units.

use configs::{Diagnostic, shorten};

use crate::contradiction::{Contradiction, ContradictionKind};
use crate::curves::curve::Written;
use crate::curves::over_time;
use crate::document::conditions::ConditionPlaces;
use crate::table::findings::Findings;
use crate::{MeasurementSet, Run, Sample};

/// Share of gravity by which a reading before contact may miss that of free fall.
const FALLING: f64 = 0.5;

/// Change of the velocity over that of a stop from the stated speed, beyond which a unit is wrong.
const MOST: f64 = 3.0;

/// Share of the largest reading above which the bed brakes a body.
const BRAKED: f64 = 0.15;

/// Longest time between contact and such a reading, in times that a body takes for its diameter at the speed at contact.
const SOON: f64 = 1.5;

/// Readings at the end of a run that show what it reads at rest, and how far their mean and each of them may be from 1.
const AT_REST: usize = 8;
const SCATTER: f64 = 0.1;
const NOISE: f64 = 0.4;

/// Equal largest readings in a row that only the end of a range makes.
const FLAT: usize = 4;

/// Refuses what is no vertical impact, times that run back and signs; names zeros and units.
pub(crate) fn check(
    set: &MeasurementSet,
    (places, columns): Written<'_>,
    findings: &mut Findings,
) -> Vec<Contradiction> {
    let why = "an accelerometer reads along its own axis, which has to be that of the motion";
    over_time::check_vertical(set, places, ("accelerations", why), findings);
    over_time::check_times(set, places, findings);
    if findings.errors() == 0 {
        check_signs(set, (places, columns), findings);
        check_range(set, places, findings);
    }
    match findings.errors() {
        0 => check_clock(set, places)
            .or_else(|| check_rest(set, places))
            .or_else(|| check_units(set, places))
            .into_iter()
            .collect(),
        _ => Vec::new(),
    }
}

/// Refuses readings that count downward, or from another zero.
fn check_signs(set: &MeasurementSet, (places, columns): Written<'_>, findings: &mut Findings) {
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
            .help(format!(
                "does it count downward? then say below [columns]: {}",
                columns.turned("acceleration", "m/s^2")
            )),
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

/// Names a clock that does not begin at first contact: long before or behind t = 0 the readings rise.
fn check_clock(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    // The last reading of free fall before the largest one.
    let contact = |run: &Run| {
        let all = &run.samples;
        let peak = (0..all.len()).max_by(|&a, &b| all[a].value.total_cmp(&all[b].value))?;
        let low = |one: &&Sample| one.value < BRAKED * all[peak].value;
        let before = all[..peak].iter().rev().find(low)?;
        let of = &set.conditions[run.condition];
        let is_off = before.at.abs() > SOON * of.diameter / of.speed;
        (all[peak].value > set.gravity_of(run)).then_some((before.at, is_off))
    };
    over_time::check_clock(set, places, contact, |run, at| {
        format!("the readings of `{run}` rise at t = {at:.4} s")
    })
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

/// Refuses readings beyond the range of the accelerometer where the set does not state it.
fn check_range(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    if set.instrument.acceleration_range.is_some() {
        return;
    }
    let largest = |run: &Run| {
        let values = run.samples.iter().map(|one| one.value);
        values.fold(f64::NEG_INFINITY, f64::max)
    };
    let is_flat = |run: &&Run| {
        let top = largest(run);
        let is_top = |one: &Sample| one.value.to_bits() == top.to_bits();
        top > set.gravity_of(run) && run.samples.windows(FLAT).any(|row| row.iter().all(is_top))
    };
    let all: Vec<&Run> = set.runs.iter().filter(is_flat).collect();
    if let Some(run) = all.first() {
        let largest = largest(run);
        let (n, name) = (all.len(), shorten(&run.name));
        let told = format!(
            "{n} of {} runs have a flat top: `{name}` reads {largest:.2} m/s^2 {FLAT} times in a row or more",
            set.runs.len()
        );
        findings.report(
            Diagnostic::error(told)
                .at(places[run.condition].id, "measured under this condition")
                .help(format!(
                    "the accelerometer reads no more: write acceleration_range_m_s2 = {:.2} below [instrument]",
                    0.99 * largest
                )),
        );
    }
}

/// Names the unit of readings that are 1 at rest, where gravity is far from it.
fn check_rest(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let is_one = |run: &&Run| {
        let last = run.samples.len().checked_sub(AT_REST).map(|from| &run.samples[from..]);
        let gravity = set.gravity_of(run);
        let is_near = |all: &[Sample]| {
            let mean = all.iter().map(|one| one.value).sum::<f64>() / all.len() as f64;
            let noise = |one: &Sample| (one.value - 1.0).abs() < NOISE;
            (mean - 1.0).abs() < SCATTER && all.iter().all(noise)
        };
        !(0.5..2.0).contains(&gravity) && last.is_some_and(is_near)
    };
    let of: Vec<&Run> = set.runs.iter().filter(is_one).collect();
    let first = of.first().filter(|_| 2 * of.len() > set.runs.len())?;
    Some(Contradiction {
        kind: ContradictionKind::Speeds,
        diagnostic: Diagnostic::error(format!(
            "at rest the readings are 1 m/s^2, and gravity is {:.2} m/s^2",
            set.gravity_of(first)
        ))
        .at(places[first.condition].id, "measured under this condition")
        .help(
            "are they in g? [columns] gives the units of a table: acceleration = { unit = \"g\" }",
        ),
    })
}
