//! Whether depth, range and angle count the way that the impact velocities say.

use configs::{Diagnostic, shorten};

use super::conditions::ConditionPlaces;
use super::curve::Written;
use super::findings::Findings;
use super::start::Start;
use super::{Condition, Frame, MeasurementSet, Run, median, zeros};

/// A way shorter than this share of the diameter says nothing about a direction.
const SHORTEST: f64 = 0.05;

/// Refuses a set that goes against its own impact velocities; which of the two is wrong is asked.
pub(super) fn check(set: &MeasurementSet, (places, columns): Written<'_>, findings: &mut Findings) {
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
        let forward = condition.speed * cosine(condition) > 0.05 * condition.speed;
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
    }
    check_angles(set, places, findings);
}

/// Refuses angles that the trajectories do not have, or have to the vertical.
fn check_angles(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    let all: Vec<Angle> = (0..set.conditions.len()).filter_map(|at| Angle::of(set, at)).collect();
    let off: Vec<&Angle> = all.iter().filter(|angle| angle.is_off(angle.stated)).collect();
    let Some(first) = off.first() else { return };
    let other = |angle: &&&Angle| !angle.is_off(90.0 - angle.stated);
    let is_other = off.iter().filter(other).count() == off.len() && 2 * off.len() > all.len();
    let place = places[first.condition].angle;
    let id = |angle: &Angle| shorten(&set.conditions[angle.condition].id);
    findings.report(match is_other {
        true => Diagnostic::error(format!(
            "the runs of {} of {} conditions start at the stated angle to the vertical",
            off.len(),
            all.len()
        ))
        .at(place, "is this the angle to the vertical?")
        .help("angle_deg is counted from the horizontal: 90 is straight down"),
        false => {
            let listed = off.iter().take(LISTED).map(|angle| {
                let Angle { stated, measured, error, .. } = angle;
                format!("{measured:.1} \u{b1} {error:.1} deg in `{}`, not {stated}", id(angle))
            });
            let more = off.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", and so in {more} more") } else { String::new() };
            Diagnostic::error(format!(
                "the paths start below the horizontal at {}{more}",
                listed.collect::<Vec<_>>().join("; ")
            ))
            .at(place, "the frames show another angle")
            .help("correct `angle_deg`, or the condition that runs.csv says these runs are of")
        }
    });
}

/// Most conditions whose angles a message lists.
const LISTED: usize = 4;

/// Angles differ if they do by so many degrees,
const APART_DEG: f64 = 6.0;

/// and by so many standard errors.
const CLEAR: f64 = 4.0;

/// The angle at which the runs of a condition start, below the horizontal (deg).
struct Angle {
    condition: usize,
    stated: f64,
    measured: f64,
    error: f64,
}

impl Angle {
    /// `None` of vertical impacts, which may have an angle to the vertical, and where no run says anything.
    fn of(set: &MeasurementSet, condition: usize) -> Option<Self> {
        let stated = set.conditions[condition].angle_deg;
        let own = set.runs.iter().filter(|run| run.condition == condition);
        let read: Vec<(f64, f64)> = own
            .filter_map(|run| {
                let start = Start::of(run)?;
                let way = libm::hypot(start.dx, start.dz);
                let error = std::f64::consts::SQRT_2 * zeros::position(set, run) / way;
                (way > 0.0).then(|| (libm::atan2(start.dz, start.dx), error))
            })
            .collect();
        let n = read.len() as f64;
        let measured = median(read.iter().map(|(angle, _)| angle.to_degrees()))?;
        let error = (read.iter().map(|(_, error)| error * error).sum::<f64>()).sqrt() / n;
        let error = error.to_degrees();
        (stated < 89.0).then_some(Self { condition, stated, measured, error })
    }

    fn is_off(&self, angle: f64) -> bool {
        (self.measured - angle).abs() > APART_DEG.max(CLEAR * self.error)
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
