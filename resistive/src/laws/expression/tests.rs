//! Own effects against those of the table, and what is refused.

use crate::{Load, ResistanceLaw, Space};

use std::sync::Arc;

use super::super::Effect;
use super::super::testing::{SPHERE, sinking, surroundings};
use super::*;

/// At 2 m/s and 1 rad.
const APPROACH: Approach = Approach { speed: 2.0, angle: 1.0 };

fn parameter(name: &str, dimension: Dimension, value: Option<f64>) -> OwnParameter {
    OwnParameter { name: name.to_owned(), dimension, value, range: Range::closed(0.0, 10.0) }
}

fn draft(force: &str, direction: Direction) -> Draft {
    Draft {
        id: "late-drag".to_owned(),
        summary: String::new(),
        force: force.to_owned(),
        direction,
        acts: Acts::InBed,
        parameters: vec![parameter("q", Dimension::NONE, None)],
        space: Space::Spatial,
    }
}

fn own(force: &str, direction: Direction) -> Arc<OwnEffect> {
    Arc::new(
        OwnEffect::new(draft(force, direction), |_| false)
            .unwrap_or_else(|error| panic!("{error}")),
    )
}

fn load(law: &dyn ResistanceLaw, depth: f64, speed: f64) -> Load {
    let mut load = Load::default();
    law.act(&SPHERE.at(depth), &sinking(speed), &surroundings(), &mut load);
    load
}

#[test]
fn the_formula_of_a_listed_effect_is_that_effect() {
    for (name, force, direction) in [
        ("viscous-drag", "q * rho * A * sqrt(g * D) * v", Direction::AgainstMotion),
        ("viscous-drag", "q * ρ * A * V_s * v", Direction::AgainstMotion),
        ("buoyancy", "q * rho * g * V", Direction::Up),
        ("yield-stress", "q * rho * g * A * D", Direction::Friction),
    ] {
        let listed = Effect::listed(name).expect("a listed effect").build(0.7, APPROACH);
        let own = own(force, direction).build(0.7, APPROACH);
        for (depth, speed) in [(0.003, 2.0), (0.02, 0.5), (0.04, 1e-3)] {
            let (listed, own) = (load(&*listed, depth, speed), load(&*own, depth, speed));
            let scale = listed.dynamic.norm() + listed.friction.norm();
            let apart =
                (listed.dynamic - own.dynamic).norm() + (listed.friction - own.friction).norm();
            // Round-off of some five products.
            assert!(apart < 1e-14 * scale, "{name}: {listed:?} {own:?}");
        }
    }
}

#[test]
fn every_direction_is_the_one_that_it_says() {
    use Direction::{AgainstMotion, Backward, Down, Forward, Normal, Up};
    for (direction, x, z) in [
        (AgainstMotion, 0.0, 1.0),
        (Up, 0.0, 1.0),
        (Down, 0.0, -1.0),
        (Forward, 1.0, 0.0),
        (Backward, -1.0, 0.0),
        (Normal, 1.0, 0.0),
    ] {
        let effect = own("q * m * g * v / V_s", direction);
        let force = load(&*effect.build(2.0, APPROACH), 0.01, 1.0).dynamic;
        let size = force.norm();
        assert!((force.x - x * size).abs() < 1e-12 && (force.z - z * size).abs() < 1e-12);
        let sideways = matches!(direction, Forward | Backward | Normal);
        assert_eq!(effect.build(2.0, APPROACH).deflects(), sideways);
    }
}

#[test]
fn a_broken_power_of_the_speed_is_continued_evenly_beyond_a_reversal() {
    let law =
        own("q * rho * A * V_s^2 * (v / V_s)^1.5", Direction::AgainstMotion).build(1.0, APPROACH);
    let (before, beyond) = (load(&*law, 0.01, 0.3).dynamic, load(&*law, 0.01, -0.3).dynamic);
    assert!(before.z > 0.0 && (before.z - beyond.z).abs() < 1e-15);
    let linear = own("q * rho * A * V_s * v", Direction::AgainstMotion).build(1.0, APPROACH);
    assert!(load(&*linear, 0.01, -0.3).dynamic.z < 0.0, "where there is a value it is taken");
}

#[test]
fn what_the_data_must_contain_follows_from_the_variables() {
    let of = |force| own(force, Direction::Up).visible();
    assert_eq!(of("q * m * g * z / D"), []);
    assert_eq!(of("q * m * omega * v"), [Needs::Spin]);
    assert_eq!(of("q * m * g * phi * (1 - phi) * z / H"), [Needs::Packings, Needs::BedDepth]);
    let effect = own("q * m * g * phi", Direction::Up);
    let force = load(&*effect.build(1.0, APPROACH), 0.01, 1.0);
    assert_eq!(force, Load::default(), "a bed that does not say its packing has no such force");
    assert_eq!(Effect::Own(effect).unit(), "1");
}

