//! A plate, sphere or cone on a drive: the force of the medium has a closed form along the way.

use std::f64::consts::{FRAC_PI_4, PI};

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use intruders::AssemblyRequest;
use resistive::{Driven, Impact, Recorder, Sample};

use super::rig::{BED, law};

const DIAMETER: f64 = 0.04;
const SPEED: f64 = 0.01;
const DEPTH: f64 = 0.03;

/// The samples that are compared are round-off away from the closed forms.
const ROUND_OFF: f64 = 1e-12;

/// A body of this shape, pushed straight down through `laws`.
fn pushed(
    shape: &str,
    size: (&'static str, f64),
    laws: Vec<Box<dyn resistive::ResistanceLaw>>,
) -> Impact {
    let params = ParamTable::from_iter([("diameter", DIAMETER), ("shaft_diameter", 0.0), size]);
    let velocity = Vec3::new(0.0, 0.0, -SPEED);
    let casting =
        AssemblyRequest { params: &params, space: Space::Spatial, mass: 0.1, velocity, spin: 0.0 };
    let made = (intruders::find(shape).expect("a shape").assembly)(&casting);
    Impact::new(Box::new(Driven::new(made.assembly)), laws, BED, made.start)
}

/// Depth (m) and upward force (N) along the push, the work of the drive (J) and what is unaccounted for (J).
fn push(impact: &Impact) -> (Vec<[f64; 2]>, f64, f64) {
    let mut seen = Vec::new();
    let mut recorder = Recorder::new(impact, 0.1, |sample: &Sample<'_>| {
        let part = &sample.parts[0];
        seen.push([part.part.immersion.depth, (part.dynamic + part.friction).z]);
    });
    let ending = impact.run(DEPTH / SPEED, &mut recorder).expect("a push");
    let ledger = recorder.ledger().clone();
    drop(recorder);
    assert!(!ending.stopped && (ending.parts[0].depth / DEPTH - 1.0).abs() < ROUND_OFF);
    let work = ledger.value("input_drive_J").expect("a drive");
    (seen, work, ledger.balance().worst)
}

#[test]
fn a_plate_feels_drag_and_a_friction_linear_in_depth_and_the_drive_does_their_work() {
    let (drag, friction) = (1.3, 18.0);
    let two_terms = law("two-term-vector", &[("drag", drag), ("friction", friction)]);
    let plate = pushed("cylinder", ("height", 0.01), vec![two_terms]);
    let (seen, work, unaccounted) = push(&plate);
    let loaded = BED.bulk_density * FRAC_PI_4 * DIAMETER * DIAMETER;
    let force = |z: f64| loaded * (drag * SPEED * SPEED + friction * BED.gravity * z);
    // The first sample is at the touch, the last at the end.
    assert!(seen.len() > 30);
    for [depth, found] in &seen {
        assert!((found / force(*depth) - 1.0).abs() < ROUND_OFF, "{depth} m: {found} N");
        // At the touch itself the body is not in the bed yet.
        let below = depth.max(1e-12);
        let known = plate.resistance_at(below).expect("a force");
        let error = (known - force(below)).abs();
        assert!(error < ROUND_OFF * force(DEPTH), "{depth} m: {known} N without integration");
    }
    let weight = 0.1 * BED.gravity;
    let against = 0.5 * (force(0.0) + force(DEPTH)) * DEPTH;
    let expected = against - weight * DEPTH;
    assert!((work / expected - 1.0).abs() < ROUND_OFF, "{work} J, not {expected}");
    assert!(unaccounted < ROUND_OFF * against, "{unaccounted} J");
}

#[test]
fn a_cone_sets_the_medium_in_motion_at_the_rate_of_its_section() {
    // A right angle at the tip: as wide as deep from its axis; it is 20 mm high.
    let cone = pushed("cone", ("apex_angle", PI / 2.0), vec![law("added-mass", &[("q", 0.7)])]);
    let (seen, work, unaccounted) = push(&cone);
    // At the base itself, round-off decides whether there is a section.
    let height = 0.5 * DIAMETER;
    for [depth, found] in seen.iter().filter(|[depth, _]| (depth - height).abs() > 1e-9) {
        let section = if *depth < height { PI * depth * depth } else { 0.0 };
        let expected = 0.7 * BED.bulk_density * section * SPEED * SPEED;
        assert!((found - expected).abs() < ROUND_OFF * 0.1, "{depth} m: {found} N");
        let known = cone.resistance_at(*depth).expect("a force");
        assert!((known - expected).abs() < ROUND_OFF * 0.1, "{depth} m: {known} N");
    }
    // Half of the work on the medium is held in its motion, half was lost in getting it there.
    let volume = PI / 3.0 * height.powi(3);
    let against = 0.7 * BED.bulk_density * volume * SPEED * SPEED;
    let expected = against - 0.1 * BED.gravity * DEPTH;
    // The section ends at the base of the cone, in the middle of a stretch of the quadrature.
    assert!((work - expected).abs() < 0.02 * against, "{work} J, not {expected}");
    assert!(unaccounted < 0.02 * against, "{unaccounted} J");
}

#[test]
fn a_drive_that_pushes_into_nothing_lowers_the_weight() {
    let (seen, work, unaccounted) = push(&pushed("sphere", ("height", 0.0), Vec::new()));
    assert!(seen.iter().all(|[_, force]| *force == 0.0));
    let expected = -0.1 * BED.gravity * DEPTH;
    assert!((work / expected - 1.0).abs() < ROUND_OFF && unaccounted < ROUND_OFF);
}
