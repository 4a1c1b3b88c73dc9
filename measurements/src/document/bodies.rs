//! Sizes and masses of intruders that no body has.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use configs::Diagnostic;
use configs::reader::Reader;
use engine::fluid::Fluid;
use engine::grains::Space;
use engine::units::significant;

use crate::Condition;
use crate::document::conditions::ConditionPlaces;

/// Least and greatest mean density of a body (kg/m³): below the first it is lighter than any foam, above the
/// second heavier than any metal.
pub const POSSIBLE_DENSITY: RangeInclusive<f64> = 10.0..=3e4;

/// Densities (kg/m³) of which intruders are made.
pub const USUAL_DENSITY: RangeInclusive<f64> = 100.0..=2.3e4;

/// Factors of units that are taken for metres and kilograms: diameter, mass, and what they are called.
const UNITS: [(f64, f64, &str); 7] = [
    (1e-3, 1.0, "is the diameter in mm?"),
    (1e-2, 1.0, "is the diameter in cm?"),
    (0.0254, 1.0, "is the diameter in inches?"),
    (1.0, 1e-3, "is the mass in g?"),
    (1e-3, 1e-3, "is the diameter in mm, and the mass in g?"),
    (1e-2, 1e-3, "is the diameter in cm, and the mass in g?"),
    (1.0, 1e-6, "is the mass in mg?"),
];

/// Refuses conditions whose intruders would be lighter or heavier than any body, or have a shaft that no body has.
pub(crate) fn check(reader: &Reader<'_>, conditions: &[Condition], places: &[ConditionPlaces]) {
    for (condition, places) in conditions.iter().zip(places) {
        one(reader, condition, places);
        shaft(reader, condition, places);
    }
}

fn one(reader: &Reader<'_>, condition: &Condition, places: &ConditionPlaces) {
    // Of a body that is pushed no mass is stated.
    if condition.mass <= 0.0 {
        return;
    }
    let density = |size: f64, mass: f64| {
        // Height and diameter are likely in the same unit.
        volume(condition).map(|volume| mass * condition.mass / (volume * size.powi(3)))
    };
    let Some(found) = density(1.0, 1.0) else { return };
    // The mass is that of the body and its shaft, which is as long as it may be.
    let is_shafted = condition.shaft_diameter.is_some();
    if POSSIBLE_DENSITY.contains(&found) || (is_shafted && found > *POSSIBLE_DENSITY.end()) {
        return;
    }
    let likely = UNITS.iter().find(|(size, mass, _)| {
        density(*size, *mass).is_some_and(|there| USUAL_DENSITY.contains(&there))
    });
    let Condition { diameter, mass, shape, .. } = condition;
    let help = match likely {
        Some((size, grams, question)) => {
            let mut lines = Vec::new();
            if *size < 1.0 {
                lines.push(format!("diameter = {}", significant(size * diameter, DIGITS)));
            }
            if *grams < 1.0 {
                lines.push(format!("mass = {}", significant(grams * mass, DIGITS)));
            }
            format!("{question} then write {}", lines.join(" and "))
        }
        None if may_have_a_shaft(shape) => format!(
            "a diameter is in metres, a mass in kilograms; if the mass is that of a longer body, write \
             shaft_diameter = {diameter} for what follows the {shape}"
        ),
        None => "a diameter is in metres, a mass in kilograms".to_owned(),
    };
    reader.report(
        Diagnostic::error(format!(
            "a {shape} of {diameter} m and {mass} kg has a density of {found:.2e} kg/m^3, as no body has"
        ))
        .at(places.diameter, "in metres")
        .with(places.mass, "in kilograms")
        .help(help),
    );
}

/// Whether a body of this shape may have a shaft.
fn may_have_a_shaft(shape: &str) -> bool {
    intruders::find(shape).is_some_and(|entry| entry.under_shaft.is_some())
}

/// Refuses shafts of shapes that have none, and those wider than the body before them.
fn shaft(reader: &Reader<'_>, condition: &Condition, places: &ConditionPlaces) {
    let Condition { diameter, shape, shaft_diameter: Some(shaft), .. } = condition else { return };
    let (what, help) = match may_have_a_shaft(shape) {
        false => (
            format!("a {shape} has no shaft"),
            format!("{} may have one", intruders::with_shafts()),
        ),
        true if shaft > diameter => (
            format!("a shaft of {shaft} m is wider than its {shape}, {diameter} m"),
            format!("write shaft_diameter = {diameter} or less"),
        ),
        true => return,
    };
    reader.report(Diagnostic::error(what).at(places.shaft, "a shaft").help(help));
}

/// Digits of a number that is written: more would be the noise of a multiplication.
const DIGITS: usize = 10;

/// Acceleration (m/s²) with which the body of `condition` falls in `fluid` at its speed at contact; `None` where its volume
/// is not known.
pub(crate) fn fall(condition: &Condition, gravity: f64, fluid: &Fluid) -> Option<f64> {
    let Condition { diameter, mass, speed, .. } = *condition;
    let volume = volume(condition)?;
    let drag = fluid.resistance(diameter, PI / 4.0 * diameter * diameter, speed) * speed;
    let weight = (mass - fluid.density * volume) * gravity;
    let sine = libm::sin(condition.angle_deg.to_radians());
    Some((weight - drag * sine) / (mass + fluid.added_mass(diameter, volume)))
}

/// (m³); `None` where the shape or the set does not say it.
fn volume(condition: &Condition) -> Option<f64> {
    let shape =
        condition.shape_entry().filter(|entry| entry.spatial && entry.measured.tip.is_some())?;
    Some((shape.volume)(&condition.sizes(shape).ok()?, Space::Spatial))
}
