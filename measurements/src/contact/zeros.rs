//! Zero of depth and clock, and the speed at contact, as the frames of all runs show them.
//!
//! A run says precisely how deep free fall is at time zero, and less precisely when it ends. A wrong zero
//! of depth shifts that depth in all runs alike, a wrong zero of the clock in proportion to the velocity:
//! where runs have several velocities, that tells the two apart.

use crate::contact::braking::Tip;
use crate::contact::departure::Departure;
use crate::contact::strays::but_strays;
use crate::contact::{self, Contact};
use crate::reading::Reading;
use crate::{Kind, MeasurementSet, Run, SurfaceDefinition};

/// How well the level of the surface is known (m), where the set does not say it.
const LEVEL: f64 = 5e-4;

/// How well impact speeds are set, relative, where the set does not say it.
const SPEED: f64 = 0.02;

/// Error of one reading of a position (m), where the set does not say it.
pub(crate) const POSITION: f64 = 2e-4;

/// Standard errors beyond which a mean over runs is not by chance, a number of one run among many, and a
/// speed.
const OF_MEAN: f64 = 4.0;
const OF_RUN: f64 = 6.0;
const OF_SPEED: f64 = 5.0;

/// An offset below this (m) is not worth a word, and one of a single run above that is an error.
const NOTABLE: f64 = 5e-4;
const WRONG: f64 = 1e-3;

/// Largest distance between the mean surface and the grain that a body meets first, in grain diameters: depths may count from
/// either.
const UNEVEN: f64 = 1.5;

/// An offset of all runs alike above this (m) is an error, unless depths may count from a mean surface that lies so far below
/// the first grains; below, a diagnosis takes it into account as that of the zero of depth.
const WRONG_ALIKE: f64 = 4e-3;

/// Share of a frame's time, and so of the way in it, that a clock may be off: contact falls between frames.
const FRAME: f64 = 0.75;

/// Relative miss of the speed that is not worth a word, and the one that is an error.
const NOTABLE_SPEED: f64 = 0.05;
const WRONG_SPEED: f64 = 0.12;

/// Time (s) over which free fall is extrapolated without a second look.
const FAR: f64 = 4e-3;

/// How much worse, in chi-squared, the other explanation of an offset has to be.
const TOLD_APART: f64 = 9.0;

/// Least variance of the velocities, relative to their mean square, with which two numbers are fitted.
const SPREAD: f64 = 0.01;

/// How far a number is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Not beyond its error.
    None,
    /// Beyond its error, and so small that it need not be a mistake.
    Notable,
    /// Beyond its error, and a mistake.
    Wrong,
}

/// Which zero is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zero {
    /// That of depth.
    Depth,
    /// That of the clock.
    Clock,
    /// Both.
    Both,
}

/// The contact of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunContact {
    /// Index of the run in the set.
    pub run: usize,
    /// What its frames show.
    pub contact: Contact,
    /// Whether its own frames alone show that a zero is off.
    pub is_off: bool,
    /// Whether the zeros of the run are right only if the body is slowed before its contact.
    pub is_slowed: bool,
}

/// An offset of the zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Which of them.
    pub zero: Zero,
    /// How bad it is.
    pub severity: Severity,
    /// Time of first contact on the clock of the tables (s), the mean over runs.
    pub time: Reading,
    /// Depth of the surface on the scale of the tables (m), the mean over runs.
    pub depth: Reading,
    /// Whether all runs share it.
    pub is_common: bool,
}

/// Measured over stated speed at contact of one condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedRatio {
    /// Index of the condition.
    pub condition: usize,
    /// Measured over stated.
    pub ratio: Reading,
    /// How bad it is.
    pub severity: Severity,
}

/// What the frames of a set say of its zeros and speeds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Zeros {
    /// The runs whose contact the frames show.
    pub contacts: Vec<RunContact>,
    /// What is off, if anything is.
    pub offset: Option<Offset>,
    /// Speeds at contact, of the conditions whose runs show them.
    pub speeds: Vec<SpeedRatio>,
}

