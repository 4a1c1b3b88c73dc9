//! Friction that is set-valued: bodies come to rest, stay there, and move again only when pulled.

use super::rig::{BED, MASS, law, sphere};

#[test]
fn an_oblique_impact_under_vector_friction_comes_to_rest_and_stays() {
    for angle in [15.0, 45.0, 75.0, 89.0] {
        let laws = vec![law("two-term-vector", &[("drag", 1.0), ("friction", 15.0)])];
        let ending = sphere(laws, 2.0, angle).run(10.0, &mut ()).unwrap();
        assert!(ending.stopped && ending.time < 1.0, "{angle} deg: {} s", ending.time);
        assert!(ending.state.rate.iter().all(|&rate| rate == 0.0));
        assert!(ending.steps < 200, "{angle} deg: {} steps", ending.steps);
    }
}

#[test]
fn each_component_stops_by_itself_under_component_frictions() {
    // The published law at 60 deg; horizontal and vertical motion do not feel each other but through
    // the depth in the horizontal friction.
    let laws = vec![law(
        "two-term-components",
        &[("drag_x", 0.29973), ("friction_x", 1.5175), ("drag_z", 0.2184), ("friction_z", 4.02227)],
    )];
    let ending = sphere(laws, 2.0, 60.0).run(10.0, &mut ()).unwrap();
    let part = ending.parts[0];
    assert!(ending.stopped);
    assert!(part.vertical.unwrap() < ending.time + 1e-12);
    assert!(part.horizontal.unwrap() <= ending.time);
    assert!((part.time().unwrap() - ending.time).abs() < 1e-9);
}

#[test]
fn a_body_in_a_weak_medium_turns_round_where_friction_cannot_hold_it() {
    // Buoyancy of thirty times the displaced bed throws the sphere back out of a bed without friction.
    let laws = vec![
        law("two-term-vector", &[("drag", 1.0), ("friction", 0.0)]),
        law("buoyancy", &[("q", 30.0)]),
    ];
    let ending = sphere(laws, 1.0, 90.0).run(0.5, &mut ()).unwrap();
    assert!(!ending.stopped);
    assert!(ending.parts[0].vertical.is_some(), "it stopped sinking");
    let deepest = ending.parts[0].depth;
    assert!(deepest > 0.0 && -ending.state.position[1] < deepest);
}

#[test]
fn a_sphere_let_go_at_the_surface_sinks_to_twice_its_static_depth() {
    // Without drag: m g z = k z²/2 at the stop, and friction holds k z = 2 m g there.
    let laws = vec![law("two-term-vector", &[("drag", 0.0), ("friction", 15.0)])];
    let ending = sphere(laws, 0.0, 90.0).run(10.0, &mut ()).unwrap();
    let area = std::f64::consts::PI * 0.0127 * 0.0127;
    let k = 15.0 * BED.bulk_density * BED.gravity * area;
    let expected = 2.0 * MASS * BED.gravity / k;
    assert!(ending.stopped);
    assert!((ending.parts[0].depth / expected - 1.0).abs() < 1e-8);
}

#[test]
fn a_constant_friction_helps_component_frictions_to_hold_a_body_that_is_light_on_them() {
    // Where it stops, depth friction alone would not carry the weight, and friction alone neither.
    let laws = vec![
        law(
            "two-term-components",
            &[("drag_x", 0.4), ("friction_x", 1.2), ("drag_z", 0.57), ("friction_z", 5.4)],
        ),
        law("yield-stress", &[("q", 2.5)]),
    ];
    let ending = sphere(laws, 0.5, 90.0).run(10.0, &mut ()).unwrap();
    let depth = ending.parts[0].depth;
    let weight = MASS * BED.gravity;
    let area = std::f64::consts::PI * 0.0127 * 0.0127;
    let constant = 2.5 * BED.bulk_density * BED.gravity * area * 0.0254;
    assert!(ending.stopped && ending.steps < 100, "{} steps", ending.steps);
    assert!(5.4 * depth < weight && constant < weight && 5.4 * depth + constant > weight);
}

#[test]
fn a_friction_along_the_motion_stops_both_components_at_once() {
    // Where depth friction alone would not carry the weight, the body keeps sinking a little as long
    // as it moves on: then both components vanish together.
    let laws = vec![
        law(
            "two-term-components",
            &[("drag_x", 0.1), ("friction_x", 0.01), ("drag_z", 1.0), ("friction_z", 4.0)],
        ),
        law("rail-friction", &[("q", 0.6)]),
    ];
    let ending = sphere(laws, 3.0, 5.0).run(10.0, &mut ()).unwrap();
    let part = ending.parts[0];
    assert!(ending.stopped && ending.steps < 300, "{} steps", ending.steps);
    assert!(part.depth > 0.01 && 4.0 * part.depth < MASS * BED.gravity, "{part:?}");
    assert!((part.vertical.unwrap() - part.horizontal.unwrap()).abs() < 1e-3, "{part:?}");
}

#[test]
fn the_speed_falls_below_five_percent_before_the_stop_however_long_the_last_step_is() {
    // At constant deceleration a the speed is 5 % of the first at 95 % of the stopping time.
    for (baseline, values) in [
        ("poncelet", &[("inertial", 0.0), ("resistance", 3.0)][..]),
        (
            "two-term-components",
            &[("drag_x", 0.0), ("friction_x", 0.0), ("drag_z", 0.0), ("friction_z", 0.0)][..],
        ),
    ] {
        let mut laws = vec![law(baseline, values)];
        if baseline == "two-term-components" {
            let area = std::f64::consts::PI * 0.0127 * 0.0127;
            let unit = BED.bulk_density * BED.gravity * area * 0.0254;
            laws.push(law("yield-stress", &[("q", 3.0 / unit)]));
        }
        let ending = sphere(laws, 1.0, 90.0).run(10.0, &mut ()).unwrap();
        let share = ending.slow.unwrap() / ending.time;
        assert!((share - 0.95).abs() < 1e-9, "{baseline}: {share}");
        assert_eq!(ending.rest, ending.slow);
    }
}

#[test]
fn the_flight_that_led_to_the_impact_is_a_free_fall_at_every_time_that_is_asked_for() {
    let (down, across) =
        (2.0 * libm::sin(60_f64.to_radians()), 2.0 * libm::cos(60_f64.to_radians()));
    let laws = vec![law("two-term-vector", &[("drag", 1.0), ("friction", 15.0)])];
    let times = [-1e-4, -0.003, -0.02, -0.021, -0.04, -0.1];
    let states = sphere(laws, 2.0, 60.0).flight(&times).unwrap();
    for (time, state) in times.into_iter().zip(states) {
        let [x, z, ..] = state.position;
        let fallen = -down * time - 0.5 * BED.gravity * time * time;
        // The tolerance of the integration, over a tenth of a metre.
        assert!((z - fallen).abs() < 1e-11, "{time} s: {z}");
        assert!((x - across * time).abs() < 1e-11, "{time} s: {x}");
    }
}
