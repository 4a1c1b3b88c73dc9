//! Tables that disagree with the others: their acceleration before contact, their axis, the height in their name.

use engine::units::{Dimension, parse};
use measurements::{Reading, deviation_of, median};

use super::begun::Begun;
use super::called::words;
use super::fault::Fault;
use super::motion::Path;
use super::run::Run;
use super::scales::ALLOWED;
use super::settings::Settings;

/// Smallest relative difference from gravity that brings a warning, and in standard errors: of all runs together, and of one.
const CLEAR: f64 = 0.04;
const OF_ALL: f64 = 3.0;
const OF_ONE: f64 = 4.0;

/// Accelerations beyond this many times gravity come from frames, not from a scale.
const READABLE: f64 = 3.0;

/// Largest number of runs that a warning names.
const LISTED: usize = 4;

/// A warning if the acceleration before contact differs clearly from gravity, in all runs together or in some of them.
///
/// # Errors
/// If that of all together is by its error none that guides or air explain.
pub(super) fn off_gravity(
    begun: &[Begun],
    settings: &Settings<'_>,
) -> Result<Option<String>, Fault> {
    let paths: Vec<Path> = begun.iter().map(|one| one.path.clone()).collect();
    let Some(falls) = falls(&paths, begun, settings) else { return Ok(None) };
    let all = mean(&falls);
    let ends = [all.value - OF_ALL * all.se, all.value + OF_ALL * all.se];
    let [least, most] = ends.map(|end| end / settings.gravity);
    if !settings.trusts_units && (least > 1.0 + ALLOWED || most < 1.0 - ALLOWED) {
        let scales = paths[0].scales(&paths, settings)?;
        return Err(paths[0].contradicts_gravity(
            all.value / settings.gravity,
            scales.time.1,
            settings,
        ));
    }
    Ok(of_falls(&falls, all, settings.gravity))
}

/// Accelerations (m/s²) before contact, with the names of their runs.
fn falls<'a>(
    paths: &[Path],
    begun: &'a [Begun],
    settings: &Settings<'_>,
) -> Option<Vec<(&'a str, Reading)>> {
    let mut falls: Vec<(&str, Reading)> = Vec::new();
    for (path, one) in paths.iter().zip(begun) {
        let scales = path.scales(paths, settings).ok()?;
        // The other runs are judged even if one shows no fall.
        let fall = scales.fall(path).filter(|fall| fall.se > 0.0 && fall.se.is_finite());
        falls.extend(fall.map(|fall| (one.name.as_str(), fall)));
    }
    (!falls.is_empty()).then_some(falls)
}

/// Of all `falls` together.
fn mean(falls: &[(&str, Reading)]) -> Reading {
    let weight = |fall: &Reading| fall.se.powi(-2);
    let weights: f64 = falls.iter().map(|(_, fall)| weight(fall)).sum();
    let mean = falls.iter().map(|(_, fall)| weight(fall) * fall.value).sum::<f64>() / weights;
    // An uneven clock scatters the accelerations by more than their errors.
    let misfit: f64 =
        falls.iter().map(|(_, fall)| weight(fall) * (fall.value - mean).powi(2)).sum();
    let excess = (misfit / (falls.len() as f64 - 1.0).max(1.0)).max(1.0);
    Reading { value: mean, se: (excess / weights).sqrt() }
}

fn of_falls(falls: &[(&str, Reading)], all: Reading, gravity: f64) -> Option<String> {
    let question = "are the scale, the unit and the frame rate right? A guide or air brakes too; speeds and depths are as the \
                    table has them.";
    if is_off(all, gravity, OF_ALL) {
        let Reading { value, se } = all;
        return Some(format!(
            "Warning: before contact the bodies fall at {value:.2} \u{b1} {se:.2} m/s^2, not at {gravity}: {question}"
        ));
    }
    let usual = median(falls.iter().map(|(_, fall)| fall.value))?;
    let scatter = deviation_of(falls.iter().map(|(_, fall)| (fall.value - usual).abs() / fall.se));
    let own = |fall: &Reading| Reading { se: fall.se * scatter.max(1.0), ..*fall };
    let off = falls.iter().filter(|(_, fall)| {
        fall.value.abs() < READABLE * gravity && is_off(own(fall), gravity, OF_ONE)
    });
    let off: Vec<String> = off.map(|(name, fall)| format!("{name} ({:.2})", fall.value)).collect();
    (!off.is_empty()).then(|| {
        let named = listed(&off);
        format!(
            "Warning: before contact the bodies of {named} fall otherwise than at {gravity} m/s^2, as the others do: {question}"
        )
    })
}

/// Fewest runs, and fewest heights, for a comparison of names with speeds.
const FEWEST: (usize, usize) = (5, 3);

/// Heights are equal up to the first relative difference, and different from the second on.
const SAME: f64 = 0.15;
const OTHER: f64 = 0.3;

/// Units (m) in which names without one may count heights.
const UNITS: [f64; 4] = [1.0, 1e-2, 1e-3, 0.0254];

/// Largest relative difference between heights in names and those of the speeds: without a unit in the names, and with one.
const NEAR: (f64, f64) = (0.2, 0.1);