impl Offset {
    /// With the error of the clock that it was read with, which a depth shares by the way in that time.
    fn with_clock_of(self, before: &Self, contacts: &[RunContact]) -> Self {
        let n = contacts.len().max(1) as f64;
        let sinking = contacts.iter().map(|one| one.contact.sinking.value).sum::<f64>() / n;
        let clock = self.time.se.max(before.time.se);
        Self {
            time: Reading { se: clock, ..self.time },
            depth: match self.zero {
                Zero::Clock => self.depth,
                _ => Reading { se: libm::hypot(self.depth.se, sinking * clock), ..self.depth },
            },
            ..self
        }
    }
}

impl Zeros {
    /// Reads them from the frames of `set`.
    pub fn of(set: &MeasurementSet) -> Self {
        Self::over_grains(set, 0.0)
    }

    /// The same over grains of this diameter (m) at most, where the set states none.
    pub fn over_grains(set: &MeasurementSet, unstated: f64) -> Self {
        if set.kind != Kind::Trajectory || set.all_beds().any(|bed| bed.gravity <= 0.0) {
            return Self::default();
        }
        let stated = set.coarsest_grains();
        let grain = if stated > 0.0 { stated } else { unstated };
        let level = Level::of(set, grain);
        let contacts = contacts(set, level, 0.0);
        let mut offset = offset(&contacts, level, 0.0);
        // Free fall is known well near its end alone: a clock that is far off is read again from there.
        for _ in 0..2 {
            let far = offset.filter(|found| found.time.value.abs() > FAR && found.is_common);
            let Some(before) = far else { break };
            let again = self::contacts(set, level, before.time.value);
            offset = self::offset(&again, level, before.time.value)
                .map(|found| found.with_clock_of(&before, &again))
                .or(offset);
        }
        let speeds = speeds(set, &contacts);
        Self { contacts, offset, speeds }
    }
}

/// The contacts of all runs that show them, with the depth of free fall at `zero` (s).
///
/// Guides and air may slow a body before its contact, as a bed does behind it. Zeros that are stated stand where that
/// explains what frames of every run show.
fn contacts(set: &MeasurementSet, level: Level, zero: f64) -> Vec<RunContact> {
    let read = |doubt: f64, run: usize| {
        let of = &set.runs[run];
        let condition = &set.conditions[of.condition];
        let known = (set.fall_of(condition), doubt, position(set, of));
        let contact = contact::read(of, condition, known, zero)?;
        let is_off = level.clock_is_off(&contact) || level.depth_is_off(&contact);
        Some(RunContact { run, contact, is_off, is_slowed: false })
    };
    let fall: Vec<RunContact> =
        (0..set.runs.len()).filter_map(|run| read(contact::FREE, run)).collect();
    if zero != 0.0 || fall.iter().all(|one| !one.is_off) {
        return fall;
    }
    let slowed = |one: &RunContact| {
        let slowed = read(contact::SLOWED, one.run).filter(|slowed| !slowed.is_off)?;
        Some(RunContact { is_slowed: one.is_off, ..slowed })
    };
    fall.iter().map(slowed).collect::<Option<Vec<_>>>().unwrap_or(fall)
}

/// How well the level of the surface is known (m).
pub(crate) fn level(set: &MeasurementSet) -> f64 {
    set.instrument.level_sigma.unwrap_or(LEVEL)
}

/// The contacts of the bodies of `set` that guides or air slow before.
pub(crate) fn slowed(set: &MeasurementSet) -> Vec<RunContact> {
    match set.kind {
        Kind::Trajectory => {
            let level = Level::of(set, set.coarsest_grains());
            contacts(set, level, 0.0).into_iter().filter(|one| one.is_slowed).collect()
        }
        _ => Vec::new(),
    }
}

/// Error of one reading of `run` (m).
pub(crate) fn position(set: &MeasurementSet, run: &Run) -> f64 {
    let own = run.frames.iter().filter_map(|frame| frame.sigma).fold(0.0, f64::max);
    match (own > 0.0, set.instrument.position_sigma) {
        (true, _) => own,
        (false, Some(sigma)) => sigma,
        (false, None) => POSITION,
    }
}

/// How well the height of the surface below a body is known.
#[derive(Clone, Copy)]
struct Level {
    /// Standard deviation of its mean height (m).
    sigma: f64,
    /// How far a grain may lie above or below that (m).
    uneven: f64,
    /// An offset of all runs alike below this (m) is not worth a word: grains that are met first lie above a mean surface.
    notable: f64,
}

