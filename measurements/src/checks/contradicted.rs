//! Statements of a set that its own readings contradict: gravity, depth of the bed, reading errors, names of scalars.

use configs::{Diagnostic, shorten};

use crate::contact::fall::Fall;
use crate::document::conditions::ConditionPlaces;
use crate::median::median;
use crate::reading::Reading;
use crate::table::findings::Findings;
use crate::{Condition, MeasurementSet, Run};

/// Gravity on Earth (m/s²), and the largest relative difference of a free fall on Earth from it.
const EARTH: f64 = 9.81;
const OF_EARTH: f64 = 0.1;

/// Largest standard error of the mean acceleration of the fall, in units of gravity on Earth, for a comparison with gravity.
const KNOWN: f64 = 0.05;

/// Smallest ratio between stated gravity and measured acceleration that is a contradiction.
const ELSEWHERE: f64 = 1.5;

/// Tolerance of readings below the floor, relative to the depth of the bed.
const BELOW_FLOOR: f64 = 0.05;

/// Reading error, relative to the depth, above which a set shows nothing.
const TOO_LARGE: f64 = 0.2;

/// Root mean square of the logarithms of stated over read scalars, above which they disagree.
const OFF: f64 = 0.2;

/// Fewest runs for a comparison of scalars.
const FEWEST: usize = 3;

/// Fewest frames that are equal by copying alone.
const FEWEST_OF_A_COPY: usize = 4;

/// Refuses statements that the readings contradict. Warns of implausible errors and of missing sizes.
pub(crate) fn check(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    check_gravity(set, findings);
    check_floor(set, places, findings);
    check_scalars(set, findings);
    check_errors(set, findings);
    check_sizes(set, places, findings);
    check_copies(set, findings);
}

/// Refuses a stated gravity that differs from the acceleration before contact.
fn check_gravity(set: &MeasurementSet, findings: &mut Findings) {
    let fall = |run: &Run| {
        let fall = Fall::of_frames(&run.frames)?.acceleration;
        let gravity = set.bed_of(&set.conditions[run.condition]).gravity;
        (fall.se > 0.0 && fall.se.is_finite()).then_some((fall, gravity))
    };
    let all: Vec<(Reading, f64)> = set.runs.iter().filter_map(fall).collect();
    let Some(&(_, gravity)) = all.first() else { return };
    let is_of_one_place = all.iter().all(|one| (one.1 - gravity).abs() <= 1e-3 * gravity.abs());
    let weights: f64 = all.iter().map(|(fall, _)| fall.se.powi(-2)).sum();
    let fall = all.iter().map(|(fall, _)| fall.value * fall.se.powi(-2)).sum::<f64>() / weights;
    let error = 1.0 / weights.sqrt();
    let is_known = error < KNOWN * EARTH.max((gravity - fall).abs());
    let is_on_earth = (fall / EARTH - 1.0).abs() < OF_EARTH + 2.0 * error / EARTH;
    let is_elsewhere = gravity > ELSEWHERE * fall || fall > ELSEWHERE * gravity;
    if is_of_one_place && is_known && is_on_earth && is_elsewhere {
        findings.report(
            Diagnostic::error(format!(
                "before contact the bodies fall at {fall:.2} m/s^2, and gravity = {gravity} is stated"
            ))
            .help("write gravity = 9.81, in m/s^2, below [bed]"),
        );
    }
}

/// Refuses paths that go below the floor of the bed.
fn check_floor(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    let deepest = |run: &Run| {
        let frames = run.frames.iter().map(|frame| frame.z);
        frames.chain(run.final_z).reduce(f64::max)
    };
    for (at, condition) in set.conditions.iter().enumerate() {
        let Some(floor) = condition.bed_depth else { continue };
        let own = set.runs.iter().filter(|run| run.condition == at);
        // The deepest of several runs may be a stray reading.
        let Some(depth) = median(own.filter_map(deepest)) else { continue };
        if depth > floor * (1.0 + BELOW_FLOOR) {
            findings.report(
                Diagnostic::error(format!(
                    "the bodies of `{}` come {:.1} mm deep in a bed that is {:.1} mm deep",
                    shorten(&condition.id),
                    1e3 * depth,
                    1e3 * floor
                ))
                .at(places[at].id, "its `bed_depth` is less than its depths")
                .help("`bed_depth` is the distance from the surface to the floor, in metres"),
            );
            return;
        }
    }
}

