//! Magnitudes that no impact has, and the factor that they look like.

use std::ops::RangeInclusive;

use configs::Diagnostic;
use engine::units::significant;

use crate::contact::smooth::greatest_velocity;
use crate::contact::start::Start;
use crate::contact::strays::but_strays;
use crate::contact::zeros::position;
use crate::contradiction::{Contradiction, ContradictionKind};
use crate::document::conditions::ConditionPlaces;
use crate::median;
use crate::table::findings::Findings;
use crate::{Condition, Geometry, MeasurementSet, Run};

/// Measured over stated impact speed beyond which a unit is wrong: no bed makes an intruder faster.
const FASTEST: f64 = 5.0;
/// The same downwards; a slow camera that sees the intruder brake stays above it.
const SLOWEST: f64 = 0.02;
/// The same where a path is seen from before contact on, in its greatest velocity: the velocity of a fall
/// is known to a few per cent.
const TWICE: f64 = 1.8;
const HALF: f64 = 0.6;
/// Fewest frames before contact that a path is seen from.
const BEFORE: usize = 2;
/// How many times its natural scale a depth, range or stopping time may be.
const LARGEST: f64 = 10.0;
/// How far a ratio of speeds may be from a factor between units.
const NEAR: f64 = 1.7;
/// Bulk density (kg/m³) below which a bed is of no known grains; of aerogel and foam beads it is 10 or more.
const LIGHTEST: f64 = 8.0;
/// Range of the step between readings, in frames of the camera. A table can leave frames out, and cannot add any.
const STEPS: RangeInclusive<f64> = 0.8..=3.0;

/// Ratio of two rates above which a wrong unit is likely.
const RATE_OF_A_UNIT: f64 = 5.0;

/// Factors between units of length that are taken for each other.
const LENGTHS: &[(f64, &str)] = &[
    (2.54, "×2.54 (cm for inches)"),
    (10.0, "×10 (mm for cm)"),
    (25.4, "×25.4 (mm for inches)"),
    (39.37, "×39.37 (inches for m)"),
    (100.0, "×100 (cm for m)"),
    (1e3, "×1000 (mm for m)"),
    (1e6, "×1e6 (µm for m)"),
];

/// Factors between units of time that are taken for each other.
const TIMES: &[(f64, &str)] =
    &[(10.0, "×10"), (100.0, "×100"), (1e3, "×1000 (ms for s)"), (1e6, "×1e6 (µs for s)")];

/// Speeds that are taken for m/s, and how near a ratio has to be to one of them.
const SPEEDS: &[(f64, &str)] = &[
    (3.6, "km/h: divide them by 3.6"),
    (2.237, "miles per hour: divide them by 2.237"),
    (3.281, "ft/s: divide them by 3.281"),
];
const OF_SPEEDS: f64 = 0.06;

/// Names magnitudes that look like another unit; a rate that does is warned of.
pub(crate) fn check(
    set: &MeasurementSet,
    places: &[ConditionPlaces],
    findings: &mut Findings,
) -> Vec<Contradiction> {
    // One wrong unit is told once.
    if let Some(speeds) = check_speeds(set, places) {
        return vec![speeds];
    }
    check_rate(set, findings);
    check_density(set, findings);
    check_ways(set, places)
}

/// The velocity of the readings over the stated one, and the condition, of the middle one of all runs that
/// `of` gives it of.
fn middle(set: &MeasurementSet, of: impl Fn(&Run) -> Option<f64>) -> Option<(f64, usize)> {
    let (ratio, run) = median::of_runs(set, of)?;
    Some((ratio, set.runs[run].condition))
}

/// Measured over stated velocity near first contact.
fn at_start(set: &MeasurementSet, run: &Run) -> Option<f64> {
    let frames = but_strays(&run.frames, position(set, run));
    let run = &Run { frames, ..run.clone() };
    let (start, stated) = (Start::of(run)?, set.conditions[run.condition].speed);
    let measured = libm::hypot(start.dx, start.dz) / start.dt;
    (stated > 0.0).then_some(measured / stated)
}

