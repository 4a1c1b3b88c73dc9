//! A sphere on a medium made of named laws.

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamDefault, ParamTable};
use intruders::AssemblyRequest;
use resistive::{Coefficients, Expression, find_resistance};
use resistive::{Ending, Impact, Recorder, ResistanceLaw, Surroundings};

pub(crate) const MASS: f64 = 0.0692;
pub(crate) const DIAMETER: f64 = 0.0254;
pub(crate) const BED: Surroundings = Surroundings {
    bulk_density: 1520.0,
    gravity: 9.8,
    packing: Some(0.61),
    bed_depth: Some(0.12),
    fluid: None,
};

/// The law called `name` with these coefficients, and the defaults for the others.
pub(crate) fn law(name: &str, values: &[(&'static str, f64)]) -> Box<dyn ResistanceLaw> {
    law_of_depth(name, values, &[])
}

/// The same with some coefficients as expressions of depth.
pub(crate) fn law_of_depth(
    name: &str,
    values: &[(&'static str, f64)],
    functions: &[(&'static str, &str)],
) -> Box<dyn ResistanceLaw> {
    let entry = find_resistance(name).expect("the law is registered");
    let mut table = ParamTable::new();
    for spec in entry.params {
        if let ParamDefault::Value(value) = spec.default {
            table.set(spec.key, value);
        }
    }
    for &(key, value) in values {
        table.set(key, value);
    }
    let coefficients = functions.iter().fold(Coefficients::new(table), |all, (key, text)| {
        all.with_function(key, Expression::parse(text, &["depth"]).expect("an expression"))
    });
    (entry.build)(&coefficients)
}

/// A sphere that touches the surface at `speed` (m/s), `angle` degrees below the horizontal.
pub(crate) fn sphere(laws: Vec<Box<dyn ResistanceLaw>>, speed: f64, angle: f64) -> Impact {
    spinning_sphere(laws, speed, angle, 0.0)
}

/// The same with a `spin` (rad/s), positive where it rolls forward.
pub(crate) fn spinning_sphere(
    laws: Vec<Box<dyn ResistanceLaw>>,
    speed: f64,
    angle: f64,
    spin: f64,
) -> Impact {
    let radians = angle.to_radians();
    let (down, across) =
        if angle >= 90.0 { (1.0, 0.0) } else { (libm::sin(radians), libm::cos(radians)) };
    let velocity = Vec3::new(speed * across, 0.0, -speed * down);
    launched(BED, laws, velocity, spin)
}

/// A sphere with this `velocity` (m/s) and `spin` (rad/s) at the surface of `bed`.
pub(crate) fn launched(
    bed: Surroundings,
    laws: Vec<Box<dyn ResistanceLaw>>,
    velocity: Vec3,
    spin: f64,
) -> Impact {
    let params = ParamTable::from_iter([("diameter", DIAMETER)]);
    let casting =
        AssemblyRequest { params: &params, space: Space::Spatial, mass: MASS, velocity, spin };
    let shape = intruders::find("sphere").expect("the sphere is registered");
    let made = (shape.assembly)(&casting);
    Impact::new(made.assembly, laws, bed, made.start)
}

/// Runs to rest and says how well the ledger closes.
pub(crate) fn with_ledger(impact: &Impact) -> (Ending, f64) {
    let mut recorder = Recorder::new(impact, 1e-3, |_| {});
    let ending = impact.run(10.0, &mut recorder).expect("an impact");
    let balance = recorder.ledger().balance();
    (ending, balance.worst / balance.initial.abs().max(1e-12))
}
