//! The same experiment seen by another observer.

use engine::bed::{GrainKind, fill};
use engine::boundary::Container;
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::parallel::with_threads;
use engine::world::World;
use validation::rig::{LARGE, Linear, MIDDLE, S1, SMALL, Size, rolling, run};

use crate::cloud::{Cloud, Collisions, DIAMETER, apart, positions};

/// Runs two clouds side by side until the first has seen `collisions`; `back` gives the positions of
/// the second as the first observer sees them. Returns their largest distance (m).
fn compare(
    first: &Cloud,
    second: &Cloud,
    collisions: usize,
    back: impl Fn(&World) -> Vec<Vec3> + Sync,
) -> f64 {
    with_threads(1, || {
        let (mut first, mut second) = (first.world(), second.world());
        let mut seen = Collisions::default();
        while seen.count < collisions {
            run(&mut first, 1);
            run(&mut second, 1);
            seen.watch(&first);
            assert!(first.clock().step < 20_000, "only {} collisions", seen.count);
        }
        apart(&positions(&first), &back(&second))
    })
    .expect("one thread")
}

#[test]
fn a_uniform_velocity_changes_no_relative_trajectory() {
    let boost = Vec3::new(0.5, 0.0, 0.3);
    for seed in [1, 2, 3] {
        let cloud = Cloud::random(60, seed);
        let moving = cloud.seen(
            |grain| Grain { velocity: grain.velocity + boost, ..grain },
            |position, velocity, spin| (position, velocity + boost, spin),
        );
        let distance = compare(&cloud, &moving, 50, |world| {
            let shift = boost * world.clock().time();
            positions(world).into_iter().map(|position| position - shift).collect()
        });
        // Positions are rounded to 1e-17 m in each of some thousand steps, and each collision makes
        // a deviation some ten times as large.
        assert!(distance <= 1e-9 * DIAMETER, "seed {seed}: {distance:e} m");
    }
}

#[test]
fn a_mirror_changes_nothing_but_sides() {
    let mirrored = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
    let place = |v: Vec3| Vec3::new(2.0 * MIDDLE.x - v.x, v.y, v.z);
    for seed in [1, 2, 3] {
        let cloud = Cloud::random(60, seed);
        let other = cloud.seen(
            |grain| Grain {
                position: place(grain.position),
                velocity: mirrored(grain.velocity),
                // A spin is an axial vector.
                spin: -mirrored(grain.spin),
                ..grain
            },
            |position, velocity, spin| (place(position), mirrored(velocity), -mirrored(spin)),
        );
        let distance =
            compare(&cloud, &other, 50, |world| positions(world).into_iter().map(place).collect());
        // As with a uniform velocity, and the sums over contacts in another order.
        assert!(distance <= 1e-9 * DIAMETER, "seed {seed}: {distance:e} m");
    }
}

/// Units, as powers of two of the metre, the second and the kilogram.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

const SI: Units = Units { length: 1.0, time: 1.0, mass: 1.0 };

const BOX: Container = Container::walled_box(0.05, 0.0);

/// Grains that are about to fall into a small heap, told in SI units.
fn heap() -> Vec<Grain> {
    let kinds = [(SMALL, 30), (LARGE, 10)].map(|(size, count)| GrainKind {
        count,
        radius: size.radius,
        mass: size.mass,
    });
    fill(&kinds, (Space::Planar, &BOX), 4)
}

/// Where `grains` and a disc that falls among them are after `steps` of 10 µs, computed in `units`
/// and read in metres, in the order of their numbers.
fn impact(grains: &[Grain], units: Units, steps: usize) -> Vec<Vec3> {
    let Units { length, time, mass } = units;
    let (velocity, stiffness, rate) = (length / time, mass / (time * time), 1.0 / time);
    let grains: Vec<Grain> = grains
        .iter()
        .map(|&grain| Grain {
            position: grain.position * length,
            radius: grain.radius * length,
            mass: grain.mass * mass,
            ..grain
        })
        .collect();
    let law = Linear {
        normal_stiffness: S1.normal_stiffness * stiffness,
        tangential_stiffness: S1.tangential_stiffness * stiffness,
        normal_damping_rate: S1.normal_damping_rate * rate,
        tangential_damping_rate: S1.tangential_damping_rate * rate,
        friction: S1.friction,
    };
    let resting = RestingBed::without_history(Space::Planar, grains);
    let room = Container::walled_box(BOX.extents()[0] * length, 0.0);
    let gravity = Vec3::new(0.0, 0.0, -9.81 * velocity / time);
    let bed = GrainBed::new(&resting, room, gravity, vec![law.stage(), rolling(0.1, 0.3)], 1);
    let size = Size { radius: 0.01 * length, mass: 5e-3 * mass };
    let grains = resting.grains.iter();
    let top = grains.fold(0.0_f64, |top, grain| top.max(grain.position.z + grain.radius));
    let start = Vec3::new(0.021 * length, 0.0, top + size.radius);
    let thrown = Vec3::new(0.2, 0.0, -1.0) * velocity;
    let disc = size.disc(start, thrown, Vec3::y() * (10.0 * rate));
    let mut world = World::new(bed, Box::new(disc), 1e-5 * time);
    run(&mut world, steps);
    positions(&world).into_iter().map(|position| position / length).collect()
}

#[test]
fn the_units_mean_nothing() {
    let in_si = impact(&heap(), SI, 6_000);
    let in_others = impact(&heap(), Units { length: 4.0, time: 2.0, mass: 8.0 }, 6_000);
    // Powers of two scale without rounding, and no number of the engine has a hidden unit.
    assert_eq!(in_si, in_others);
}

#[test]
fn the_order_of_the_list_of_grains_changes_no_bit() {
    let grains = heap();
    let mut shuffled = grains.clone();
    shuffled.rotate_left(17);
    shuffled.reverse();
    assert_eq!(impact(&grains, SI, 6_000), impact(&shuffled, SI, 6_000));
}

#[test]
fn the_numbers_of_the_grains_mean_nothing() {
    let grains = heap();
    let n = grains.len();
    // 7 and 40 have no common factor, so this is a permutation.
    let new = |old: usize| old * 7 % n;
    let renumbered: Vec<Grain> =
        grains.iter().map(|&grain| Grain { id: new(grain.id as usize) as u32, ..grain }).collect();
    // The disc is in the heap after 2 500 steps. The order of a sum first matters after 4 400; collisions
    // make a hundred times more of a bit within 2 000.
    let steps = 5_000;
    let (first, other) = (impact(&grains, SI, steps), impact(&renumbered, SI, steps));
    let mut back = other.clone();
    for old in 0..n {
        back[old] = other[new(old)];
    }
    let distance = apart(&first, &back);
    // Sums over the contacts of a grain and of the disc go in another order: a few bits of forces,
    // before collisions make much of them.
    assert!(distance <= 1e-12 * 2.0 * SMALL.radius, "{distance:e} m");
    assert!(distance > 0.0, "the order of the sums is still the same");
}
