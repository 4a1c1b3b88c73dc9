//! Momentum and angular momentum of a system that nothing acts on.

use engine::math::Vec3;
use engine::parallel::with_threads;
use engine::world::World;
use validation::rig::{MIDDLE, run};

use crate::cloud::{Cloud, Collisions};

/// A sum of vectors, and the sum of their lengths.
type Total = (Vec3, f64);

fn add(total: &mut Total, part: Vec3) {
    total.0 += part;
    total.1 += part.norm();
}

/// Momentum (kg m/s), and angular momentum about the middle (kg m²/s), orbital and spin.
fn momenta(world: &World) -> (Total, Total) {
    let (mut linear, mut angular) = ((Vec3::zeros(), 0.0), (Vec3::zeros(), 0.0));
    let grains = &world.bed().grains;
    for (i, grain) in grains.iter().enumerate() {
        let momentum = grain.velocity * grain.mass;
        add(&mut linear, momentum);
        add(&mut angular, (grain.position - MIDDLE).cross(&momentum));
        add(&mut angular, grain.spin * grains.inertia(i));
    }
    for body in world.intruder().bodies() {
        let momentum = body.velocity * body.mass;
        add(&mut linear, momentum);
        add(&mut angular, (body.position - MIDDLE).cross(&momentum));
        add(&mut angular, body.angular_momentum);
    }
    (linear, angular)
}

#[test]
fn a_collapsing_cloud_keeps_its_momentum_and_its_angular_momentum() {
    for seed in [1, 2, 3] {
        with_threads(1, || {
            let mut world = Cloud::random(60, seed).world();
            let (linear, angular) = momenta(&world);
            let (mut worst_linear, mut worst_angular) = (0.0_f64, 0.0_f64);
            let (mut touches, mut collisions) = (0, Collisions::default());
            for _ in 0..1_000 {
                run(&mut world, 10);
                collisions.watch(&world);
                touches += world.intruder().bodies()[0].contact.contacts;
                let (now_linear, now_angular) = momenta(&world);
                worst_linear = worst_linear.max((now_linear.0 - linear.0).norm() / linear.1);
                worst_angular = worst_angular.max((now_angular.0 - angular.0).norm() / angular.1);
            }
            assert!(collisions.count > 100 && touches > 100, "{} {touches}", collisions.count);
            // Forces and couples are exactly opposite, so only the sums round: 10⁴ steps of 2e-16
            // each, in random directions.
            assert!(worst_linear <= 1e-13, "seed {seed}: {worst_linear:e}");
            // Positions are rounded as well, by 1e-17 m of some 1e-2 m in each step.
            assert!(worst_angular <= 1e-12, "seed {seed}: {worst_angular:e}");
        })
        .expect("one thread");
    }
}