/// Greatest measured over greatest possible downward velocity, where that is seen: a body may gain some
/// before the bed brakes it, and no frame sees the speed of one that stops within a few of them.
fn at_most(set: &MeasurementSet, run: &Run) -> Option<f64> {
    let condition = &set.conditions[run.condition];
    let stated = condition.speed * libm::sin(condition.angle_deg.to_radians());
    let error = position(set, run);
    let measured = greatest_velocity(&but_strays(&run.frames, error), error)?;
    let gained = set.bed_of(condition).gravity * condition.diameter;
    let possible = (stated * stated + gained).sqrt();
    let before = run.frames.iter().filter(|frame| frame.t < 0.0).count();
    let ratio = if measured > possible { measured / possible } else { measured / stated };
    (stated > 0.0 && (ratio > 1.0 || before >= BEFORE)).then_some(ratio)
}

/// Names trajectories that do not start with the stated speeds.
fn check_speeds(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let implausible = |ratio: f64, least: f64, most: f64| !(least..=most).contains(&ratio);
    let start = middle(set, |run| at_start(set, run));
    let found = start.filter(|(ratio, _)| implausible(*ratio, SLOWEST, FASTEST)).or_else(|| {
        middle(set, |run| at_most(set, run)).filter(|(ratio, _)| implausible(*ratio, HALF, TWICE))
    });
    let (ratio, condition) = found?;
    let message = format!(
        "the trajectories start with {} the stated impact speed",
        match ratio > 1.0 {
            true => format!("about {ratio:.*} times", usize::from(ratio < 5.0)),
            false => format!("a share of {ratio:.1e} of"),
        }
    );
    let (what, factor, by) = match ratio > 1.0 {
        true => ("positions", nearest(ratio, LENGTHS), ratio),
        false => ("times", nearest(1.0 / ratio, TIMES), 1.0 / ratio),
    };
    let speeds = SPEEDS.iter().find(|(unit, _)| (by / unit - 1.0).abs() < OF_SPEEDS);
    let help = match LENGTHS.iter().chain(TIMES).any(|(unit, _)| is_near(by, *unit)) {
        true => format!("the {what} look like {factor}; [columns] gives the units of a table"),
        false => format!(
            "the {what} look like \u{d7}{by:.1}, which no usual unit explains: check the rate, the scale and `speed`"
        ),
    };
    let speed = places[condition].speed;
    let help = match speeds.filter(|_| ratio < 1.0) {
        Some((_, unit)) => format!("the stated speeds look like {unit}; or {help}"),
        None => help,
    };
    let diagnostic = Diagnostic::error(message).at(speed, "the stated speed").help(help);
    Some(Contradiction { kind: ContradictionKind::Speeds, diagnostic })
}

/// Names depths, ranges and stopping times that no impact at these speeds has.
fn check_ways(set: &MeasurementSet, places: &[ConditionPlaces]) -> Vec<Contradiction> {
    if set.all_beds().any(|bed| bed.gravity <= 0.0) {
        return Vec::new();
    }
    // A fall from as high as the speed needs, and a few diameters of resistance.
    let fall = |condition: &Condition| {
        let gravity = set.bed_of(condition).gravity;
        condition.speed.powi(2) / (2.0 * gravity) + 5.0 * condition.diameter
    };
    let depth = |condition: &Condition| condition.bed_depth.unwrap_or_else(|| fall(condition));
    let range = |condition: &Condition| 2.0 * fall(condition);
    let time = |condition: &Condition| {
        let gravity = set.bed_of(condition).gravity;
        condition.speed / gravity + 10.0 * (condition.diameter / gravity).sqrt()
    };
    let deepest = |run: &Run| farthest(run, run.final_z, |frame| frame.z);
    let widest = |run: &Run| farthest(run, run.final_x, |frame| frame.x);
    let all = [
        (DEPTH, worst(set, deepest, depth)),
        (RANGE, worst(set, widest, range)),
        (STOPPING_TIME, worst(set, |run| run.stop_time, time)),
    ];
    let named = |(observable, worst): (Observable, Option<Worst>)| {
        let Worst { value, scale, condition } = worst?;
        let Observable { name, unit, factors } = observable;
        // Typical values are a third to a fifth of the scale.
        let factor = nearest(4.0 * value / scale, factors);
        let diagnostic = Diagnostic::error(format!("a {name} of {value} {unit} is implausible"))
            .at(places[condition].speed, "at this impact speed")
            .help(format!("it looks like {factor}; [columns] gives the units of a table"));
        Some(Contradiction { kind: ContradictionKind::Scalars, diagnostic })
    };
    all.into_iter().filter_map(named).collect()
}

