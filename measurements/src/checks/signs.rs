//! Whether depth, range and angle count the way that the impact velocities say.

use configs::{Diagnostic, shorten};

use crate::contact::start::Start;
use crate::contact::zeros;
use crate::curves::curve::Written;
use crate::document::conditions::ConditionPlaces;
use crate::median;
use crate::table::findings::Findings;
use crate::{Condition, Frame, MeasurementSet, Run};

/// A way shorter than this share of the diameter says nothing about a direction.
const SHORTEST: f64 = 0.05;

/// Refuses a set that goes against its own impact velocities; which of the two is wrong is asked.
pub(crate) fn check(set: &MeasurementSet, (places, columns): Written<'_>, findings: &mut Findings) {
    let depth = against(set, |run, condition| {
        let downward = condition.speed * sine(condition) > 0.0;
        let ways = [travel(run, |frame| frame.z), run.final_z];
        downward.then(|| least(ways, condition)).flatten()
    });
    if let Some(Against { condition, contrary, told }) = depth {
        let angle = set.conditions[condition].angle_deg;
        findings.report(
            Diagnostic::error(format!("the depth falls in {contrary} of {told} runs"))
                .at(
                    places[condition].angle,
                    format!("{angle} deg below the horizontal: the intruder goes down"),
                )
                .help(format!(
                    "is z counted upwards? then say below [columns]: {}, and so for final_z",
                    columns.turned("z", "m")
                )),
        );
    }
    let range = against(set, |run, condition| {
        let forward = condition.speed > 0.0 && cosine(condition) > STEEPEST;
        let ways = [travel(run, |frame| frame.x), run.final_x];
        forward.then(|| least(ways, condition)).flatten()
    });
    if let Some(Against { condition, contrary, told }) = range {
        findings.report(
            Diagnostic::error(format!("the intruder goes backwards in {contrary} of {told} runs"))
                .at(places[condition].angle, "an oblique impact: x counts along its motion")
                .help(format!(
                    "does x count the other way? then say below [columns]: {}, and so for final_x",
                    columns.turned("x", "m")
                )),
        );
    } else if let Some((first, names)) = mirrored(set) {
        findings.report(
            Diagnostic::error(format!(
                "the intruder goes backwards in {names}, as far as it goes forward in others"
            ))
            .at(places[first].angle, "an oblique impact: x counts along its motion")
            .help(
                "does x count the other way in them? then turn the sign of their x in the tables",
            ),
        );
    }
    check_angles(set, places, findings);
}

/// The runs that move backwards from the start, about as far as the other runs of their condition move forward: the index of
/// the first condition, and the names of the runs.
fn mirrored(set: &MeasurementSet) -> Option<(usize, String)> {
    let way = |run: &Run| {
        let condition = &set.conditions[run.condition];
        let is_oblique = cosine(condition) > CLEARLY_OBLIQUE;
        travel(run, |frame| frame.x)
            .filter(|way| is_oblique && way.abs() >= SHORTEST * condition.diameter)
    };
    let usual = |condition: usize| {
        let own = set.runs.iter().filter(|run| run.condition == condition);
        median(own.filter_map(way).map(f64::abs))
    };
    let goes_back = |run: &&Run| {
        let starts_so = Start::of(run).is_some_and(|start| start.dx < 0.0);
        starts_so
            && way(run).zip(usual(run.condition)).is_some_and(|(way, usual)| way < -0.5 * usual)
    };
    let all: Vec<&Run> = set.runs.iter().filter(goes_back).collect();
    let names = all.iter().take(LISTED).map(|run| format!("`{}`", shorten(&run.name)));
    let names = names.collect::<Vec<_>>().join(", ");
    let more = match all.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some((all.first()?.condition, format!("{names}{more}")))
}

/// Refuses angles that the trajectories have to the vertical.
fn check_angles(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    // Near 45 deg the two conventions cannot be told apart, and 90 deg is vertical in both when
    // only the others were converted.
    let told = |condition: &Condition| {
        (condition.angle_deg - 45.0).abs() > 10.0 && condition.angle_deg < 89.0
    };
    let measured = |run: &Run| {
        let start = Start::of(run)?;
        Some(libm::atan2(start.dz, start.dx).to_degrees())
    };
    let swapped = against(set, |run, condition| {
        let angle = measured(run).filter(|_| told(condition))?;
        let (right, other) = (condition.angle_deg, 90.0 - condition.angle_deg);
        match ((angle - right).abs() < 15.0, (angle - other).abs() < 10.0) {
            (true, _) => Some(1.0),
            (false, true) => Some(-1.0),
            (false, false) => None,
        }
    });
    if let Some(Against { condition, contrary, told }) = swapped {
        findings.report(
            Diagnostic::error(format!(
                "{contrary} of {told} runs start at the stated angle to the vertical"
            ))
            .at(places[condition].angle, "is this the angle to the vertical?")
            .help("angle_deg is counted from the horizontal: 90 is straight down"),
        );
        return;
    }
    let all = (0..set.conditions.len()).filter_map(|at| Angle::of(set, at));
    let off: Vec<Angle> = all.filter(Angle::is_off).collect();
    let Some(first) = off.first() else { return };
    let listed = off.iter().take(LISTED).map(|angle| {
        let Angle { condition, stated, measured, error } = angle;
        let id = shorten(&set.conditions[*condition].id);
        format!("at {measured:.1} \u{b1} {error:.1} deg in `{id}`, where {stated} is stated")
    });
    let more = off.len().saturating_sub(LISTED);
    let more = if more > 0 { format!("; and so in {more} more") } else { String::new() };
    findings.report(
        Diagnostic::error(format!(
            "the paths before contact go down {}{more}",
            listed.collect::<Vec<_>>().join("; ")
        ))
        .at(places[first.condition].angle, "the frames show another angle")
        .help("correct `angle_deg`, or the condition that the table of runs gives these runs"),
    );
}

