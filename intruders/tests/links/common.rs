//! Links and the law of their resistance, for the tests of both.

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamSpec, ParamTable};
use intruders::{AssemblyRequest, Launchable};
use resistive::{Coefficients, find_resistance};
use resistive::{Impact, ResistanceLaw, Surroundings, Tolerance};

/// Length and diameter (m) and mass (kg) of a link of aluminium.
pub(crate) const LENGTH: f64 = 0.2;
pub(crate) const DIAMETER: f64 = 0.0127;
pub(crate) const MASS: f64 = 0.0684;

/// Dry sand.
pub(crate) fn sand() -> Surroundings {
    Surroundings {
        bulk_density: 1600.0,
        gravity: 9.81,
        packing: None,
        bed_depth: None,
        fluid: None,
    }
}

/// The link at `angle` (rad) whose tip meets the surface with `velocity` (m/s).
pub(crate) fn link(angle: f64, velocity: Vec3, spin: f64) -> Launchable {
    cast("link", &[("link_angle", angle)], MASS, velocity, spin)
}

/// Two such links.
pub(crate) fn chain(angles: [f64; 2], velocity: Vec3) -> Launchable {
    let given = [("link_angle_1", angles[0]), ("link_angle_2", angles[1])];
    cast("two-link-chain", &given, 2.0 * MASS, velocity, 0.0)
}

fn cast(name: &str, given: &[(&str, f64)], mass: f64, velocity: Vec3, spin: f64) -> Launchable {
    let entry = intruders::find(name).expect("the shape is registered");
    let sizes = [("length", LENGTH), ("diameter", DIAMETER)];
    let params = fill(entry.params, &[given, &sizes].concat());
    let request = AssemblyRequest { params: &params, space: Space::Spatial, mass, velocity, spin };
    (entry.assembly)(&request)
}

/// `launchable` on sand under `laws`.
pub(crate) fn into_sand(launchable: Launchable, laws: Vec<Box<dyn ResistanceLaw>>) -> Impact {
    Impact::new(launchable.assembly, laws, sand(), launchable.start)
}

/// Down, at `speed` (m/s).
pub(crate) fn down(speed: f64) -> Vec3 {
    Vec3::new(0.0, 0.0, -speed)
}

/// As fine as the solver goes before round-off takes over.
pub(crate) const FINE: Tolerance = Tolerance { relative: 1e-14, absolute: 1e-16 };

/// The law `name` with these values and its defaults.
pub(crate) fn law(name: &str, given: &[(&str, f64)]) -> Box<dyn ResistanceLaw> {
    let entry = find_resistance(name).expect("the law is registered");
    (entry.build)(&Coefficients::new(fill(entry.params, given)))
}

/// The resistance of a link with coefficients in the middle of what is plausible.
pub(crate) fn resistance() -> Box<dyn ResistanceLaw> {
    law("link", &[("drag", 3.0), ("horizontal", 5.0)])
}

fn fill(specs: &'static [ParamSpec], given: &[(&str, f64)]) -> ParamTable {
    let mut params = ParamTable::new();
    for spec in specs {
        let value = given.iter().find(|(key, _)| *key == spec.key).map(|(_, value)| *value);
        let value = value.or(match spec.default {
            ParamDefault::Value(default) => Some(default),
            ParamDefault::Required | ParamDefault::SameAs(_) | ParamDefault::FromBase(_) => None,
        });
        params.set(spec.key, value.expect("every required value is given"));
    }
    params
}
