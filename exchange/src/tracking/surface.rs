//! The level of the surface on the axes of the tables, and with it contact time and speed of each run.

use measurements::{Contact, Departure, Levels, Reading, levels, misfit_of_one_level};

use super::fault::Fault;
use super::settings::Tracked;

/// A stated level is not where the contact is if it misses that by more than this distance (m) and this many standard errors.
const OFF: (f64, f64) = (1e-3, 3.5);

/// Diameters of the body by which a stated level may miss the contact at most: a bed that brakes in an unusual form moves
/// contacts by less.
const FAR: f64 = 0.25;

/// Error of a level that is stated (m).
pub(super) const STATED: f64 = 1e-3;

/// Least error of a level (m).
pub(super) const LEAST: f64 = 1e-5;

/// What is known of one run.
#[derive(Clone)]
pub(super) struct Seen {
    pub(super) name: String,
    pub(super) departure: Departure,
    /// Depth (m) that the tracked point has at contact by what the user says, with the size of the body there.
    pub(super) stated: Option<f64>,
    /// How deep the tip goes before the bed resists noticeably, at most (m).
    pub(super) soft: f64,
    /// (m)
    pub(super) diameter: f64,
    /// How far the lowest point is below the centre (m), if that is known.
    pub(super) below_centre: Option<f64>,
}

/// First contact of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touch {
    /// On the clock of the table (s).
    pub(super) time: Reading,
    /// Depth (m) on the axis of the table.
    pub(super) level: Reading,
    /// Downward velocity (m/s).
    pub(super) sinking: Reading,
    /// The part of the error of that velocity that a stated level of all runs does not make (m/s).
    pub(super) own_speed_error: f64,
    /// Error of its level against those of other runs (m).
    pub(super) level_error: f64,
}

/// Where the levels come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Level {
    /// The user states them; their error (m).
    Stated(f64),
    /// All runs have one (m).
    Common(Reading),
    /// Each run has its own; the error (m) that these share.
    Own(f64),
}

/// Difference of chi-squared that decides between two tracked points.
const CLEARLY: f64 = 9.0;

/// Smallest difference (m) between bodies for which the tracked point matters.
const UNLIKE: f64 = 1e-4;

/// The contacts of runs under `gravity` (m/s²), `tracked` at this point of their bodies.
///
/// # Errors
/// If a level is stated that the contact is not at.
pub(super) fn touches(
    runs: &[Seen],
    gravity: f64,
    tracked: Tracked,
) -> Result<(Level, Vec<Touch>), Vec<Fault>> {
    let is_stated = runs.iter().all(|run| run.stated.is_some());
    if is_stated {
        let error = error_of_stated(runs)?;
        let at = |run: &Seen| {
            let value = run.stated.unwrap_or_default();
            let with = |se| Touch::at(&run.departure.contact, Reading { value, se }, gravity);
            Touch { own_speed_error: with(LEAST).own_speed_error, ..with(error) }
        };
        return Ok((Level::Stated(error), runs.iter().map(at).collect()));
    }
    let at = |run: &Seen, surface: Reading| {
        let level = Reading { value: surface.value + run.depth_of(tracked), ..surface };
        Touch::at(&run.departure.contact, level, gravity)
    };
    let departures = of_the_lowest_point(runs, tracked);
    Ok(match levels(&departures.iter().collect::<Vec<_>>()) {
        Some(Levels::One(level)) => {
            let level = Reading { se: level.se.max(LEAST), ..level };
            (Level::Common(level), runs.iter().map(|run| at(run, level)).collect())
        }
        Some(Levels::Each { levels, shared }) => {
            let of = |(run, own): (&Seen, &Reading)| {
                let level = Reading { se: libm::hypot(own.se, shared), ..*own };
                Touch { level_error: own.se, ..at(run, level) }
            };
            (Level::Own(shared.max(LEAST)), runs.iter().zip(&levels).map(of).collect())
        }
        None => (Level::Stated(STATED), Vec::new()),
    })
}

impl Seen {
    /// How deep the point that was tracked is when the body touches a surface at zero (m).
    fn depth_of(&self, tracked: Tracked) -> f64 {
        match tracked {
            Tracked::Lowest => 0.0,
            Tracked::Centre => -self.below_centre.unwrap_or(0.0),
        }
    }
}

