//! Stopping times, final depths and ranges held against the trajectories of the same set, under every
//! definition that a set can state.
//!
//! Of each run the frames give what it would be under each definition; the stated number less that is its
//! miss. A definition fits when the mean miss over the runs is within its limit: four standard errors of the
//! mean, as the scatter between runs and the readings give them, and a third of a frame, or 0.3 mm. The
//! stated definition is contradicted when it does not fit and another does, or when none comes near.

use crate::contact::stops::{self, Stops};
use crate::contact::zeros::position;
use crate::reading::Reading;
use crate::{
    FinalDefinition, Instrument, Kind, MeasurementSet, Run, StopDefinition, SurfaceDefinition,
};

/// A number of a run that its frames show too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// Stopping time (s).
    StopTime,
    /// Final depth (m).
    FinalDepth,
    /// Final range (m).
    FinalRange,
}

/// How far the stated numbers are from a definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The definition, as a set writes it.
    pub definition: &'static str,
    /// Stated less measured, the mean over the runs (s or m).
    pub mean: Reading,
    /// Largest size of the mean that the definition allows (s or m).
    pub limit: f64,
}

/// What the trajectories say of one number.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Which number.
    pub scalar: Scalar,
    /// Whether the file names the definition; else it is assumed.
    pub is_stated: bool,
    /// How many runs it was held against.
    pub runs: usize,
    /// Mean of the stated numbers (s or m), and of the measured ones under the stated definition.
    pub means: [f64; 2],
    /// The definition of the set first, then the others.
    pub misses: Vec<Miss>,
    /// What follows.
    pub outcome: Outcome,
}

/// What the trajectories say of a definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The numbers follow it, and no other.
    Follows,
    /// The numbers follow it as well as another.
    Untold,
    /// The numbers follow another.
    FollowsOther(&'static str),
    /// The numbers follow none, by more than a definition can explain.
    FollowsNone,
    /// The numbers follow none exactly.
    Near,
}

impl Outcome {
    /// Whether the set contradicts itself.
    #[must_use]
    pub fn is_contradiction(self) -> bool {
        matches!(self, Self::FollowsOther(_) | Self::FollowsNone)
    }
}

impl StopDefinition {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::ComponentZero, Self::SpeedFivePercent];

    /// As a set writes it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::ComponentZero => "component-zero",
            Self::SpeedFivePercent => "speed-5-percent",
        }
    }
}

impl FinalDefinition {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Deepest, Self::Resting];

    /// As a set writes it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Deepest => "deepest",
            Self::Resting => "resting",
        }
    }
}

impl SurfaceDefinition {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::FirstContact, Self::Mean];

    /// As a set writes it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::FirstContact => "first-contact",
            Self::Mean => "mean",
        }
    }
}

/// Standard errors of a mean that are by chance.
const BY_CHANCE: f64 = 4.0;

/// Part of a frame (1), and length (m), that a definition may be missed by.
const FRAME: f64 = 0.35;
const LENGTH: f64 = 3e-4;

/// How many times as far off the definition of the set is where another is followed.
const CLEARER: f64 = 2.0;

/// Frames, length (m), and share of the number, that no definition explains.
const FRAMES: f64 = 3.0;
const FAR: f64 = 2e-3;
const SHARE: f64 = 0.05;

/// Runs from which on their scatter says how well the numbers are known, whatever the set states.
const MANY: usize = 6;

/// Holds the numbers of `set` against its trajectories; `is_stated` says whether the file names the
/// definitions of the stop and of the final place.
pub fn hold(set: &MeasurementSet, is_stated: [bool; 2]) -> Vec<Held> {
    if set.kind != Kind::Trajectory {
        return Vec::new();
    }
    let read = |run: &Run| stops::read(run, &set.conditions[run.condition], position(set, run));
    let ends: Vec<Option<Stops>> = set.runs.iter().map(read).collect();
    let all = [
        (Scalar::StopTime, is_stated[0]),
        (Scalar::FinalDepth, is_stated[1]),
        (Scalar::FinalRange, is_stated[1]),
    ];
    all.into_iter().filter_map(|(scalar, is_stated)| held(set, &ends, scalar, is_stated)).collect()
}

/// A number of a run: as stated, under the definition of the set, and under the other.
struct Row {
    stated: f64,
    measured: [Reading; 2],
    step: f64,
}