impl Level {
    /// Over grains of the diameter `grain` (m).
    fn of(set: &MeasurementSet, grain: f64) -> Self {
        let uneven = UNEVEN * grain;
        let notable = match set.surface {
            SurfaceDefinition::FirstContact => NOTABLE,
            SurfaceDefinition::Mean => NOTABLE.max(uneven),
        };
        Self { sigma: level(set), uneven, notable }
    }

    /// The time (s) in which the body of `contact` passes the unevenness.
    fn lag(self, contact: &Contact) -> f64 {
        match self.uneven > 0.0 {
            true => self.uneven / contact.sinking.value.abs(),
            false => 0.0,
        }
    }

    /// Whether the path departs from free fall at another time than zero.
    fn clock_is_off(self, contact: &Contact) -> bool {
        let [earliest, latest] = contact.between;
        let granted = FRAME * contact.step + self.lag(contact);
        earliest > granted || latest < -granted
    }

    /// Whether free fall is not at the surface at time zero, a rounding of the contact to a frame granted.
    fn depth_is_off(self, contact: &Contact) -> bool {
        let way = FRAME * contact.step * contact.sinking.value.abs();
        contact.depth_at_zero.is_some_and(|depth| {
            let error = OF_RUN * libm::hypot(depth.se, self.sigma);
            depth.value.abs() > WRONG + way + self.uneven + error
        })
    }
}

/// What is off with the zeros, if anything is.
fn offset(contacts: &[RunContact], level: Level, zero: f64) -> Option<Offset> {
    let found = of_depths(contacts, level, zero);
    let all = || contacts.iter().map(|one| one.contact);
    let time = found.map_or(0.0, |offset| offset.time.value);
    let fits = |contact: &Contact| {
        let [earliest, latest] = contact.between;
        (earliest - contact.step..=latest + contact.step).contains(&time)
    };
    if all().filter(|contact| level.clock_is_off(contact)).all(|contact| fits(&contact)) {
        return found;
    }
    // The zeros go together along free fall, or they differ from run to run: the departures say when.
    let (time, depth) =
        (Reading::mean(all().map(|one| one.time)), Reading::mean(all().map(|one| one.depth)));
    let is_common = all().all(|one| {
        let [near, far] = [one.time.value - time.value, one.depth.value - depth.value];
        near.abs() <= FRAME * one.step + level.lag(&one) + OF_MEAN * one.time.se
            && far.abs() <= WRONG + level.uneven + OF_RUN * libm::hypot(one.depth.se, level.sigma)
    });
    let surface = depth.value.abs() > WRONG + OF_MEAN * libm::hypot(depth.se, level.sigma);
    let zero = if surface { Zero::Both } else { Zero::Clock };
    Some(Offset { zero, severity: Severity::Wrong, time, depth, is_common })
}

/// The offset that explains how deep free fall is at the time `zero` (s): `z₀ + v (zero − t₀)`.
fn of_depths(contacts: &[RunContact], level: Level, zero: f64) -> Option<Offset> {
    let point = |one: &RunContact| {
        let Contact { depth_at_zero, sinking, step, time, .. } = one.contact;
        let depth = depth_at_zero?;
        let error = libm::hypot(depth.se, level.sigma);
        let time = Reading { value: time.value - zero, ..time };
        Some(Point { depth: depth.value, error, sinking: sinking.value, step, time })
    };
    let points: Vec<Point> = contacts.iter().filter_map(point).collect();
    if points.is_empty() {
        return None;
    }
    let line = Line::through(&points, zero != 0.0);
    let mean = |of: fn(&Point) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (way, step) = (mean(|one| one.step * one.sinking.abs()), mean(|one| one.step));
    let beyond = |reading: Reading| reading.value.abs() > OF_MEAN * reading.se;
    let off = |depth: f64| beyond(line.depth) && line.depth.value.abs() > depth;
    // A clock that is off by less than a frame was set to the nearest one, and what that is deep is no
    // wrong zero either where depth and clock cannot be told apart.
    let granted = if line.is_told_apart { 0.0 } else { FRAME * way };
    let time = Reading { value: zero + line.time.value, ..line.time };
    let late = beyond(time) && time.value.abs() > FRAME * step;
    let alone = contacts.iter().any(|one| one.is_off);
    let slow = mean(|one| one.sinking).abs() * time.value.abs();
    let severity = match () {
        () if alone || late || off(WRONG_ALIKE.max(granted).max(level.notable)) => Severity::Wrong,
        () if off(level.notable) || (beyond(time) && slow > NOTABLE) => Severity::Notable,
        () => return None,
    };
    let is_common = points.iter().all(|one| {
        let rounding = FRAME * one.step * one.sinking.abs();
        line.miss(one).abs() <= NOTABLE + rounding + level.uneven + OF_RUN * one.error
    });
    let what = match (zero == 0.0, off(WRONG)) {
        (true, _) => line.zero,
        (false, true) => Zero::Both,
        (false, false) => Zero::Clock,
    };
    Some(Offset { zero: what, severity, time, depth: line.depth, is_common })
}