/// A warning if names of `runs` state heights, as `h050` and `h10cm` do, and speeds contradict them, some or all.
pub(super) fn off_their_names(runs: &[Run], gravity: f64) -> Option<String> {
    let of = |run: &Run| {
        let (named, _) = height_in(&run.name)?;
        let fallen = run.speed.value.powi(2) / (2.0 * gravity);
        Some((run.name.clone(), named, fallen / named))
    };
    let all: Vec<(String, f64, f64)> = runs.iter().filter_map(of).collect();
    let mut heights: Vec<f64> = all.iter().map(|one| one.1).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|a, b| (*a / *b - 1.0).abs() < SAME);
    // The ratio of most runs is the unit of the numbers in the names.
    let unit = median(all.iter().map(|one| one.2))?;
    let off = |one: &(String, f64, f64)| (one.2 / unit - 1.0).abs();
    let as_named = all.iter().filter(|one| off(one) < SAME).count();
    let stated = runs.iter().map(|run| height_in(&run.name).and_then(|(_, unit)| unit));
    let stated = stated.reduce(|one, other| one.filter(|_| one == other)).flatten();
    if as_named == runs.len() && (stated.is_some() || heights.len() >= FEWEST.1) {
        return off_all_names(&heights, unit, stated);
    }
    if all.len() < FEWEST.0 || all.len() < runs.len() || heights.len() < FEWEST.1 {
        return None;
    }
    let others: Vec<_> = all.iter().filter(|one| off(one) > OTHER).collect();
    if 3 * as_named < all.len() || as_named + others.len() < all.len() || others.is_empty() {
        return None;
    }
    let fallen = |(name, height, ratio): &&(String, f64, f64)| {
        format!("{name} (from {:.0})", height * ratio / unit)
    };
    let named = listed(&others.iter().map(fallen).collect::<Vec<_>>());
    Some(format!(
        "Warning: by their speeds these do not fall from the heights in their names, as the others do: {named}. Are names \
         exchanged?"
    ))
}

/// A warning about the unit (m) in which all `heights` in names agree with the speeds, unless it is the `stated` one, or, if none
/// is stated, a usual unit of length.
fn off_all_names(heights: &[f64], unit: f64, stated: Option<f64>) -> Option<String> {
    let off = |known: f64| (unit / known - 1.0).abs();
    let known = stated.or_else(|| UNITS.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))))?;
    if off(known) < if stated.is_some() { NEAR.1 } else { NEAR.0 } {
        return None;
    }
    let each = |of: &dyn Fn(f64) -> String| {
        heights.iter().map(|one| of(*one)).collect::<Vec<_>>().join(", ")
    };
    let named = each(&|height| match stated {
        Some(unit) => format!("{:.3} m", height * unit),
        None => format!("{height}"),
    });
    let fallen = each(&|height| format!("{:.3} m", height * unit));
    // Speeds are lengths over times, and heights of fall their squares.
    let lengths = [1.0, 1e-2, 1e-3].map(|known: f64| (known / unit).sqrt());
    let nearest = |one: &f64| libm::log(*one).abs();
    let length = stated.map_or_else(
        || lengths.into_iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b))),
        |unit_of_names| Some((unit_of_names / unit).sqrt()),
    )?;
    Some(format!(
        "Warning: by their names the bodies fall from {named}, and by their speeds at contact from {fallen}. Are the scale, the \
         unit and the frame rate right? Lengths {length:.3} times as large would fit. A guide, a throw or another zero of the \
         heights does this too."
    ))
}

/// The number in a word of `name` that consists of `h` and digits, and its unit (m), if one stands behind.
fn height_in(name: &str) -> Option<(f64, Option<f64>)> {
    let mut heights = words(name).filter_map(|word| {
        let rest = word.strip_prefix(['h', 'H'])?;
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let unit = match &rest[end..] {
            "" => None,
            unit => parse(&format!("1 {unit}"), Dimension::LENGTH).ok(),
        };
        let height = rest[..end].parse::<f64>().ok().filter(|height| *height > 0.0)?;
        Some((height, unit))
    });
    heights.next()
}

/// A warning if the axis of a few tables counts in the other direction than that of most tables.
pub(super) fn of_axes(begun: &[Begun]) -> Option<String> {
    let (upward, downward): (Vec<&Begun>, Vec<&Begun>) =
        begun.iter().partition(|one| one.path.sign < 0.0);
    let (few, many, way, others) = match upward.len() < downward.len() {
        true => (upward, downward, "upward", "downward"),
        false => (downward, upward, "downward", "upward"),
    };
    let names: Vec<String> = few.iter().map(|one| one.name.clone()).collect();
    (!few.is_empty() && 3 * few.len() <= many.len()).then(|| {
        format!(
            "Warning: the axis counts {way} in {}, and {others} in the others: do their levels have one zero?",
            listed(&names)
        )
    })
}

/// The first of `names`, and how many more there are.
fn listed(names: &[String]) -> String {
    let first = names[..names.len().min(LISTED)].join(", ");
    match names.len().saturating_sub(LISTED) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

fn is_off(fall: Reading, gravity: f64, errors: f64) -> bool {
    (fall.value - gravity).abs() > (CLEAR * gravity).max(errors * fall.se)
}