/// Cosine of the steepest angle at which most runs move forward.
const STEEPEST: f64 = 0.05;

/// Cosine of the steepest angle at which every run moves forward, whatever the scatter of the bed (80 degrees).
const CLEARLY_OBLIQUE: f64 = 0.17;

/// Most runs, or conditions whose angles a message lists.
const LISTED: usize = 4;

/// Angles differ if they do by so many degrees,
const APART_DEG: f64 = 6.0;

/// and by so many standard errors.
const CLEAR: f64 = 5.0;

/// Frames before contact that show an angle.
const BEFORE: usize = 4;

/// The angle at which the runs of a condition come to the surface, from the horizontal (deg).
struct Angle {
    condition: usize,
    stated: f64,
    measured: f64,
    error: f64,
}

impl Angle {
    /// By the last frames before contact, as the bed turns a path; `None` of vertical impacts, and where less than two runs
    /// say anything.
    fn of(set: &MeasurementSet, condition: usize) -> Option<Self> {
        let stated = set.conditions[condition].angle_deg;
        let own = set.runs.iter().filter(|run| run.condition == condition);
        let read = own.filter_map(|run| {
            let n = run.frames.iter().filter(|frame| frame.t < 0.0).count();
            let (first, last) = (run.frames.get(n.checked_sub(BEFORE)?)?, run.frames.get(n - 1)?);
            let [dx, dz] = [last.x - first.x, last.z - first.z];
            let way = libm::hypot(dx, dz);
            let error = std::f64::consts::SQRT_2 * zeros::position(set, run) / way;
            (way > 0.0).then(|| (libm::atan2(dz, dx).to_degrees(), error.to_degrees()))
        });
        let read: Vec<(f64, f64)> = read.collect();
        let squares: f64 = read.iter().map(|(_, error)| error * error).sum();
        let error = squares.sqrt() / read.len() as f64;
        let measured = median(read.iter().map(|(angle, _)| *angle))?;
        (stated < 89.0 && read.len() > 1).then_some(Self { condition, stated, measured, error })
    }

    fn is_off(&self) -> bool {
        (self.measured - self.stated).abs() > APART_DEG.max(CLEAR * self.error)
    }
}

/// Runs that go against what their condition says.
struct Against {
    /// The condition of the first of them.
    condition: usize,
    contrary: usize,
    /// How many runs say anything.
    told: usize,
}

/// Whether `direction` is negative for most runs that it says anything about.
fn against(
    set: &MeasurementSet,
    direction: impl Fn(&Run, &Condition) -> Option<f64>,
) -> Option<Against> {
    let mut found = Against { condition: 0, contrary: 0, told: 0 };
    for run in &set.runs {
        let Some(way) = direction(run, &set.conditions[run.condition]) else { continue };
        found.told += 1;
        if way < 0.0 {
            if found.contrary == 0 {
                found.condition = run.condition;
            }
            found.contrary += 1;
        }
    }
    (2 * found.contrary > found.told).then_some(found)
}

/// How far the frames of a run go along one coordinate (m).
fn travel(run: &Run, coordinate: impl Fn(&Frame) -> f64) -> Option<f64> {
    let start = coordinate(run.frames.first()?);
    let ways = run.frames.iter().map(|frame| coordinate(frame) - start);
    ways.max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// The way that goes back farthest, of those (m) that are long enough to tell a direction.
fn least(ways: [Option<f64>; 2], condition: &Condition) -> Option<f64> {
    let far = |way: &f64| way.abs() >= SHORTEST * condition.diameter;
    ways.into_iter().flatten().filter(far).min_by(f64::total_cmp)
}

fn sine(condition: &Condition) -> f64 {
    libm::sin(condition.angle_deg.to_radians())
}

fn cosine(condition: &Condition) -> f64 {
    libm::cos(condition.angle_deg.to_radians())
}