/// Depth of free fall at time zero, and what it may follow from.
struct Point {
    /// (m)
    depth: f64,
    /// (m)
    error: f64,
    /// Velocity (m/s).
    sinking: f64,
    /// Time between frames (s).
    step: f64,
    /// When the path departs from free fall (s).
    time: Reading,
}

/// Depths of free fall at time zero as those of a surface, of a clock, or of both.
struct Line {
    zero: Zero,
    depth: Reading,
    time: Reading,
    is_told_apart: bool,
}

impl Line {
    /// The simplest that explains `points`; where nothing tells, a clock that `is_late` already is it.
    fn through(points: &[Point], is_late: bool) -> Self {
        let [flat, steep] = [Sums::of(points, |_| 1.0), Sums::of(points, |one| one.sinking)];
        let n = points.len() as f64;
        let excess = |misfit: f64, numbers: f64| (misfit / (n - numbers).max(1.0)).max(1.0);
        let both = Sums::both(points);
        let apart = TOLD_APART
            * both.as_ref().map_or_else(
                || excess(flat.misfit.min(steep.misfit), 1.0),
                |both| excess(both.misfit, 2.0),
            );
        let none = Reading { value: 0.0, se: 0.0 };
        if let Some(both) = both.filter(|both| both.misfit + apart < flat.misfit.min(steep.misfit))
        {
            let scale = excess(both.misfit, 2.0).sqrt();
            let of = |value: f64, se: f64| Reading { value, se: scale * se };
            let [(depth, depth_se), (slope, slope_se)] = both.numbers;
            let (depth, time) = (of(depth, depth_se), of(-slope, slope_se));
            return Self { zero: Zero::Both, depth, time, is_told_apart: true };
        }
        let is_told_apart = (flat.misfit - steep.misfit).abs() > apart;
        // Where all velocities are alike, the departure from free fall has to tell.
        let departure = Reading::mean(points.iter().map(|one| one.time)).value;
        let is_clock = match is_told_apart {
            true => steep.misfit < flat.misfit,
            false => is_late || (departure + steep.value).abs() < departure.abs(),
        };
        let of = |sums: &Sums, sign: f64| Reading {
            value: sign * sums.value,
            se: sums.se * excess(sums.misfit, 1.0).sqrt(),
        };
        match is_clock {
            true => Self { zero: Zero::Clock, depth: none, time: of(&steep, -1.0), is_told_apart },
            false => Self { zero: Zero::Depth, depth: of(&flat, 1.0), time: none, is_told_apart },
        }
    }

    /// What a point misses it by (m).
    fn miss(&self, point: &Point) -> f64 {
        point.depth - (self.depth.value - point.sinking * self.time.value)
    }
}

/// A fit of one number by least squares.
struct Sums {
    value: f64,
    se: f64,
    misfit: f64,
}

/// A fit of a depth (m) and a slope (s), each with its error.
struct Both {
    numbers: [(f64, f64); 2],
    misfit: f64,
}