/// The departures of the lowest points of `runs` from free fall, given the `tracked` point.
fn of_the_lowest_point(runs: &[Seen], tracked: Tracked) -> Vec<Departure> {
    runs.iter().map(|run| run.departure.below(run.depth_of(tracked))).collect()
}

/// Whether the level of `runs` depends on the point of their bodies that was tracked.
pub(super) fn depends_on_the_point(runs: &[Seen]) -> bool {
    let below = || runs.iter().filter_map(|run| run.below_centre);
    let [least, most] = [f64::min, f64::max].map(|end| below().reduce(end).unwrap_or_default());
    most - least >= UNLIKE
        && below().count() == runs.len()
        && runs.iter().all(|run| run.stated.is_none())
}

/// The tracked point for which all runs share one level of the surface. `None` if bodies have one size, or if both points fit
/// about equally well.
pub(super) fn tracked_point(runs: &[Seen]) -> Option<Tracked> {
    if !depends_on_the_point(runs) {
        return None;
    }
    let misfit = |tracked: Tracked| {
        misfit_of_one_level(&of_the_lowest_point(runs, tracked).iter().collect::<Vec<_>>())
    };
    let better = misfit(Tracked::Lowest)? - misfit(Tracked::Centre)?;
    match better.abs() < CLEARLY {
        true => None,
        false if better > 0.0 => Some(Tracked::Centre),
        false => Some(Tracked::Lowest),
    }
}

impl Touch {
    /// Where the path crosses `level` (m).
    fn at(contact: &Contact, level: Reading, gravity: f64) -> Self {
        let (time, sinking) = contact.crossing(level, gravity);
        let (own_speed_error, level_error) = (sinking.se, contact.at_time.se);
        Self { time, level, sinking, own_speed_error, level_error }
    }
}

/// The error (m) of levels that are stated, by how far from them the contacts are: of all runs together where they agree,
/// else of each.
fn error_of_stated(runs: &[Seen]) -> Result<f64, Vec<Fault>> {
    let below = |run: &Seen| Some(run.departure.below(run.stated?));
    let all: Vec<Departure> = runs.iter().filter_map(below).collect();
    let each: Vec<Result<f64, Fault>> = match levels(&all.iter().collect::<Vec<_>>()) {
        Some(Levels::One(miss)) => vec![error_of_one("the runs are", miss, &runs[0])],
        Some(Levels::Each { levels, shared }) => {
            let of = |(run, own): (&Seen, &Reading)| {
                let miss = Reading { se: libm::hypot(own.se, shared), ..*own };
                error_of_one(&format!("the run {} is", run.name), miss, run)
            };
            runs.iter().zip(&levels).map(of).collect()
        }
        None => Vec::new(),
    };
    let (mut error, mut faults) = (STATED, Vec::new());
    for one in each {
        match one {
            Ok(own) => error = error.max(own),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(error) } else { Err(faults) }
}

/// The error (m) of a level that contacts, as that of `run`, miss by `miss` (m).
fn error_of_one(who: &str, miss: Reading, run: &Seen) -> Result<f64, Fault> {
    let Seen { soft, diameter, below_centre, .. } = *run;
    let error = OFF.1 * miss.se;
    if (-OFF.0.max(error)..=OFF.0.max(error) + soft).contains(&miss.value) {
        return Ok(STATED);
    }
    if (-FAR * diameter..=FAR * diameter + soft).contains(&miss.value) {
        return Ok(miss.value.abs());
    }
    let near = |wanted: f64| (miss.value - wanted).abs() <= error.max(0.1 * wanted.abs());
    let half = "this is half of the body: was its";
    let right = match below_centre {
        Some(below) if near(-below) => {
            format!("{half} centre tracked? then write --tracked centre")
        }
        Some(below) if near(below) => {
            format!("{half} lowest point tracked? then write --tracked lowest")
        }
        _ => "leave --surface out, and the level is taken from the contacts".to_owned(),
    };
    let side = if miss.value < 0.0 { "above" } else { "below" };
    let what = format!(
        "{who} braked {:.2} ± {:.2} mm {side} the stated surface",
        1e3 * miss.value.abs(),
        1e3 * miss.se
    );
    Err(Fault::new("--surface", what, right))
}
