//! Own effects as parts of an impact: the same path as the effect of the table, or the Rust type, that
//! they spell, with a ledger that closes.

use std::sync::Arc;

use engine::grains::Space;
use engine::params::Range;
use engine::units::Dimension;
use resistive::{Acts, Approach, Direction, Draft, OwnEffect, OwnParameter};
use resistive::{Impact, ImpactError, Recorder, ResistanceLaw, Trajectory};

use super::late_drag;
use super::rig::{law, sphere, with_ledger};

/// Both integrations err by some 1e-10 of the depth.
const APART: f64 = 1e-9;

/// As for the effects of the table.
const CLOSURE: f64 = 1e-8;

/// Of forces that do not depend on it.
const APPROACH: Approach = Approach { speed: 2.0, angle: 1.0 };

fn own(force: &str, direction: Direction) -> Arc<OwnEffect> {
    let parameter = |name: &str, dimension, value| OwnParameter {
        name: name.to_owned(),
        dimension,
        value,
        range: Range::closed(0.0, 10.0),
    };
    let mut parameters = vec![parameter("q", Dimension::NONE, None)];
    if force.contains("reach") {
        parameters.push(parameter("reach", Dimension::LENGTH, Some(0.01)));
    }
    let draft = Draft {
        id: "my-own".to_owned(),
        summary: String::new(),
        force: force.to_owned(),
        direction,
        acts: Acts::InBed,
        parameters,
        space: Space::Spatial,
    };
    Arc::new(OwnEffect::new(draft, |_| false).expect("an effect"))
}

fn with(effect: Box<dyn ResistanceLaw>, angle: f64) -> Impact {
    let baseline = law("two-term-vector", &[("drag", 1.0), ("friction", 15.0)]);
    sphere(vec![baseline, effect], 2.0, angle)
}

/// The largest distance between two paths (m) on a hundred points, and between their stops (s).
fn apart(first: &Impact, second: &Impact) -> [f64; 2] {
    let times: Vec<f64> = (0..100).map(|k| 1e-3 * f64::from(k)).collect();
    let [(a, first), (b, second)] = [first, second].map(|impact| {
        let mut path = Trajectory::at(&times);
        let ending = impact.run(10.0, &mut path).expect("an impact");
        (ending.time, path.states().to_vec())
    });
    let between = first.iter().zip(&second).map(|(a, b)| {
        (a.position[0] - b.position[0]).abs().max((a.position[1] - b.position[1]).abs())
    });
    [between.fold(0.0, f64::max), (a - b).abs()]
}

#[test]
fn a_formula_of_a_listed_effect_gives_its_path() {
    for (name, force, direction) in [
        ("viscous-drag", "q * rho * A * sqrt(g * D) * v", Direction::AgainstMotion),
        ("buoyancy", "q * rho * g * V", Direction::Up),
        ("yield-stress", "q * rho * g * A * D", Direction::Friction),
    ] {
        for angle in [90.0, 40.0] {
            let listed = with(law(name, &[("q", 0.5)]), angle);
            let formula = with(own(force, direction).build(0.5, APPROACH), angle);
            let [path, stop] = apart(&listed, &formula);
            assert!(path < APART && stop < APART, "{name} at {angle}: {path:e} m, {stop:e} s");
        }
    }
}

#[test]
fn the_ledger_of_every_direction_closes_under_the_name_of_the_effect() {
    use Direction::{AgainstMotion, Backward, Down, Forward, Friction, Normal, Up};
    for direction in [AgainstMotion, Friction, Up, Down, Forward, Backward, Normal] {
        for angle in [90.0, 40.0] {
            let effect = own("q * rho * A * v^2 * z / D", direction);
            let impact = with(effect.build(0.3, APPROACH), angle);
            let (ending, closure) = with_ledger(&impact);
            assert!(ending.stopped, "{direction:?} at {angle} deg did not stop");
            assert!(closure < CLOSURE, "{direction:?} at {angle} deg: {closure:e}");
            let recorder = Recorder::new(&impact, 1e-3, |_| {});
            let keys: Vec<String> = recorder.ledger().terms().iter().map(|t| t.key()).collect();
            assert!(keys.contains(&"dissipated_my_own_J".to_owned()), "{keys:?}");
        }
    }
}

#[test]
fn a_broken_power_of_the_speed_brings_a_body_to_rest() {
    let effect = own("q * rho * A * V_s^2 * (v / V_s)^1.5", Direction::AgainstMotion);
    for angle in [90.0, 40.0] {
        let (ending, closure) = with_ledger(&with(effect.build(1.0, APPROACH), angle));
        assert!(ending.stopped && closure < CLOSURE, "{closure:e}");
    }
}

#[test]
fn a_force_that_loses_its_value_is_named_with_the_step() {
    let effect = own("q * m * g * sqrt(1 - z / reach)", Direction::Up);
    let error = with(effect.build(1.0, APPROACH), 90.0).run(10.0, &mut ()).unwrap_err();
    let ImpactError::NotFinite { law, depth, speed, time } = &error else { panic!("{error}") };
    assert_eq!(law, "my-own");
    // The formula ends 10 mm deep, which the sphere passes at some 2 m/s; the step that fails is small.
    assert!((depth - 0.01).abs() < 1e-3 && (1.0..2.0).contains(speed), "{error}");
    assert!((0.004..0.008).contains(time), "{error}");
}

#[test]
fn two_runs_have_equal_bits() {
    let effect =
        own("q * rho * A * v^2 * tanh(z / D) * exp(-t * g / V_s)", Direction::AgainstMotion);
    let depth = || with(effect.build(0.3, APPROACH), 40.0).run(10.0, &mut ()).expect("an impact");
    assert_eq!(depth(), depth());
}

#[test]
fn time_counts_from_first_contact_in_every_stage_of_a_step() {
    // A push that ends: up to the stop its impulse is the integral over time, m g T (1 - exp(-t/T)).
    let push = own("q * m * g * exp(-t * g / V_s)", Direction::Down);
    let drop = |law| sphere(vec![law], 1.0, 90.0);
    let time = 0.2;
    let mut path = Trajectory::at(std::slice::from_ref(&time));
    drop(push.build(1.0, APPROACH)).run(time, &mut path).expect("a fall");
    let scale = (super::rig::BED.gravity * super::rig::DIAMETER).sqrt() / super::rig::BED.gravity;
    let pushed = super::rig::BED.gravity * scale * (1.0 - libm::exp(-time / scale));
    let expected = -1.0 - super::rig::BED.gravity * time - pushed;
    let found = path.states()[0].rate[1];
    assert!((found / expected - 1.0).abs() < APART, "{found} {expected}");
}

#[test]
fn the_formula_and_the_type_of_the_docs_are_one_effect() {
    let [formula, of_type] = late_drag::impacts();
    let [path, stop] = apart(&formula, &of_type);
    assert!(path < APART && stop < APART, "{path:e} m, {stop:e} s");
}

#[test]
fn the_docs_show_the_example_as_it_is_compiled() {
    let docs = include_str!("../../../docs/user-effects.md");
    let example = include_str!("../../examples/late_drag/effect.rs");
    let blocks = docs.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next());
    let mut shown = 0;
    for block in blocks {
        assert!(example.contains(block), "the example has no such lines:\n{block}");
        shown += 1;
    }
    assert_eq!(shown, 2);
    let effect = docs.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let effect = effect.expect("the docs begin with a formula");
    assert!(late_drag::MODEL.contains(effect), "the example has no such effect:\n{effect}");
}