impl Sums {
    fn of(points: &[Point], slope: fn(&Point) -> f64) -> Self {
        let (mut top, mut bottom) = (0.0, 0.0);
        for point in points {
            let weight = point.error.powi(-2);
            top += weight * slope(point) * point.depth;
            bottom += weight * slope(point).powi(2);
        }
        let value = if bottom > 0.0 { top / bottom } else { 0.0 };
        let miss = |point: &Point| ((point.depth - value * slope(point)) / point.error).powi(2);
        Self { value, se: 1.0 / bottom.sqrt(), misfit: points.iter().map(miss).sum() }
    }

    /// `None` where the velocities do not differ.
    fn both(points: &[Point]) -> Option<Both> {
        let sum = |of: fn(&Point) -> f64| {
            points.iter().map(|one| of(one) * one.error.powi(-2)).sum::<f64>()
        };
        let (weight, v) = (sum(|_| 1.0), sum(|one| one.sinking));
        let (vv, z) = (sum(|one| one.sinking.powi(2)), sum(|one| one.depth));
        let vz = sum(|one| one.sinking * one.depth);
        let determinant = weight * vv - v * v;
        if points.len() < 3 || determinant <= SPREAD * weight * vv {
            return None;
        }
        let depth = (vv * z - v * vz) / determinant;
        let slope = (weight * vz - v * z) / determinant;
        let miss = |one: &Point| ((one.depth - depth - slope * one.sinking) / one.error).powi(2);
        Some(Both {
            numbers: [(depth, (vv / determinant).sqrt()), (slope, (weight / determinant).sqrt())],
            misfit: points.iter().map(miss).sum(),
        })
    }
}

/// Whether runs of the condition show its speed where their contacts are sought by the forces of a bed: a power of time may
/// miss the way that exact readings are braked on.
fn is_shown(set: &MeasurementSet, condition: usize) -> bool {
    let of = &set.conditions[condition];
    let ratio = |run: &Run| {
        let sigma = position(set, run);
        let frames = but_strays(&run.frames, sigma);
        let tip = Tip::of(of);
        let Contact { sinking, forward, .. } =
            Departure::of_frames(&frames, tip, set.fall_of(of), sigma)?.contact;
        let speed = libm::hypot(sinking.value, forward.value);
        let se = libm::hypot(sinking.value * sinking.se, forward.value * forward.se) / speed;
        Some(Reading { value: speed / of.speed, se: se / of.speed })
    };
    let own = set.runs.iter().filter(|run| run.condition == condition);
    let ratios: Vec<Reading> = own.filter_map(ratio).collect();
    let mean = Reading::mean(ratios.iter().copied());
    let is_free = of.spin == 0.0 && !ratios.is_empty();
    is_free && (mean.value - 1.0).abs() <= (OF_SPEED * mean.se).max(NOTABLE_SPEED)
}

fn speeds(set: &MeasurementSet, contacts: &[RunContact]) -> Vec<SpeedRatio> {
    let set_error = set.instrument.speed_sigma_rel.unwrap_or(SPEED);
    let ratio = |one: &RunContact| {
        let stated = set.conditions[set.runs[one.run].condition].speed;
        let Contact { sinking, forward, first, time, step, .. } = one.contact;
        let measured = libm::hypot(sinking.value, forward.value);
        // Without frames before the contact the bed has braked already.
        let seen = first < time.value - step && stated > 0.0 && measured > 0.0;
        let error = libm::hypot(sinking.value * sinking.se, forward.value * forward.se) / measured;
        seen.then(|| Reading { value: measured / stated, se: error / stated })
    };
    let of_condition = |condition: usize| {
        let own = contacts.iter().filter(|one| set.runs[one.run].condition == condition);
        let ratios: Vec<Reading> = own.filter_map(ratio).collect();
        if ratios.is_empty() {
            return None;
        }
        let mean = Reading::mean(ratios.iter().copied());
        let n = ratios.len() as f64;
        let ratio = Reading { se: libm::hypot(mean.se, set_error / n.sqrt()), ..mean };
        let (off, error) = ((ratio.value - 1.0).abs(), OF_SPEED * ratio.se);
        let severity = match () {
            () if off <= error.max(NOTABLE_SPEED) || is_shown(set, condition) => Severity::None,
            () if off > error.max(WRONG_SPEED) => Severity::Wrong,
            () => Severity::Notable,
        };
        Some(SpeedRatio { condition, ratio, severity })
    };
    (0..set.conditions.len()).filter_map(of_condition).collect()
}
