//! One or two grains under a law: what no law may break, and what is known of them.

use engine::body::NoIntruder;
use engine::boundary::{Container, Sides};
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::stage::ContactStage;
use engine::world::World;

const RADIUS: f64 = 2e-3;
const MASS: f64 = 5e-5;
const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1000.0;

fn law(name: &str, values: &[(&'static str, f64)]) -> Box<dyn ContactStage> {
    let params: ParamTable = values.iter().copied().collect();
    (contact_laws::find(name).expect("it is registered").build)(&params)
}

/// Springs and dashpots with this friction.
fn linear(friction: f64) -> Box<dyn ContactStage> {
    let values = [
        ("normal_stiffness", STIFFNESS),
        ("tangential_stiffness", STIFFNESS),
        ("normal_damping_rate", 500.0),
        ("tangential_damping_rate", 300.0),
        ("friction", friction),
        ("wall_friction", friction),
        ("intruder_friction", friction),
    ];
    law("linear-spring-dashpot", &values)
}

fn rolling() -> Box<dyn ContactStage> {
    law("rolling-resistance", &[("rolling_friction", 0.1), ("rolling_damping_ratio", 0.3)])
}

fn world(
    (space, container): (Space, Container),
    gravity: f64,
    grains: Vec<Grain>,
    laws: Vec<Box<dyn ContactStage>>,
    dt: f64,
) -> World {
    let resting = RestingBed::without_history(space, grains);
    let bed = GrainBed::new(&resting, container, Vec3::z() * -gravity, laws, 0);
    World::new(bed, Box::new(NoIntruder), dt)
}

fn run(world: &mut World, steps: usize) {
    for _ in 0..steps {
        world.advance().expect("a sound step");
    }
}

fn momenta(world: &World, space: Space) -> (Vec3, Vec3) {
    world.bed().grains.iter().fold((Vec3::zeros(), Vec3::zeros()), |(linear, angular), grain| {
        let momentum = grain.velocity * grain.mass;
        let spin = grain.spin * space.grain_inertia(grain.mass, grain.radius);
        (linear + momentum, angular + grain.position.cross(&momentum) + spin)
    })
}

const ROOM: Container = Container::walled_box(0.1, 0.1);

#[test]
fn two_grains_that_meet_aslant_and_spinning_keep_momentum_and_angular_momentum_and_close_their_energy()
 {
    for space in [Space::Planar, Space::Spatial] {
        let y = if space == Space::Spatial { 1.0 } else { 0.0 };
        let grain = |x: f64, velocity: Vec3, spin: Vec3, (scale, id): (f64, u32)| Grain {
            position: Vec3::new(0.05 + x, 0.05 * y, 0.05),
            velocity,
            spin,
            radius: RADIUS * scale,
            mass: MASS * scale * scale,
            id,
        };
        let spin = Vec3::new(30.0 * y, 100.0, -20.0 * y);
        let first = grain(-0.0026, Vec3::new(0.5, 0.1 * y, 0.2), spin, (1.0, 0));
        let second = grain(0.0026, Vec3::new(-0.3, 0.0, 0.0), spin * -0.6, (1.5, 1));
        let laws = vec![linear(0.4), rolling()];
        let mut world = world((space, ROOM), 0.0, vec![first, second], laws, 2e-6);
        let (linear, angular) = momenta(&world, space);
        let energy = world.ledger().balance().initial;
        let mut touching = 0;
        for _ in 0..1_500 {
            run(&mut world, 1);
            touching += world.bed().touching_pairs().len();
        }
        assert!(touching > 100 && world.bed().touching_pairs().is_empty(), "{touching}");
        let (linear_after, angular_after) = momenta(&world, space);
        let (momentum, turned) = (MASS * 0.5, MASS * 0.5 * 0.05);
        // Round-off of 1500 steps; in space the spins of a step are turned to second order.
        assert!((linear_after - linear).norm() < 1e-12 * momentum);
        assert!((angular_after - angular).norm() < 1e-9 * turned, "{space:?}");
        let lost = world.ledger().value("dissipated_rolling_resistance_J").expect("a channel");
        assert!(lost.abs() > 1e-6 * energy, "{lost:e}");
        // (ω dt)² = 1e-4 of what the springs hold, of which nearly all comes back.
        assert!(world.ledger().closure(energy) < 1e-4, "{:e}", world.ledger().closure(energy));
    }
}

#[test]
fn a_launched_grain_slides_under_its_friction_and_then_rolls_with_what_its_inertia_leaves() {
    for (space, inertia) in [(Space::Planar, 0.5), (Space::Spatial, 0.4)] {
        let (speed, friction, dt) = (0.3, 0.3, 1e-5);
        let sunk = MASS * GRAVITY / STIFFNESS;
        let y = if space == Space::Spatial { 0.5 } else { 0.0 };
        let grain = Grain {
            position: Vec3::new(0.1, y, RADIUS - sunk),
            velocity: Vec3::x() * speed,
            spin: Vec3::zeros(),
            radius: RADIUS,
            mass: MASS,
            id: 0,
        };
        let container = Container::walled_box(1.0, 1.0);
        let mut world = world((space, container), GRAVITY, vec![grain], vec![linear(friction)], dt);
        let ends = speed / (friction * GRAVITY * (1.0 + 1.0 / inertia));
        let half_way = (0.5 * ends / dt) as usize;
        run(&mut world, half_way);
        let slowed = speed - friction * GRAVITY * world.clock().time();
        let velocity = world.bed().grains.velocity(0).x;
        // The spring winds up in a step or two.
        assert!((velocity - slowed).abs() < 3.0 * dt * friction * GRAVITY, "{velocity} {slowed}");
        run(&mut world, 3 * half_way);
        let velocity = world.bed().grains.velocity(0).x;
        // The contact lies half an overlap above the bottom: 1e-4 of the radius.
        let rolls = speed / (1.0 + inertia);
        assert!((velocity / rolls - 1.0).abs() < 5e-4, "{space:?} {velocity} {rolls}");
    }
}

#[test]
fn grains_meet_across_a_side_that_repeats() {
    for space in [Space::Planar, Space::Spatial] {
        let container = Container { sides: Sides::Periodic, ..ROOM };
        let y = if space == Space::Spatial { 0.05 } else { 0.0 };
        let grain = |x: f64, velocity: f64, id: u32| Grain {
            position: Vec3::new(x, y, 0.05),
            velocity: Vec3::x() * velocity,
            spin: Vec3::zeros(),
            radius: RADIUS,
            mass: MASS,
            id,
        };
        let grains = vec![grain(0.003, -0.5, 0), grain(0.097, 0.5, 1)];
        let mut world = world((space, container), 0.0, grains, vec![linear(0.3)], 5e-6);
        let mut touching = 0;
        for _ in 0..1_000 {
            run(&mut world, 1);
            touching += world.bed().touching_pairs().len();
        }
        assert!(touching > 50, "{touching}");
        let apart: f64 = world
            .bed()
            .grains
            .iter()
            .map(|grain| {
                let towards_middle = if grain.id == 0 { 1.0 } else { -1.0 };
                grain.velocity.x * towards_middle
            })
            .sum();
        assert!(apart > 0.3, "they rebound: {apart}");
    }
}