fn row(set: &MeasurementSet, run: &Run, stops: &Stops, scalar: Scalar) -> Option<Row> {
    let of = |stated: Option<f64>, measured: [Reading; 2]| {
        Some(Row { stated: stated?, measured, step: stops.step })
    };
    let places = |axis: usize| {
        let resting = stops.resting?[axis];
        let deepest = stops.deepest[axis];
        Some(match set.last {
            FinalDefinition::Deepest => [deepest, resting],
            FinalDefinition::Resting => [resting, deepest],
        })
    };
    match scalar {
        Scalar::StopTime => {
            let times = [stops.component_zero, stops.five_percent];
            let own = match set.stop {
                StopDefinition::ComponentZero => times,
                StopDefinition::SpeedFivePercent => [times[1], times[0]],
            };
            of(run.stop_time, own)
        }
        Scalar::FinalDepth => of(run.final_z, places(0)?),
        Scalar::FinalRange => {
            let oblique = set.conditions[run.condition].angle_deg < 89.0;
            of(run.final_x.filter(|_| oblique), places(1)?)
        }
    }
}

fn held(
    set: &MeasurementSet,
    ends: &[Option<Stops>],
    scalar: Scalar,
    is_stated: bool,
) -> Option<Held> {
    let of = |(run, stops): (&Run, &Option<Stops>)| row(set, run, stops.as_ref()?, scalar);
    let rows: Vec<Row> = set.runs.iter().zip(ends).filter_map(of).collect();
    if rows.is_empty() {
        return None;
    }
    let n = rows.len() as f64;
    let average = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).sum::<f64>() / n;
    let means = [average(&|row| row.stated), average(&|row| row.measured[0].value)];
    let step = average(&|row| row.step);
    let stated_error = match scalar {
        Scalar::StopTime => set.stated.stop_time,
        Scalar::FinalDepth => set.stated.final_z,
        Scalar::FinalRange => set.stated.final_x,
    };
    let stated_error = if rows.len() < MANY { stated_error.unwrap_or(0.0) } else { 0.0 };
    let own = match scalar {
        Scalar::StopTime => step / 12.0_f64.sqrt(),
        _ => set.instrument.position_sigma.unwrap_or(0.0),
    };
    let words = words(set, scalar);
    let miss = |definition: usize| {
        let misses = rows.iter().map(move |row| {
            let Reading { value, se } = row.measured[definition];
            let stated = libm::hypot(own, stated_error * row.stated);
            Reading { value: row.stated - value, se: libm::hypot(se, stated) }
        });
        let mean = Reading::mean(misses);
        let floor = match scalar {
            Scalar::StopTime => FRAME * step,
            _ => {
                let Instrument { level_sigma, surface_sigma, .. } = set.instrument;
                [level_sigma, surface_sigma].into_iter().flatten().fold(LENGTH, f64::max)
            }
        };
        Miss { definition: words[definition], mean, limit: floor + BY_CHANCE * mean.se }
    };
    let misses = vec![miss(0), miss(1)];
    let far = match scalar {
        Scalar::StopTime => FRAMES * step + SHARE * means[1].abs(),
        _ => FAR + SHARE * means[1].abs(),
    };
    let outcome = outcome(&misses, far);
    Some(Held { scalar, is_stated, runs: rows.len(), means, misses, outcome })
}

/// The definition of the set, and the other.
fn words(set: &MeasurementSet, scalar: Scalar) -> [&'static str; 2] {
    use {
        FinalDefinition::{Deepest, Resting},
        StopDefinition::{ComponentZero, SpeedFivePercent},
    };
    match (scalar, set.stop, set.last) {
        (Scalar::StopTime, ComponentZero, _) => [ComponentZero.word(), SpeedFivePercent.word()],
        (Scalar::StopTime, SpeedFivePercent, _) => [SpeedFivePercent.word(), ComponentZero.word()],
        (_, _, Deepest) => [Deepest.word(), Resting.word()],
        (_, _, Resting) => [Resting.word(), Deepest.word()],
    }
}

/// What misses say, of which the first is that of the set; `far` is more than a definition explains.
fn outcome(misses: &[Miss], far: f64) -> Outcome {
    let fits = |miss: &Miss| miss.mean.value.abs() <= miss.limit;
    let (own, others) = (&misses[0], &misses[1..]);
    let best = others
        .iter()
        .filter(|miss| fits(miss))
        .min_by(|a, b| a.mean.value.abs().total_cmp(&b.mean.value.abs()));
    let size = |miss: &Miss| miss.mean.value.abs();
    match (fits(own), best) {
        (true, None) => Outcome::Follows,
        (true, Some(_)) => Outcome::Untold,
        // Limits of means that are little certain overlap: then neither is followed.
        (false, Some(other)) if size(own) >= CLEARER * size(other) => {
            Outcome::FollowsOther(other.definition)
        }
        (false, Some(_)) => Outcome::Near,
        (false, None) => {
            let nearest = misses.iter().map(|miss| miss.mean.value.abs() - miss.limit);
            match nearest.fold(f64::INFINITY, f64::min) > far {
                true => Outcome::FollowsNone,
                false => Outcome::Near,
            }
        }
    }
}
