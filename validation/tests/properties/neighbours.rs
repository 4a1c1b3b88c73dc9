//! The neighbour search finds what looking at all pairs finds.

use engine::bed::{GrainKind, fill, random};
use engine::boundary::Container;
use engine::grains::{Grain, Grains, Space};
use engine::math::Vec3;
use engine::parallel::with_threads;
use engine::world::World;
use rand::RngExt;
use validation::rig::{MIDDLE, ROOM, Size, bed, run};

use crate::cloud::{Cloud, laws};

/// A collision of two of the smallest grains lasts 60 µs.
const DT: f64 = 2e-6;

const LARGEST: f64 = 1e-2;

/// Grains of one material, from the largest down to a twentieth of it.
const KINDS: [(usize, f64); 3] = [(4, LARGEST), (40, LARGEST / 4.0), (150, LARGEST / 20.0)];

fn size(radius: f64) -> Size {
    Size { radius, mass: 9.4 * radius * radius }
}

fn all_touching_pairs(grains: &Grains) -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for i in 0..grains.len() {
        for j in i + 1..grains.len() {
            let distance = (grains.position(i) - grains.position(j)).norm();
            if grains.radius(i) + grains.radius(j) - distance > 0.0 {
                pairs.push([i, j]);
            }
        }
    }
    pairs
}

/// Steps `world`, compares every tenth step, and returns how many contacts were seen.
fn check(world: &mut World, steps: usize) -> usize {
    let mut seen = 0;
    for _ in 0..steps / 10 {
        run(world, 10);
        let grains = &world.bed().grains;
        let found = world.bed().touching_pairs();
        assert_eq!(found, all_touching_pairs(grains), "step {}", world.clock().step);
        seen += found.len();
        for body in world.intruder().bodies() {
            let reach = body.surface().bounding_radius();
            let touch =
                |grain: &Grain| (grain.position - body.position).norm() < reach + grain.radius;
            let expected = grains.iter().filter(touch).count();
            assert_eq!(body.contact.contacts as usize, expected, "step {}", world.clock().step);
        }
    }
    seen
}

#[test]
fn the_pairs_that_touch_in_a_plane_are_those_of_all_pairs_at_a_size_ratio_of_twenty() {
    for seed in [1, 2, 3] {
        let container = Container::walled_box(0.1, 0.0);
        let kinds =
            KINDS.map(|(count, radius)| GrainKind { count, radius, mass: size(radius).mass });
        let mut rng = random(seed, "velocities");
        let mut number = || 2.0 * rng.random::<f64>() - 1.0;
        let grains: Vec<Grain> = fill(&kinds, (Space::Planar, &container), seed)
            .into_iter()
            .map(|grain| Grain { velocity: Vec3::new(number(), 0.0, number()), ..grain })
            .collect();
        let gravity = Vec3::new(0.0, 0.0, -9.81);
        with_threads(1, || {
            let bed = bed((Space::Planar, container), gravity, &grains, laws(), 0);
            let mut world = World::new(bed, Box::new(engine::body::NoIntruder), DT);
            let seen = check(&mut world, 4_000);
            assert!(seen > 1_000, "{seen} contacts are few");
        })
        .expect("one thread");
    }
}

#[test]
fn the_pairs_that_touch_in_space_are_those_of_all_pairs_at_a_size_ratio_of_twenty() {
    let mut rng = random(1, "spheres");
    let mut grains: Vec<Grain> = Vec::new();
    for (count, radius) in KINDS {
        let mut left = count;
        while left > 0 {
            let mut number = || 2.0 * rng.random::<f64>() - 1.0;
            let place = Vec3::new(number(), number(), number()) * (3.0 * LARGEST);
            let position = MIDDLE + Vec3::y() * 0.5 + place;
            let velocity = place * -100.0 + Vec3::new(number(), number(), number()) * 0.3;
            let free = grains
                .iter()
                .all(|other| (other.position - position).norm() > other.radius + radius);
            if free {
                grains.push(size(radius).grain(position, velocity));
                left -= 1;
            }
        }
    }
    with_threads(1, || {
        let bed = bed((Space::Spatial, ROOM), Vec3::zeros(), &grains, laws(), 0);
        let mut world = World::new(bed, Box::new(engine::body::NoIntruder), DT);
        let seen = check(&mut world, 5_000);
        assert!(seen > 1_000, "{seen} contacts are few");
    })
    .expect("one thread");
}

#[test]
fn the_grains_that_touch_an_intruder_are_those_within_its_reach() {
    with_threads(1, || {
        let seen = check(&mut Cloud::random(60, 4).world(), 6_000);
        assert!(seen > 1_000, "{seen} contacts are few");
    })
    .expect("one thread");
}
