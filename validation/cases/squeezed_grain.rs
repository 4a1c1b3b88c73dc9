//! A small grain between the floor and a large, free disc that rolls off it.
//!
//! Both contacts turn while they roll, the one with the disc about a point far away where the disc is
//! large. What a step of the contact's own length makes of that may not hang on the step.

use engine::grains::Space;
use engine::math::Vec3;
use engine::world::World;

use crate::case::{Case, Outcome};
use crate::rig::{ROOM, S1, SMALL, Size, bed, run};

pub(crate) const CASE: Case = Case {
    name: "squeezed-grain",
    claim: "How a large disc rolls off a small grain does not depend on the step, at any ratio of \
            sizes.",
    run: ratios,
};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1e-5;
/// Tangent of the angle from the vertical at which the disc leans.
const LEAN: f64 = 0.2;

fn ratios() -> Vec<Outcome> {
    [1.0, 3.0, 10.0, 100.0].into_iter().flat_map(ratio).collect()
}

fn ratio(ratio: f64) -> [Outcome; 2] {
    let [grain, disc] = ways(ratio, DT);
    let [grain_fine, disc_fine] = ways(ratio, 0.25 * DT);
    let why = "1 % is what an integration may cost, held against a quarter of the step";
    [
        Outcome::near(
            format!("ratio {ratio}: way of the grain at 10 µs (m)"),
            grain,
            (grain_fine, 0.01 * grain_fine.abs()),
            why,
        ),
        Outcome::near(
            format!("ratio {ratio}: way of the disc at 10 µs (m)"),
            disc,
            (disc_fine, 0.01 * disc_fine.abs()),
            why,
        ),
    ]
}

/// How far (m) the grain and the disc have gone when the disc has had time to fall by about its size.
fn ways(ratio: f64, dt: f64) -> [f64; 2] {
    let large = Size { radius: ratio * SMALL.radius, mass: 20.0 * SMALL.mass };
    let reach = SMALL.radius + large.radius;
    let sunk = large.mass * GRAVITY / S1.normal_stiffness;
    let grain = Vec3::new(0.5, 0.0, SMALL.radius - sunk);
    let lean = Vec3::new(LEAN, 0.0, 1.0).normalize();
    let disc = grain + lean * (reach - sunk);

    let gravity = -Vec3::z() * GRAVITY;
    let grains = [SMALL.grain(grain, Vec3::zeros())];
    let bed = bed((Space::Planar, ROOM), gravity, &grains, vec![S1.stage()], 1);
    let intruder = large.disc(disc, Vec3::zeros(), Vec3::zeros());
    let mut world = World::new(bed, Box::new(intruder), dt);
    let steps = (2.5 * (reach / GRAVITY).sqrt() / DT).round() * (DT / dt).round();
    run(&mut world, steps as usize);
    [world.bed().grains.position(0).x - grain.x, world.intruder().bodies()[0].position.x - disc.x]
}
