//! The level of the surface on the axes of the tables, and with it contact time and speed of each run.

use measurements::{Contact, Reading};

use super::fault::Fault;

/// Times the error that levels may scatter by and still be one.
const AGREE: f64 = 2.0;

/// Distance (m) and times its error beyond which a level that is stated is not where the contact is.
const OFF: (f64, f64) = (1e-3, 5.0);

/// Least error of a level (m).
const LEAST: f64 = 1e-5;

/// What is known of one run.
pub(super) struct Seen {
    pub(super) name: String,
    pub(super) contact: Contact,
    /// Depth (m) that the tracked point has at contact by what the user says, with the size of the body there.
    pub(super) stated: Option<f64>,
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
}

/// Where the levels come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Level {
    /// The user states them.
    Stated,
    /// All runs have one (m).
    Common(Reading),
    /// Each run has its own.
    Own,
}

/// The contacts of runs under `gravity` (m/s²).
///
/// # Errors
/// If a level is stated that the contact is not at.
pub(super) fn touches(runs: &[Seen], gravity: f64) -> Result<(Level, Vec<Touch>), Vec<Fault>> {
    let is_stated = runs.iter().all(|run| run.stated.is_some());
    if is_stated {
        let faults: Vec<Fault> = runs.iter().filter_map(off).collect();
        if !faults.is_empty() {
            return Err(faults);
        }
        let at = |run: &Seen| {
            let level = Reading { value: run.stated.unwrap_or_default(), se: LEAST };
            Touch::at(&run.contact, level, gravity)
        };
        return Ok((Level::Stated, runs.iter().map(at).collect()));
    }
    match common(runs) {
        Some(level) => {
            let touches = runs.iter().map(|run| Touch::at(&run.contact, level, gravity)).collect();
            Ok((Level::Common(level), touches))
        }
        None => Ok((Level::Own, runs.iter().map(|run| Touch::own(&run.contact)).collect())),
    }
}

impl Touch {
    /// Where the path crosses `level` (m).
    fn at(contact: &Contact, level: Reading, gravity: f64) -> Self {
        let Contact { time, at_time, sinking, .. } = contact;
        let (v, ahead) = (sinking.value, level.value - at_time.value);
        let root = (v * v + 2.0 * gravity * ahead).max(0.0).sqrt();
        let later = 2.0 * ahead / (v + root).max(f64::MIN_POSITIVE);
        let se = libm::hypot(level.se, at_time.se) / v;
        Self {
            time: Reading { value: time.value + later, se },
            level,
            sinking: Reading {
                value: v + gravity * later,
                se: libm::hypot(sinking.se, gravity * se),
            },
        }
    }

    /// Where the path departs from free fall.
    fn own(contact: &Contact) -> Self {
        Self { time: contact.time, level: contact.depth, sinking: contact.sinking }
    }
}

/// The level (m) of all runs, if theirs scatter no more than their errors allow.
fn common(runs: &[Seen]) -> Option<Reading> {
    let weight = |run: &Seen| run.contact.depth.se.max(LEAST).powi(-2);
    let total: f64 = runs.iter().map(weight).sum();
    let level = runs.iter().map(|run| weight(run) * run.contact.depth.value).sum::<f64>() / total;
    let square = |run: &Seen| weight(run) * (run.contact.depth.value - level).powi(2);
    let n = runs.len() as f64;
    let scatter = (runs.iter().map(square).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
    // Half of the error of a contact is how a path departs from free fall, which all runs share.
    let least = runs.iter().map(|run| run.contact.depth.se).fold(f64::INFINITY, f64::min);
    let se = scatter.max(1.0) / total.sqrt();
    (scatter <= AGREE)
        .then_some(Reading { value: level, se: libm::hypot(se, 0.5 * least).max(LEAST) })
}

/// What is wrong where the contact is not at the level that is stated.
fn off(run: &Seen) -> Option<Fault> {
    let depth = run.contact.depth;
    let miss = depth.value - run.stated?;
    if miss.abs() <= OFF.0.max(OFF.1 * depth.se) {
        return None;
    }
    let near = |wanted: f64| (miss - wanted).abs() <= (OFF.1 * depth.se).max(0.1 * wanted.abs());
    let right = match run.below_centre {
        Some(below) if near(-below) => {
            "this is half of the body: was its centre tracked? then write --tracked centre"
                .to_owned()
        }
        Some(below) if near(below) => {
            "this is half of the body: was its lowest point tracked? then write --tracked lowest"
                .to_owned()
        }
        _ => "leave --surface out, and the level is taken from the contact".to_owned(),
    };
    let (what, side) = (1e3 * miss.abs(), if miss < 0.0 { "above" } else { "below" });
    let what = format!(
        "{}: the body is braked {what:.2} ± {:.2} mm {side} the stated surface",
        run.name,
        1e3 * depth.se
    );
    Some(Fault::new("--surface", what, right))
}
