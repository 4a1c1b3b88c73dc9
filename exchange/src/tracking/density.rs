//! Refuses diameters and masses of impossible densities, in the words of the command line.

use std::f64::consts::PI;

use measurements::{POSSIBLE_DENSITY, USUAL_DENSITY};

use super::fault::Fault;

/// Mistakes: the written units of diameter and mass (empty for any unit), the factors that correct both, and the mistake in words.
const MISTAKES: [(&str, &str, f64, f64, &str); 8] = [
    ("", "", 2.0, 1.0, "the diameter looks like a radius"),
    ("cm", "", 0.1, 1.0, "the diameter looks like cm for mm"),
    ("", "kg", 1.0, 1e-3, "the mass looks like kg for g"),
    ("mm", "", 10.0, 1.0, "the diameter looks like mm for cm"),
    ("m", "", 1e-3, 1.0, "the diameter looks like m for mm"),
    ("", "", 0.1, 1.0, "the diameter looks ten times too large"),
    ("", "", 10.0, 1.0, "the diameter looks ten times too small"),
    ("", "g", 1.0, 1e3, "the mass looks like g for kg"),
];

/// Refuses a ball whose diameter (m) and mass (kg) give an impossible density. Each number comes with the text that the user
/// wrote and the place of that text.
pub(super) fn refuse(
    (size, diameter): (f64, (String, String)),
    (weight, mass): (f64, (String, String)),
) -> Result<(), Fault> {
    let density =
        |longer: f64, heavier: f64| heavier * weight / (PI / 6.0 * (longer * size).powi(3));
    let found = density(1.0, 1.0);
    if POSSIBLE_DENSITY.contains(&found) {
        return Ok(());
    }
    let what = format!(
        "a sphere of {} and {} has a density of {found:.3e} kg/m^3, as no body has",
        diameter.0, mass.0
    );
    let has = |text: &str, unit: &str| {
        unit.is_empty()
            || text.trim_end_matches(char::is_alphabetic).len() + unit.len() == text.len()
                && text.ends_with(unit)
    };
    let is_likely = |(of_diameter, of_mass, longer, heavier, _): &&(&str, &str, f64, f64, &str)| {
        has(&diameter.0, of_diameter)
            && has(&mass.0, of_mass)
            && USUAL_DENSITY.contains(&density(*longer, *heavier))
    };
    let right = match MISTAKES.iter().find(is_likely) {
        Some((_, _, longer, heavier, why)) => format!(
            "{why}: {:.2} mm and {:.4} g make {:.0} kg/m^3",
            1e3 * longer * size,
            1e3 * heavier * weight,
            density(*longer, *heavier)
        ),
        None => {
            "give the diameter and the mass with their units: --diameter 25.4mm --mass \"67 g\""
                .to_owned()
        }
    };
    Err(Fault::new(&diameter.1, what, right))
}
