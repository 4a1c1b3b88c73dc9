//! Poncelet's law has closed forms: eqs 18–22 of the three-shape manuscript, restored.

use resistive::Trajectory;

use super::rig::{BED, MASS, law, law_of_depth, sphere};

/// Solver errors and the last 1e-10 m at constant deceleration stay far below this (relative).
const TOLERANCE: f64 = 1e-8;

fn poncelet(h: f64, beta: f64) -> Vec<Box<dyn resistive::ResistanceLaw>> {
    vec![law("poncelet", &[("inertial", h), ("resistance", beta)])]
}

#[test]
fn a_body_under_constant_drag_and_resistance_stops_where_the_closed_form_says() {
    for (h, beta, speed) in [(0.8, 4.0, 2.0), (0.05, 0.7, 0.5), (3.0, 20.0, 4.0), (1e-6, 1.5, 1.0)]
    {
        let ending = sphere(poncelet(h, beta), speed, 90.0).run(10.0, &mut ()).unwrap();
        let energy = 0.5 * MASS * speed * speed;
        let net = beta - MASS * BED.gravity;
        let expected = MASS / (2.0 * h) * libm::log1p(2.0 * h * energy / (MASS * net));
        assert!(ending.stopped);
        let error = ending.parts[0].depth / expected - 1.0;
        assert!(error.abs() < TOLERANCE, "h {h}, beta {beta}, v {speed}: off by {error:e}");
        assert!(ending.steps < 60, "{} steps", ending.steps);
    }
}

#[test]
fn its_kinetic_energy_falls_with_depth_as_the_closed_form_says() {
    let (h, beta, speed) = (0.8, 4.0, 2.0);
    let times: Vec<f64> = (1..40).map(|k| f64::from(k) * 5e-4).collect();
    let mut seen = Trajectory::at(&times);
    sphere(poncelet(h, beta), speed, 90.0).run(10.0, &mut seen).unwrap();
    let start = 0.5 * MASS * speed * speed;
    let offset = MASS * (beta - MASS * BED.gravity) / (2.0 * h);
    for state in seen.states() {
        let (depth, velocity) = (-state.position[1], state.rate[1]);
        let expected = (start + offset) * libm::exp(-2.0 * h * depth / MASS) - offset;
        let found = 0.5 * MASS * velocity * velocity;
        assert!((found - expected).abs() < TOLERANCE * start, "at {depth} m: {found} J");
    }
}

#[test]
fn a_resistance_linear_in_depth_has_a_closed_form_too() {
    let (h, k, speed) = (0.8, 72.0, 2.0);
    let laws = vec![law_of_depth("poncelet", &[("inertial", h)], &[("resistance", "72 * depth")])];
    let times: Vec<f64> = (1..40).map(|k| f64::from(k) * 1e-3).collect();
    let mut seen = Trajectory::at(&times);
    sphere(laws, speed, 90.0).run(10.0, &mut seen).unwrap();
    let start = 0.5 * MASS * speed * speed;
    let rest = MASS * MASS * BED.gravity / (2.0 * h) + k * MASS * MASS / (4.0 * h * h);
    for state in seen.states() {
        let (depth, velocity) = (-state.position[1], state.rate[1]);
        let expected = (start - rest) * libm::exp(-2.0 * h * depth / MASS) + rest
            - k * MASS * depth / (2.0 * h);
        let found = 0.5 * MASS * velocity * velocity;
        assert!((found - expected).abs() < TOLERANCE * start, "at {depth} m: {found} J");
    }
}

#[test]
fn drag_and_resistance_that_are_functions_of_depth_agree_with_quadrature() {
    // K(z) = p(z) (K₀ + ∫ (M g − β)/p dz'), p = exp(−2/M ∫ h dz'), by Simpson's rule.
    let h = |z: f64| 0.5 + 20.0 * z;
    let beta = |z: f64| 2.0 + 900.0 * z * z;
    let laws = vec![law_of_depth(
        "poncelet",
        &[],
        &[("inertial", "0.5 + 20 * depth"), ("resistance", "2 + 900 * depth^2")],
    )];
    let speed = 2.0;
    let ending = sphere(laws, speed, 90.0).run(10.0, &mut ()).unwrap();
    let deepest = ending.parts[0].depth;
    let integrated = |z: f64| 0.5 * z + 10.0 * z * z;
    let factor = |z: f64| libm::exp(-2.0 / MASS * integrated(z));
    assert!((integrated(0.01) - 0.01 * h(0.005)).abs() < 1e-12, "∫h is the integral of h");
    let n = 4000;
    let step = deepest / f64::from(n);
    let inner = |z: f64| (MASS * BED.gravity - beta(z)) / factor(z);
    let sum: f64 = (0..n)
        .map(|k| {
            let z = f64::from(k) * step;
            step / 6.0 * (inner(z) + 4.0 * inner(z + 0.5 * step) + inner(z + step))
        })
        .sum();
    let start = 0.5 * MASS * speed * speed;
    let left = factor(deepest) * (start + sum);
    assert!(left.abs() < TOLERANCE * start, "{left:e} J are left at the stop");
}

#[test]
fn a_resistance_below_the_weight_never_stops_the_body() {
    let ending = sphere(poncelet(0.5, 0.3), 1.0, 90.0).run(2.0, &mut ()).unwrap();
    assert!(!ending.stopped);
    let terminal = ((MASS * BED.gravity - 0.3) / 0.5_f64).sqrt();
    assert!((-ending.state.rate[1] / terminal - 1.0).abs() < TOLERANCE);
}
