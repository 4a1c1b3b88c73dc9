//! Whether each speed has a body of its own: what looks like an effect of the one may be one of the other.

use crate::table::findings::Findings;
use crate::{Condition, MeasurementSet};

/// Speeds that agree to this share are one.
const SAME: f64 = 0.05;

/// A number of a body, with its name.
type OfBody = (&'static str, fn(&Condition) -> Option<f64>);

/// What bodies may differ in.
const OF_BODIES: [OfBody; 7] = [
    ("mass", |body| Some(body.mass)),
    ("diameter", |body| Some(body.diameter)),
    ("height", |body| body.height),
    ("apex angle", |body| body.apex_deg),
    ("length", |body| body.length),
    ("link angle", |body| body.link_angle_deg),
    ("shaft diameter", |body| body.shaft_diameter),
];

/// Notes where no body was measured at two speeds, and no two bodies at one.
pub(crate) fn note(set: &MeasurementSet, findings: &mut Findings) {
    let conditions = &set.conditions;
    let pairs = || {
        let each = conditions.iter().enumerate();
        each.flat_map(|(at, one)| conditions[..at].iter().map(move |other| (one, other)))
    };
    let is_own = pairs().all(|(one, other)| is_one_speed(one, other) == is_one_body(one, other));
    let are_several = conditions.iter().any(|one| !is_one_speed(one, &conditions[0]));
    if !are_several || !is_own {
        return;
    }
    let differ = |of: fn(&Condition) -> Option<f64>| pairs().any(|(a, b)| of(a) != of(b));
    let mut names: Vec<&str> =
        OF_BODIES.iter().filter(|(_, of)| differ(*of)).map(|(name, _)| *name).collect();
    if pairs().any(|(a, b)| a.shape != b.shape) {
        names.push("shape");
    }
    let names = names.join(", ");
    findings.note(format!(
        "Each speed has a body of its own: speed and {names} cannot be told apart; measure one body at two speeds."
    ));
}

fn is_one_speed(one: &Condition, other: &Condition) -> bool {
    (one.speed - other.speed).abs() <= SAME * one.speed.max(other.speed)
}

fn is_one_body(one: &Condition, other: &Condition) -> bool {
    one.shape == other.shape && OF_BODIES.iter().all(|(_, of)| of(one) == of(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TEMPLATE;

    /// What is noted of the template, with these speeds (m/s) and masses (kg) of its conditions.
    fn notes(bodies: [[f64; 2]; 4]) -> Vec<String> {
        let folder = tempfile::tempdir().expect("a folder for the test");
        for (name, text) in TEMPLATE {
            std::fs::write(folder.path().join(name), text).expect("a file");
        }
        let mut set = MeasurementSet::load(folder.path()).expect("a set").set;
        for (condition, [speed, mass]) in set.conditions.iter_mut().zip(bodies) {
            (condition.speed, condition.mass) = (speed, mass);
        }
        let mut findings = Findings::default();
        note(&set, &mut findings);
        findings.notes
    }

    #[test]
    fn a_body_for_each_speed_is_noted_and_one_body_at_two_speeds_is_not() {
        let own = notes([[1.0, 0.1], [1.0, 0.1], [2.0, 0.2], [2.01, 0.2]]);
        assert!(
            own.len() == 1 && own[0].contains("speed and mass cannot be told apart"),
            "{own:?}"
        );
        for told_apart in [
            [[1.0, 0.1], [2.0, 0.1], [1.0, 0.1], [2.0, 0.2]],
            [[1.0, 0.1], [1.0, 0.2], [2.0, 0.3], [2.0, 0.3]],
            [[1.0, 0.1], [1.0, 0.1], [1.0, 0.2], [1.0, 0.2]],
            [[1.0, 0.1], [2.0, 0.1], [3.0, 0.1], [4.0, 0.1]],
        ] {
            assert!(notes(told_apart).is_empty(), "{told_apart:?}");
        }
    }
}
