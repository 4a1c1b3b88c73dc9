//! The energy ledger of whole beds.

use std::sync::OnceLock;

use engine::bed::{GrainKind, Settling, fill, random};
use engine::body::NoIntruder;
use engine::boundary::Container;
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::parallel::with_threads;
use engine::simulation::{Settings, Simulation};
use engine::world::World;
use rand::RngExt;
use validation::rig::{LARGE, Linear, S1, SMALL, Size, bed, run};

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);
const BOX: Container = Container::walled_box(0.25, 0.0);

/// 2 000 grains in the proportion of Wang, Ye & Zheng (2012), fallen into a box. They still rattle a
/// little: an impact has ten thousand times the energy.
fn resting_bed() -> &'static RestingBed {
    static BED: OnceLock<RestingBed> = OnceLock::new();
    BED.get_or_init(|| {
        let kinds = [(SMALL, 1_680), (LARGE, 320)].map(|(size, count)| GrainKind {
            count,
            radius: size.radius,
            mass: size.mass,
        });
        let grains = fill(&kinds, (Space::Planar, &BOX), 1);
        let mut settling =
            Settling::new(&grains, (Space::Planar, BOX), GRAVITY, vec![S1.stage()], 1e-5);
        while settling.clock().step < 1_000 || settling.restlessness() > 100.0 {
            settling.advance().expect("a sound step");
            assert!(settling.clock().time() < 5.0, "no rest: {}", settling.restlessness());
        }
        settling.bed().resting()
    })
}

/// Closure after 50 ms of an impact at `speed` (m/s).
fn closure(speed: f64, dt: f64) -> f64 {
    let resting = resting_bed();
    let bed = GrainBed::new(resting, BOX, GRAVITY, vec![S1.stage()], 1);
    let disc = Size { radius: 0.015, mass: 0.0146 };
    let top = resting.grains.iter().filter(|grain| (grain.position.x - 0.125).abs() < disc.radius);
    let top = top.fold(0.0_f64, |top, grain| top.max(grain.position.z + grain.radius));
    let start = Vec3::new(0.125, 0.0, top + disc.radius);
    let disc = disc.disc(start, Vec3::z() * -speed, Vec3::zeros());
    let settings = Settings { dt, duration: 0.05, abort_above: 0.05 };
    let mut simulation = Simulation::new(bed, Box::new(disc), settings);
    while !simulation.is_over() {
        simulation.advance().expect("a sound step");
    }
    simulation.closure()
}

#[test]
fn an_impact_on_two_thousand_grains_accounts_for_its_energy_to_second_order() {
    let at_10_us = [1.0, 2.0, 3.0].map(|speed| closure(speed, 1e-5));
    for (closure, speed) in at_10_us.iter().zip([1, 2, 3]) {
        // 6e-4, 4e-4 and 3e-4 in an independent study of 3 000 grains.
        assert!(*closure <= 1e-3, "{speed} m/s: {closure:e}");
    }
    let at_5_us = closure(2.0, 5e-6);
    // Second order divides by four.
    assert!(at_10_us[1] / at_5_us >= 3.5, "{:e} against {at_5_us:e}", at_10_us[1]);
}

/// 200 discs of two sizes anywhere in `room`, with up to 1 m/s along each axis.
pub(super) fn discs_in_flight(room: &Container) -> Vec<Grain> {
    let kinds = [(SMALL, 160), (LARGE, 40)].map(|(size, count)| GrainKind {
        count,
        radius: size.radius,
        mass: size.mass,
    });
    let mut rng = random(1, "velocities");
    let mut number = || 2.0 * rng.random::<f64>() - 1.0;
    fill(&kinds, (Space::Planar, room), 1)
        .into_iter()
        .map(|grain| Grain { velocity: Vec3::new(number(), 0.0, number()), ..grain })
        .collect()
}

#[test]
fn without_dissipation_the_energy_of_a_box_of_grains_does_not_drift() {
    const DT: f64 = 1.5e-6;
    let law =
        Linear { normal_damping_rate: 0.0, tangential_damping_rate: 0.0, friction: 0.0, ..S1 };
    let room = Container::walled_box(0.15, 0.0);
    let grains = discs_in_flight(&room);
    let series: Vec<f64> = with_threads(1, || {
        let bed = bed((Space::Planar, room), GRAVITY, &grains, vec![law.stage()], 0);
        let mut world = World::new(bed, Box::new(NoIntruder), DT);
        let start = world.bed().kinetic_energy();
        let sample = |_| {
            run(&mut world, 100);
            world.ledger().balance().unaccounted / start
        };
        (0..1_000).map(sample).collect()
    })
    .expect("one thread");
    let worst = series.iter().fold(0.0_f64, |worst, value| worst.max(value.abs()));
    let trend = slope(&series) * series.len() as f64;
    // A spring touched in mid-step errs by up to (ω₀ dt/2)² = 7e-5 of the energy of the two, either
    // way: some thousand collisions of two among two hundred add up to a hundredth of that.
    assert!(worst <= 1e-4, "{worst:e}");
    assert!(trend.abs() <= 1e-5, "{trend:e}");
}

/// Of the straight line through values one apart, by least squares.
fn slope(series: &[f64]) -> f64 {
    let n = series.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let moment: f64 = series.iter().zip(0..).map(|(y, k)| y * (f64::from(k) - middle)).sum();
    moment * 12.0 / (n * (n * n - 1.0))
}