/// What is measured of a run, in words.
struct Observable {
    name: &'static str,
    unit: &'static str,
    factors: &'static [(f64, &'static str)],
}

const DEPTH: Observable = Observable { name: "depth", unit: "m", factors: LENGTHS };
const RANGE: Observable = Observable { name: "range", unit: "m", factors: LENGTHS };
const STOPPING_TIME: Observable = Observable { name: "stopping time", unit: "s", factors: TIMES };

/// A value far beyond its natural scale.
struct Worst {
    value: f64,
    scale: f64,
    condition: usize,
}

/// The value farthest beyond its scale.
fn worst(
    set: &MeasurementSet,
    value: impl Fn(&Run) -> Option<f64>,
    scale: impl Fn(&Condition) -> f64,
) -> Option<Worst> {
    let of = |run: &Run| {
        let (condition, value) = (run.condition, value(run)?);
        Some(Worst { value, scale: scale(&set.conditions[condition]), condition })
    };
    let all = set.runs.iter().filter_map(of);
    all.filter(|one| one.value > LARGEST * one.scale)
        .max_by(|a, b| (a.value / a.scale).total_cmp(&(b.value / b.scale)))
}

/// The largest size of a coordinate in a run (m).
fn farthest(
    run: &Run,
    last: Option<f64>,
    coordinate: impl Fn(&crate::Frame) -> f64,
) -> Option<f64> {
    let frames = run.frames.iter().filter(|frame| frame.t >= 0.0).map(coordinate);
    frames.chain(last).map(f64::abs).max_by(f64::total_cmp)
}

/// Warns when the steps between frames are not those of the camera.
fn check_rate(set: &MeasurementSet, findings: &mut Findings) {
    let Some(rate) = set.instrument.rate else { return };
    let pairs = set.runs.iter().flat_map(|run| run.frames.windows(2));
    let Some(step) = median::median(pairs.map(|pair| pair[1].t - pair[0].t)) else { return };
    let ratio = step * rate;
    if !STEPS.contains(&ratio) {
        let factor = ratio.max(1.0 / ratio);
        let factor = match factor < RATE_OF_A_UNIT {
            true => format!("the readings are {} per second", significant(1.0 / step, 4)),
            false => format!("it looks like {}", nearest(factor, TIMES)),
        };
        findings.warn(
            Diagnostic::warning(format!("a step of {step} s between readings is not 1/rate_hz"))
                .help(format!("rate_hz = {rate}; {factor}")),
        );
    }
}

/// Warns of a bed lighter than any grains.
fn check_density(set: &MeasurementSet, findings: &mut Findings) {
    let is_light = |density: f64| set.bed.geometry == Geometry::Spatial && density < LIGHTEST;
    let light = set.all_beds().filter_map(|bed| bed.bulk_density).find(|one| is_light(*one));
    if let Some(density) = light {
        findings.warn(
            Diagnostic::warning(format!(
                "a bulk density of {density} kg/m\u{b3} is that of no bed of grains"
            ))
            .help(format!("is it in g/cm\u{b3}? then write bulk_density = \"{density} g/cc\"")),
        );
    }
}

/// Whether `ratio` is `factor`, as well as speeds are read.
fn is_near(ratio: f64, factor: f64) -> bool {
    libm::log(ratio / factor).abs() < libm::log(NEAR)
}

/// The name of the factor nearest to `ratio`, which is at least 1.
fn nearest(ratio: f64, factors: &[(f64, &'static str)]) -> &'static str {
    let distance = |factor: f64| libm::log(ratio / factor).abs();
    let by_distance = |a: &&(f64, &str), b: &&(f64, &str)| distance(a.0).total_cmp(&distance(b.0));
    factors.iter().min_by(by_distance).map_or("another unit", |(_, name)| name)
}
