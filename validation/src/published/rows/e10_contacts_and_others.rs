//! E10: contacts whose answer is known, and the impact laws of other groups.

use configs::{LoadOptions, Model, ModelSource};
use engine::parallel::with_threads;
use resistive::Trajectory;

use crate::CASES;
use crate::case::Outcome;
use crate::published::check::{Band, Check, Estimate};
use crate::published::laboratory::Laboratory;
use crate::published::regression;
use crate::published::row::{Findings, PublishedError, Row};
use crate::published::rows::e10_trends;
use crate::published::signatures;

pub(super) static ROW: Row = Row {
    id: "E10",
    title: "Contacts whose answer is known; a force law of another group, integrated; published trends",
    source: "Chung & Ooi 2011; Katsuragi & Durian 2007; Ambroso et al. 2005; literature",
    how: [
        "every case, impacts on resistive media, and 35 on planar beds of 1 040 and 3 000 discs",
        "the same",
    ],
    judge,
};

/// The law of Katsuragi & Durian (2007): mass (kg), diameter (m), d₁ (m) and its error, k/m (1/s²) and its.
const MASS: f64 = 0.0692;
const DIAMETER: f64 = 0.0254;
const D1: [f64; 2] = [0.087, 0.007];
const RATE: [f64; 2] = [1040.0, 10.0];

/// Speeds (m/s) at which that law was measured.
const SPEEDS: [f64; 6] = [0.1, 0.5, 1.0, 2.0, 3.0, 4.0];

/// Depth over the total drop distance: Ambroso, Santore, Abate & Durian 2005.
const EXPONENT: f64 = 1.0 / 3.0;

fn judge(laboratory: &Laboratory<'_>) -> Result<Findings, PublishedError> {
    let mut findings = without_beds()?;
    findings.checks.extend(e10_trends::checks(laboratory)?);
    findings.checks.extend(signatures::unanswered());
    findings.tables.push(signatures::table());
    Ok(findings)
}

/// What a few grains and a force law decide.
pub(super) fn without_beds() -> Result<Findings, PublishedError> {
    // A few grains are no work for more than one thread.
    let mut checks: Vec<Check> =
        with_threads(1, || CASES.iter().map(|case| contacts(case)).collect())?;
    checks.extend(sphere()?);
    Ok(Findings { checks, ..Findings::default() })
}

/// One case, all its rows together; the worst is shown.
fn contacts(case: &crate::Case) -> Check {
    let rows = (case.run)();
    let failing: Vec<&Outcome> = rows.iter().filter(|row| !row.holds()).collect();
    let ours = match failing.first() {
        None => format!("all {} numbers within their tolerances", rows.len()),
        Some(first) => format!("{} of {} not, first {}", failing.len(), rows.len(), first.what),
    };
    let decided = "each number within its own tolerance (validation/cases)";
    Check::trend(case.name, (case.claim, ours), decided, failing.is_empty())
}

/// How an impact of the sphere ends.
struct End {
    depth: f64,
    time: f64,
    /// Deceleration at ten times from contact to just before the stop (m/s²).
    decelerations: Vec<f64>,
}

/// What stands before each check of the sphere. The law is that of the source, so these check the solver of resistive
/// impacts and not a law of plunge.
const SOLVER: &str = "check of the solver, Katsuragi & Durian's own law integrated";

/// What Katsuragi & Durian state of their sphere, by their law integrated here.
fn sphere() -> Result<Vec<Check>, PublishedError> {
    let mut ends = Vec::new();
    for speed in SPEEDS {
        ends.push(impact(speed, D1[0], RATE[0])?);
    }
    let times: Vec<f64> = ends.iter().map(|end| end.time).collect();
    let shown = |values: &[f64]| {
        values.iter().map(|value| format!("{:.1}", 1e3 * value)).collect::<Vec<_>>().join("; ")
    };
    let mut checks = vec![Check::trend(
        format!("{SOLVER}: stopping time (ms) from 0.1 to 4 m/s"),
        ("falls with speed", shown(&times)),
        "every step from speed to speed",
        times.windows(2).all(|pair| pair[1] < pair[0]),
    )];
    let at_stop = ends[1..].iter().filter_map(|end| end.decelerations.last().copied());
    let least = at_stop.fold(f64::INFINITY, f64::min);
    checks.push(Check::trend(
        format!("{SOLVER}: deceleration just before the stop (m/s²)"),
        ("finite: it jumps to zero", format!("{least:.1} at least from 0.5 m/s on")),
        "above one weight",
        least > 9.81,
    ));
    let fast = &ends[SPEEDS.len() - 1];
    let largest = fast.decelerations.iter().copied().fold(0.0, f64::max);
    checks.push(Check::trend(
        format!("{SOLVER}: at 4 m/s the deceleration is largest at first contact (m/s²)"),
        (
            "v²/d₁ at contact, then a fall",
            format!("{largest:.0} at most, {:.0} at contact", fast.decelerations[0]),
        ),
        "no later deceleration is larger",
        (largest - fast.decelerations[0]).abs() <= 1e-9 * largest,
    ));
    checks.push(scaling(&ends)?);
    Ok(checks)
}

