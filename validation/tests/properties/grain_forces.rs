//! Forces on single grains do what their formulas say, and their energy is accounted for.

use std::f64::consts::PI;
use std::sync::Arc;

use engine::body::{NoIntruder, RigidBody};
use engine::boundary::Container;
use engine::grain_force::GrainForce;
use engine::grains::Space;
use engine::math::{Quat, Vec3};
use engine::params::ParamTable;
use engine::world::World;
use validation::rig::{MIDDLE, ROOM, S1, SMALL, Size, bed, run};

use crate::closure::discs_in_flight;

fn force(name: &str, value: (&'static str, f64)) -> Box<dyn GrainForce> {
    force_of(name, &[value])
}

fn force_of(name: &str, values: &[(&'static str, f64)]) -> Box<dyn GrainForce> {
    let params: ParamTable = values.iter().copied().collect();
    (contact_laws::find_grain_force(name).expect("the force is registered").build)(&params)
}

/// One small grain that starts in the middle of a room with `velocity` (m/s), under one force.
fn alone(velocity: Vec3, gravity: Vec3, force: Box<dyn GrainForce>, dt: f64) -> World {
    let bed = bed((Space::Planar, ROOM), gravity, &[SMALL.grain(MIDDLE, velocity)], Vec::new(), 0);
    World::new(bed.with_forces([force]), Box::new(NoIntruder), dt)
}

#[test]
fn a_grain_falls_through_the_air_as_its_closed_form_says_and_ends_at_its_terminal_velocity() {
    const RATE: f64 = 500.0;
    const DT: f64 = 1e-5;
    let air = force("pore-air", ("drag_rate", RATE));
    let mut world = alone(Vec3::zeros(), Vec3::new(0.0, 0.0, -9.81), air, DT);
    let speed = |world: &World| -world.bed().grains.velocity(0).z;
    // v = g/γ (1 − exp(−γ t)), here at t = 1/γ; the scheme is of second order, (γ dt)²/6 is 4e-6.
    run(&mut world, 200);
    let expected = 9.81 / RATE * (1.0 - libm::exp(-1.0));
    assert!((speed(&world) / expected - 1.0).abs() < 1e-5, "{}", speed(&world));
    // At t = 41/γ, exp(−41) is a rounding error, and drag and weight cancel whatever the step is.
    run(&mut world, 8_000);
    assert!((speed(&world) * RATE / 9.81 - 1.0).abs() < 1e-12, "{}", speed(&world));
    // The ledger is of second order too: (γ dt)² of what the air took.
    let taken = world.ledger().value("dissipated_pore_air_J").expect("the air has an account");
    let unaccounted = world.ledger().balance().worst;
    assert!(taken > 0.0 && unaccounted < (RATE * DT) * (RATE * DT) * taken, "{unaccounted:e}");
}

#[test]
fn a_disc_on_a_plate_stops_after_the_way_of_its_closed_form() {
    const FRICTION: f64 = 0.5;
    const CREEP: f64 = 1e-3;
    let start: f64 = 0.3;
    let plate = force("side-wall", ("plate_friction", FRICTION));
    // The plate lies: all of the weight presses on it, and the disc slides on a level.
    let mut world = alone(Vec3::x() * start, Vec3::new(0.0, -9.81, 0.0), plate, 1e-5);
    run(&mut world, 20_000);
    let grains = &world.bed().grains;
    // From v dv/dx = −μ g v/√(v² + v_c²), with ∫√(v² + v_c²) dv in closed form.
    let reach = (start * start + CREEP * CREEP).sqrt();
    let integral = 0.5 * (start * reach + CREEP * CREEP * libm::asinh(start / CREEP));
    let way = grains.position(0).x - MIDDLE.x;
    // Where it creeps, the last 4e-5 of the way, a step is a twentieth of the relaxation: 1/400 of that.
    assert!((way * FRICTION * 9.81 / integral - 1.0).abs() < 1e-7, "{way}");
    // It creeps to rest with the rate μ g/v_c, five hundred times over.
    assert!(grains.velocity(0).norm() < 1e-100, "{}", grains.velocity(0));
}

/// What is unaccounted for, at worst, and what each of `forces` took, over the energy at the start, of 200
/// discs that collide in a box for 20 ms.
fn colliding(forces: Vec<Box<dyn GrainForce>>) -> (f64, Vec<f64>) {
    let accounts = forces.iter().map(|force| force.name().replace('-', "_"));
    let accounts: Vec<String> = accounts.map(|name| format!("dissipated_{name}_J")).collect();
    let room = Container::walled_box(0.12, 0.0);
    let grains = discs_in_flight(&room);
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let bed = bed((Space::Planar, room), gravity, &grains, vec![S1.stage()], 0);
    let mut world = World::new(bed.with_forces(forces), Box::new(NoIntruder), 1e-5);
    let start = world.bed().kinetic_energy();
    run(&mut world, 2_000);
    let ledger = world.ledger();
    let taken = |key: &String| ledger.value(key).expect("the force has an account") / start;
    (ledger.closure(start), accounts.iter().map(taken).collect())
}

#[test]
fn what_forces_on_grains_take_is_accounted_for_among_collisions() {
    let (without, none) = colliding(Vec::new());
    assert!(none.is_empty());
    let (closure, taken) = colliding(vec![
        force("pore-air", ("drag_rate", 20.0)),
        force("side-wall", ("plate_friction", 0.3)),
    ]);
    // Collisions that begin within a step are what does not add up. The forces add 4e-8, (γ dt)², but the
    // collisions are others then: they err by as much, give or take as much again.
    assert!(closure < 2.0 * without, "{closure:e} against {without:e}");
    // Each takes so much that the ledger would not close without it.
    assert!(taken.iter().all(|&share| share > 10.0 * closure), "{taken:?}");
}

const WATER: f64 = 998.0;

fn water() -> Box<dyn GrainForce> {
    force_of("fluid", &[("density", WATER), ("viscosity", 1e-3), ("hindrance", 1.0)])
}

/// Speed (m/s) at which the drag of water on a sphere balances what its weight and buoyancy leave, from
/// (0.63 √v + c)² v = (4/3) |ρ/ρ_f − 1| g d, a square in √v.
fn terminal_speed(density: f64, radius: f64) -> f64 {
    let diameter = 2.0 * radius;
    let viscous = 4.8 * (1e-3 / (WATER * diameter)).sqrt();
    let drive = (4.0 / 3.0 * (density / WATER - 1.0).abs() * 9.81 * diameter).sqrt();
    let root = ((viscous * viscous + 4.0 * 0.63 * drive).sqrt() - viscous) / (2.0 * 0.63);
    root * root
}

fn sphere_mass(density: f64, radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius * density
}

#[test]
fn a_bead_sinks_in_water_from_its_reduced_acceleration_to_its_terminal_velocity() {
    const DT: f64 = 1e-4;
    let (radius, density) = (1e-3, 2500.0);
    let high = Vec3::new(0.4, 0.4, 0.9);
    let bead = Size { radius, mass: sphere_mass(density, radius) }.grain(high, Vec3::zeros());
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let bed = bed((Space::Spatial, ROOM), gravity, &[bead], Vec::new(), 0);
    let mut world = World::new(bed.with_forces([water()]), Box::new(NoIntruder), DT);
    run(&mut world, 1);
    let first = -world.bed().grains.velocity(0).z / DT;
    let reduced = 9.81 * (density - WATER) / (density + 0.5 * WATER);
    // Drag has taken a part of the order of the step over the relaxation time, 1/300.
    assert!((first / reduced - 1.0).abs() < 0.01, "{first} against {reduced}");
    run(&mut world, 10_000);
    let speed = -world.bed().grains.velocity(0).z;
    let terminal = terminal_speed(density, radius);
    assert!((speed / terminal - 1.0).abs() < 1e-9, "{speed} against {terminal}");
    let taken = world.ledger().value("dissipated_fluid_J").expect("the fluid has an account");
    let unaccounted = world.ledger().balance().worst;
    assert!(taken > 0.0 && unaccounted < 1e-4 * taken, "{unaccounted:e} of {taken:e}");
}

#[test]
fn an_intruder_that_is_lighter_than_water_rises_to_its_terminal_velocity() {
    const DT: f64 = 1e-4;
    let (radius, density) = (5e-3, 250.0);
    let params = ParamTable::from_iter([("diameter", 2.0 * radius)]);
    let shape = intruders::find("sphere").expect("the sphere is registered");
    let body = (shape.build)(&params, Space::Spatial);
    let mass = sphere_mass(density, radius);
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let far = SMALL.grain(Vec3::new(0.9, 0.9, 0.05), Vec3::zeros());
    let bed = bed((Space::Spatial, ROOM), gravity, &[far], Vec::new(), 1).with_forces([water()]);
    let inertia = body.inertia_per_mass * mass;
    let mut ball = RigidBody::new("ball", Arc::clone(&body.surface), mass, inertia);
    ball.volume = (shape.volume)(&params, Space::Spatial);
    ball.added_mass = bed.fluid_around(ball.volume).added_mass;
    ball.launch(Vec3::new(0.4, 0.4, 0.2), Quat::identity(), Vec3::zeros(), Vec3::zeros());
    let mut world = World::new(bed, Box::new(ball), DT);
    let rise = |world: &World| world.intruder().bodies()[0].velocity.z;
    run(&mut world, 1);
    let reduced = 9.81 * (WATER - density) / (density + 0.5 * WATER);
    assert!((rise(&world) / DT / reduced - 1.0).abs() < 0.01, "{}", rise(&world) / DT);
    run(&mut world, 10_000);
    let terminal = terminal_speed(density, radius);
    assert!((rise(&world) / terminal - 1.0).abs() < 1e-9, "{} {terminal}", rise(&world));
    let taken = world.ledger().value("dissipated_fluid_J").expect("the fluid has an account");
    let unaccounted = world.ledger().balance().worst;
    assert!(taken > 0.0 && unaccounted < 1e-4 * taken, "{unaccounted:e} of {taken:e}");
}
