//! What no push of a body into a bed is: signs and magnitudes of forces over depth.

use std::f64::consts::PI;

use configs::{Diagnostic, shorten};

use crate::contradiction::{Contradiction, ContradictionKind};
use crate::curves::curve::Written;
use crate::document::conditions::ConditionPlaces;
use crate::median;
use crate::table::findings::Findings;
use crate::{Condition, Geometry, MeasurementSet, Run, Sample};

/// Fewest readings below the surface that make a curve.
const FEWEST: usize = 3;

/// Pressure over that of the weight of the bed above, beyond which a unit is wrong: a fluid pushes a flat face with
/// just that weight and a cone with a third of it, dense sand with some thousand times as much.
const PRESSURES: [f64; 2] = [0.2, 5e3];

/// Density of a bed (kg/m³) that does not state its own, to a factor of two.
const DENSITY: f64 = 1500.0;

/// Depth in diameters beyond which a unit is wrong.
const DEEPEST: f64 = 500.0;

/// Refuses what cannot be pushed, and signs that go against a push; names units that look like others.
pub(crate) fn check(
    set: &MeasurementSet,
    (places, columns): Written<'_>,
    findings: &mut Findings,
) -> Vec<Contradiction> {
    for (condition, place) in set.conditions.iter().zip(places) {
        check_condition(condition, place, findings);
    }
    check_fluid(set, findings);
    let stops = |run: &&Run| {
        let of_stop = [run.stop_time, run.final_z, run.final_x];
        let of_crater = [run.crater.depth, run.crater.rim_diameter];
        of_stop.iter().chain(&of_crater).any(Option::is_some)
    };
    if let Some(run) = set.runs.iter().find(stops) {
        let name = shorten(&run.name);
        let message =
            format!("the run `{name}` has a stopping time, final depth, final range or crater");
        let help = "a body that is pushed does not stop: remove these columns of the table of runs";
        findings.report(Diagnostic::error(message).help(help));
    }
    if findings.errors() == 0 {
        check_signs(set, (places, columns), findings);
    }
    if findings.errors() == 0 {
        check_lengths(set, places, findings);
    }
    match findings.errors() {
        0 => check_units(set, places).into_iter().collect(),
        _ => Vec::new(),
    }
}

/// Refuses a fluid: no model of a push has one.
fn check_fluid(set: &MeasurementSet, findings: &mut Findings) {
    if set.all_beds().any(|bed| bed.stated.fluid.is_some()) {
        findings.report(
            Diagnostic::error("[bed]: a push is not modelled in a fluid").help(
                "leave `fluid_density` and `fluid_viscosity` out: forces are counted from what the drive reads above \
                 the bed",
            ),
        );
    }
}

fn check_condition(condition: &Condition, place: &ConditionPlaces, findings: &mut Findings) {
    let id = shorten(&condition.id);
    if condition.speed <= 0.0 {
        findings.report(
            Diagnostic::error(format!("the condition `{id}` is pushed at no speed"))
                .at(place.speed, "expected the speed of the push, above 0")
                .help("of a slow push any speed near it will do: write speed = \"1 mm/s\""),
        );
    }
    if condition.shape_entry().is_some_and(|entry| entry.links.is_some()) {
        findings.report(
            Diagnostic::error(format!("the condition `{id}` pushes a {}", condition.shape))
                .at(place.id, "a drive pushes a body of one part"),
        );
    }
}

/// Refuses depths and forces that count the other way.
fn check_signs(set: &MeasurementSet, (places, columns): Written<'_>, findings: &mut Findings) {
    let farthest = |run: &Run, of: fn(&Sample) -> f64| {
        run.samples.iter().map(of).max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    };
    let contrary = |of: fn(&Sample) -> f64| {
        let mut runs = set.runs.iter().filter(|run| farthest(run, of) < 0.0);
        let first = runs.next()?;
        Some((1 + runs.count(), first.condition))
    };
    let all = set.runs.len();
    for (what, of, key, unit) in [
        ("depth", (|one| one.at) as fn(&Sample) -> f64, "z", "m"),
        ("force", |one| one.value, "force", "N"),
    ] {
        let Some((n, condition)) = contrary(of).filter(|(n, _)| 2 * n > all) else { continue };
        let right = match what {
            "depth" => "a depth counts downward from the surface",
            _ => "the force of the bed counts against the push",
        };
        findings.report(
            Diagnostic::error(format!("the {what} is negative in {n} of {all} runs"))
                .at(places[condition].id, right)
                .help(format!(
                    "does it count the other way? then say below [columns]: {}",
                    columns.turned(key, unit)
                )),
        );
    }
}

/// Refuses runs with hardly a reading below the surface.
fn check_lengths(set: &MeasurementSet, places: &[ConditionPlaces], findings: &mut Findings) {
    for run in &set.runs {
        let below = run.samples.iter().filter(|sample| sample.at > 0.0).count();
        if below < FEWEST && !findings.full() {
            let name = shorten(&run.name);
            findings.report(
                Diagnostic::error(format!(
                    "the run `{name}` has {below} readings below the surface"
                ))
                .at(places[run.condition].id, "measured under this condition")
                .help(format!(
                    "expected {FEWEST} at least, with z above 0; `zero` below [columns] says where \
                     the surface is"
                )),
            );
        }
    }
}

/// Names depths and pressures that no push has; the middle run decides.
fn check_units(set: &MeasurementSet, places: &[ConditionPlaces]) -> Option<Contradiction> {
    let named = |message: String, help: &str, condition: usize| {
        let diagnostic = Diagnostic::error(message)
            .at(places[condition].diameter, "the diameter of what is pushed")
            .help(format!("{help} [columns] gives the units of a table"));
        Contradiction { kind: ContradictionKind::Speeds, diagnostic }
    };
    let deepest = |run: &Run| run.samples.iter().copied().max_by(|a, b| a.at.total_cmp(&b.at));
    let diameters = median::of_runs(set, |run| Some(deepest(run)?.at / diameter(set, run)));
    if let Some((ratio, run)) = diameters.filter(|(ratio, _)| *ratio > DEEPEST) {
        let message = format!("the depths go to {ratio:.0} diameters");
        return Some(named(message, "are they in mm or cm?", set.runs[run].condition));
    }
    if set.bed.geometry == Geometry::Planar || set.all_beds().any(|bed| bed.gravity <= 0.0) {
        return None;
    }
    let (ratio, run) = median::of_runs(set, |run| {
        let Sample { at, value, .. } = deepest(run)?;
        let bed = set.bed_of(&set.conditions[run.condition]);
        let weight = bed.bulk_density.unwrap_or(DENSITY) * bed.gravity;
        let face = PI / 4.0 * diameter(set, run).powi(2);
        Some(value / (face * weight * at))
    })?;
    let [least, most] = PRESSURES;
    if (least..=most).contains(&ratio) {
        return None;
    }
    let help = match ratio < least {
        true => "is the force in kN, the depth in mm or cm, or the zero of the force wrong?",
        false => "is the force in mN or grams, or the diameter in another unit?",
    };
    let message = format!(
        "the pressure at the deepest readings is {ratio:.2e} times that of the weight of the bed above"
    );
    Some(named(message, help, set.runs[run].condition))
}

fn diameter(set: &MeasurementSet, run: &Run) -> f64 {
    set.conditions[run.condition].diameter
}
