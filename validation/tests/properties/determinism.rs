//! The same bits on any number of threads, and after any restart.

use engine::bed::{GrainKind, fill, random};
use engine::boundary::Container;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::parallel::with_threads;
use engine::simulation::{Settings, Simulation, Snapshot};
use rand::RngExt;
use validation::rig::{DISC, LARGE, SMALL, bed};

use crate::cloud::laws;

/// `n` grains in lively motion, so that contacts open and close everywhere, and a disc shot into them.
fn impact(n: usize, width: f64) -> Simulation {
    let container = Container::walled_box(width, 0.0);
    let n_large = n / 6;
    let kinds = [(SMALL, n - n_large), (LARGE, n_large)].map(|(size, count)| GrainKind {
        count,
        radius: size.radius,
        mass: size.mass,
    });
    let mut rng = random(1, "velocities");
    let mut number = || 4.0 * rng.random::<f64>() - 2.0;
    let grains: Vec<Grain> = fill(&kinds, (Space::Planar, &container), 1)
        .into_iter()
        .map(|grain| Grain { velocity: Vec3::new(number(), 0.0, number()), ..grain })
        .collect();
    let top = grains.iter().fold(0.0_f64, |top, grain| top.max(grain.position.z + grain.radius));
    let disc = DISC.disc(
        Vec3::new(0.5 * width, 0.0, top + DISC.radius),
        Vec3::new(1.0, 0.0, -5.0),
        Vec3::y() * 20.0,
    );
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let bed = bed((Space::Planar, container), gravity, &grains, laws(), 1);
    Simulation::new(bed, Box::new(disc), Settings { dt: 1e-5, duration: 1.0, abort_above: 1.0 })
}

fn bytes(snapshot: &Snapshot) -> Vec<u8> {
    postcard::to_stdvec(snapshot).expect("a snapshot can be written")
}

fn advance_to(simulation: &mut Simulation, step: u64) {
    while simulation.clock().step < step {
        simulation.advance().expect("a sound step");
    }
}

#[test]
fn the_same_run_on_1_2_3_and_8_threads_is_bit_identical() {
    let run_on = |threads: usize| {
        with_threads(threads, || {
            let mut simulation = impact(2_000, 0.25);
            advance_to(&mut simulation, 400);
            assert!(
                simulation.bed().coordination() > 0.2 && simulation.bed().grains.len() == 2_000
            );
            assert!(simulation.intruder().bodies()[0].contact.contacts > 0);
            bytes(&simulation.save())
        })
        .expect("as many threads as asked for")
    };
    let alone = run_on(1);
    for threads in [2, 3, 8] {
        assert!(run_on(threads) == alone, "{threads} threads make other bits than one");
    }
}

#[test]
fn restart_from_a_checkpoint_continues_bit_identically_on_several_blocks_of_grains() {
    with_threads(1, || {
        let mut whole = impact(1_500, 0.2);
        let mut saved = Vec::new();
        for step in 0..200 {
            if step % 10 == 0 {
                saved.push(bytes(&whole.save()));
            }
            advance_to(&mut whole, step + 1);
        }
        let end = bytes(&whole.save());
        assert_eq!(saved.len(), 20);
        for state in &saved {
            let state: Snapshot = postcard::from_bytes(state).expect("a snapshot can be read");
            let from = state.step();
            let mut resumed = impact(1_500, 0.2);
            assert!(resumed.restore(state), "step {from} does not fit");
            advance_to(&mut resumed, 200);
            assert!(bytes(&resumed.save()) == end, "from step {from} the run ends otherwise");
        }
    })
    .expect("one thread");
}
