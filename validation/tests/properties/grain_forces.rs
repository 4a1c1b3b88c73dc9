//! Forces on single grains do what their formulas say, and their energy is accounted for.

use engine::body::NoIntruder;
use engine::boundary::Container;
use engine::grain_force::GrainForce;
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::world::World;
use validation::rig::{MIDDLE, ROOM, S1, SMALL, bed, run};

use crate::closure::discs_in_flight;

fn force(name: &str, (key, value): (&'static str, f64)) -> Box<dyn GrainForce> {
    let mut params = ParamTable::new();
    params.set(key, value);
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
