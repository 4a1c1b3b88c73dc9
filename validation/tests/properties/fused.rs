//! A law that acts alone has a loop of its own, from grains to loads; next to others it goes through
//! batches. One that does nothing beside it must change no bit.

use engine::bed::{GrainKind, fill, random};
use engine::body::NoIntruder;
use engine::boundary::Container;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::stage::ContactStage;
use engine::world::World;
use rand::RngExt;
use validation::rig::{LARGE, S1, SMALL, bed, rolling, run};

/// 1 200 grains that fly into each other, so that contacts open and close everywhere.
fn shaken(space: Space, stages: Vec<Box<dyn ContactStage>>) -> World {
    let (container, flat) = match space {
        Space::Planar => (Container::walled_box(0.2, 0.0), 0.0),
        Space::Spatial => (Container::walled_box(0.05, 0.05), 1.0),
    };
    let kinds = [(SMALL, 1_000), (LARGE, 200)].map(|(size, count)| GrainKind {
        count,
        radius: size.radius,
        mass: size.mass,
    });
    let mut rng = random(1, "velocities");
    let mut number = || 4.0 * rng.random::<f64>() - 2.0;
    let grains: Vec<Grain> = fill(&kinds, (space, &container), 1)
        .into_iter()
        .map(|grain| Grain { velocity: Vec3::new(number(), flat * number(), number()), ..grain })
        .collect();
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    World::new(bed((space, container), gravity, &grains, stages, 0), Box::new(NoIntruder), 1e-5)
}

#[test]
fn a_law_alone_moves_grains_as_it_does_beside_one_that_does_nothing() {
    for space in [Space::Planar, Space::Spatial] {
        let mut alone = shaken(space, vec![S1.stage()]);
        let mut beside = shaken(space, vec![S1.stage(), rolling(0.0, 0.0)]);
        run(&mut alone, 400);
        run(&mut beside, 400);
        assert!(alone.bed().coordination() > 0.2, "{space:?}: {}", alone.bed().coordination());
        let states = |world: &World| world.bed().grains.iter().collect::<Vec<_>>();
        assert!(states(&alone) == states(&beside), "{space:?}: other bits");
    }
}