/// The exponent of depth over the total drop distance H = v²/2g + depth, from 1 to 4 m/s.
fn scaling(ends: &[End]) -> Result<Check, PublishedError> {
    let exponent = |depths: &[f64]| {
        let drops = SPEEDS[2..].iter().zip(depths);
        let x: Vec<f64> = drops.map(|(v, d)| libm::log(v * v / (2.0 * 9.81) + d)).collect();
        let y: Vec<f64> = depths.iter().map(|depth| libm::log(*depth)).collect();
        regression::linear(&[x.clone(), vec![1.0; x.len()]], &y, None)
            .map_or(f64::NAN, |fitted| fitted.coefficients[0])
    };
    let own: Vec<f64> = ends[2..].iter().map(|end| end.depth).collect();
    let ours = exponent(&own);
    // The errors of both coefficients, one after the other.
    let mut square = 0.0;
    for (d1, rate) in [(D1[0] + D1[1], RATE[0]), (D1[0], RATE[0] + RATE[1])] {
        let mut moved = Vec::new();
        for speed in &SPEEDS[2..] {
            moved.push(impact(*speed, d1, rate)?.depth);
        }
        let off = exponent(&moved) - ours;
        square += off * off;
    }
    let ours = Estimate::new(ours, square.sqrt());
    let reason = "two standard errors of the law's coefficients";
    let half = 2.0 * ours.error;
    let what = format!("{SOLVER}: exponent of depth over the total drop distance, 1 to 4 m/s (–)");
    Ok(Check::number(what, Estimate::new(EXPONENT, 0.0), ours, Band { half, reason }))
}

/// The sphere at `speed` (m/s) under `m v²/d₁ + k z`.
fn impact(speed: f64, d1: f64, rate: f64) -> Result<End, PublishedError> {
    let text = format!(
        "[run]\nname = \"sphere\"\nduration = \"1 s\"\n\
         [medium]\nkind = \"resistive-force\"\nbulk_density = \"1520 kg/m^3\"\ngravity = \"9.81 m/s^2\"\n\
         [resistance]\nname = \"two-term-components\"\ndrag_x = \"0 kg/m\"\nfriction_x = \"0 N/m\"\n\
         drag_z = \"{:?} kg/m\"\nfriction_z = \"{:?} N/m\"\n\
         [intruder]\nshape = \"sphere\"\ndiameter = \"{DIAMETER} m\"\nmass = \"{MASS} kg\"\n\
         [impact]\nspeed = \"{speed:?} m/s\"\nangle = \"90 deg\"\n",
        MASS / d1,
        MASS * rate
    );
    let source = ModelSource::Text { name: "sphere".to_owned(), text, folder: ".".into() };
    let model = Model::load(source, &LoadOptions::default())?.model;
    let missing = || PublishedError::Missing("the sphere does not stop".to_owned());
    let impact = model.resistive().ok_or_else(missing)?.impact(&model.conditions()[0]);
    let ending = impact.run(model.run.duration, &mut ())?;
    let stop = &ending.parts[0];
    let (depth, time) = (stop.depth, stop.vertical.ok_or_else(missing)?);
    // Velocities a ten-thousandth of the stop apart.
    let beside = 1e-4 * time;
    let times: Vec<f64> = (0..10)
        .map(|k| (0.999 * time - beside) * f64::from(k) / 9.0)
        .flat_map(|at| [at, at + beside])
        .collect();
    let mut path = Trajectory::at(&times);
    impact.run(model.run.duration, &mut path)?;
    let decelerations =
        path.states().chunks(2).map(|pair| (pair[1].rate[1] - pair[0].rate[1]) / beside);
    Ok(End { depth, time, decelerations: decelerations.collect() })
}