#[test]
fn angles_impact_speeds_and_time_are_known() {
    let law = own("q * m * g * sin(theta)", Direction::Up)
        .build(1.0, Approach { angle: 0.5, ..APPROACH });
    let expected = 0.0692 * 9.8 * libm::sin(0.5);
    assert!((load(&*law, 0.01, 1.0).dynamic.z - expected).abs() < 1e-15);
    let law =
        own("q * m * g^2 * t / V_s", Direction::Up).build(1.0, Approach { angle: 0.5, ..APPROACH });
    let motion = Motion { time: 0.25, ..sinking(1.0) };
    let mut late = Load::default();
    law.act(&SPHERE.at(0.01), &motion, &surroundings(), &mut late);
    let expected = 0.0692 * 9.8 * 9.8 * 0.25 / (9.8_f64 * 0.0254).sqrt();
    assert!((late.dynamic.z - expected).abs() < 1e-14);
    let law = own("q * m * g * v / v_0", Direction::Up).build(1.0, APPROACH);
    let expected = 0.0692 * 9.8 * 0.5 / 2.0;
    assert!((load(&*law, 0.01, 0.5).dynamic.z - expected).abs() < 1e-15);
}

#[test]
fn a_planar_medium_has_planar_areas_and_densities() {
    let force = "q * rho * A * v^2";
    for space in [Space::Planar, Space::Spatial] {
        let draft = Draft { space, ..draft(force, Direction::AgainstMotion) };
        assert!(OwnEffect::new(draft, |_| false).is_ok());
    }
    let wrong = Draft { space: Space::Planar, ..draft("q * rho * D^2 * v^2", Direction::Up) };
    assert!(matches!(OwnEffect::new(wrong, |_| false), Err(OwnEffectError::Dimension(_))));
}

#[test]
fn what_is_no_effect_is_refused_by_its_reason() {
    let message = |draft: Draft| {
        OwnEffect::new(draft, |id| id == "hertz-mindlin").expect_err("a fault").to_string()
    };
    let good = || draft("q * rho * A * v^2", Direction::AgainstMotion);
    for (id, what) in [
        ("Late Drag", "lowercase letters"),
        ("-a", "lowercase letters"),
        ("janssen", "comes with"),
        ("inertial-drag", "account of energy"),
        ("expression", "comes with"),
        ("hertz-mindlin", "comes with"),
    ] {
        let named = Draft { id: id.to_owned(), ..good() };
        assert!(message(named).contains(what), "{id}");
    }
    for (name, what) in
        [("v", "a variable of the state"), ("sin", "a function"), ("2a", "a letter first")]
    {
        let mut draft = good();
        draft.parameters.push(parameter(name, Dimension::NONE, Some(1.0)));
        assert!(message(draft).contains(what), "{name}");
    }
    let mut unused = good();
    unused.parameters.push(parameter("c", Dimension::NONE, Some(1.0)));
    assert_eq!(message(unused), "the formula does not use `c`");
    let none = Draft { parameters: Vec::new(), ..good() };
    assert!(message(none).contains("`q`, the amplitude, is missing"));
    let mut never = good();
    never.parameters[0].range = Range::closed(1.0, 2.0);
    assert!(message(never).contains("leaves out 0"));
    assert!(message(draft("q * rho * A * v", Direction::Up)).contains("expected a force (N)"));
    assert!(message(draft("q * rho * A * vv", Direction::Up)).contains("`vv` is not known here"));
}

#[test]
fn a_force_that_is_not_what_it_says_is_found_in_a_state() {
    let check = |force, direction, speed: f64| {
        let (at, bed) = (SPHERE.at(0.01), surroundings());
        let motion = Motion { velocity: sinking(speed).velocity, ..sinking(speed) };
        own(force, direction).check(&at, &motion, &bed, APPROACH).map_err(|error| error.to_string())
    };
    let at_rest = check("q * m * g", Direction::AgainstMotion, 0.0).unwrap_err();
    // The weight of 69.2 g, ten times over: the amplitude that is tried is the greatest.
    assert!(at_rest.starts_with("is 6.782e0 N at rest"), "{at_rest}");
    assert_eq!(check("q * m * g", Direction::Friction, 0.0), Ok(()));
    assert_eq!(check("q * m * g * v / V_s", Direction::AgainstMotion, 0.0), Ok(()));
    assert!(check("-q * m * g", Direction::Friction, 1.0).unwrap_err().contains("negative"));
    assert!(check("(1 + q) * m * g", Direction::Up, 1.0).unwrap_err().contains("q = 0"));
    let never = check("q * m * g * ln(z / D - 1)", Direction::Up, 1.0).unwrap_err();
    assert_eq!(never, "is not finite");
}