/// Warns of runs with the frames of another run: repeats that are copies hide the noise.
fn check_copies(set: &MeasurementSet, findings: &mut Findings) {
    let mut seen: Vec<(Vec<[u64; 2]>, usize)> = Vec::new();
    for (at, run) in set.runs.iter().enumerate() {
        if run.frames.len() < FEWEST_OF_A_COPY {
            continue;
        }
        let bits = run.frames.iter().map(|frame| [frame.t.to_bits(), frame.z.to_bits()]);
        seen.push((bits.collect(), at));
    }
    seen.sort();
    let mut copies = seen.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let Some(first) = copies.next() else { return };
    let [one, other] = [first[0].1, first[1].1].map(|at| shorten(&set.runs[at].name));
    let more = match copies.count() {
        0 => String::new(),
        1 => ", and 1 other run is a copy too".to_owned(),
        n => format!(", and {n} other runs are copies too"),
    };
    findings.warn(
        Diagnostic::warning(format!(
            "the runs {one} and {other} have the same frames to the last digit{more}"
        ))
        .help("take one of them out: a copy counts as a repeat that does not scatter"),
    );
}

/// Refuses exchanged stopping times and final depths.
fn check_scalars(set: &MeasurementSet, findings: &mut Findings) {
    let of = |run: &Run| {
        let deepest = run.frames.iter().max_by(|a, b| a.z.total_cmp(&b.z))?;
        let [stop, depth] = [run.stop_time?, run.final_z?];
        let off = |value: f64, seen: f64| libm::log(value / seen).powi(2);
        let as_named = off(stop, deepest.t) + off(depth, deepest.z);
        let exchanged = off(depth, deepest.t) + off(stop, deepest.z);
        (as_named + exchanged).is_finite().then_some((as_named, exchanged))
    };
    let all: Vec<(f64, f64)> = set.runs.iter().filter_map(of).collect();
    let n = all.len();
    let mean = |part: fn(&(f64, f64)) -> f64| all.iter().map(part).sum::<f64>() / n as f64;
    let [as_named, exchanged] = [mean(|one| one.0), mean(|one| one.1)];
    if n >= FEWEST && as_named > OFF * OFF && exchanged < 0.25 * as_named {
        findings.report(
            Diagnostic::error(format!(
                "of {n} runs, `stop_time` is near the depth that the frames show, and `final_z` near the time"
            ))
            .help("exchange the names of the two columns"),
        );
    }
}

/// Warns of stated reading errors that are comparable to the depths.
fn check_errors(set: &MeasurementSet, findings: &mut Findings) {
    let of = |run: &Run| {
        let stated = median(run.frames.iter().filter_map(|frame| frame.sigma));
        let depth = run.frames.iter().map(|frame| frame.z).reduce(f64::max)?;
        Some((stated.or(set.instrument.position_sigma)?, depth))
    };
    let all: Vec<(f64, f64)> = set.runs.iter().filter_map(of).collect();
    let middle = |part: fn(&(f64, f64)) -> f64| median(all.iter().map(part));
    let Some((error, depth)) = middle(|one| one.0).zip(middle(|one| one.1)) else { return };
    if error > TOO_LARGE * depth {
        findings.warn(
            Diagnostic::warning(format!(
                "readings are stated to be off by {:.3} mm, and bodies come {:.3} mm deep",
                1e3 * error,
                1e3 * depth
            ))
            .help("errors of readings are in metres; with errors as large as the depths nothing can be found"),
        );
    }
}

/// Warns of bodies whose sizes are not all stated.
fn check_sizes(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    let lacks = |condition: &Condition| condition.sizes(condition.shape_entry()?).err();
    for (condition, place) in set.conditions.iter().zip(places) {
        if let Some(error) = lacks(condition) {
            findings.warn(
                Diagnostic::warning(format!(
                    "of the {} of `{}`, {error}",
                    condition.shape,
                    shorten(&condition.id)
                ))
                .at(place.id, "no model can be asked about it")
                .help("state the size in this condition"),
            );
            return;
        }
    }
}
