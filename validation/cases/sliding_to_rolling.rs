//! A disc and a sphere launched along the floor without spin: they slide, then roll.
//!
//! With I = q m R² and the friction μ m g at a lever h, slip ends after v₀ / (μ g (1 + h²/qR²)): v₀/3μg
//! for a disc (q = ½), 2v₀/7μg for a sphere (q = ⅖). What then remains of the speed is
//! 1/(1 + qR²/h²): 2/3 and 5/7. The contact point lies in the middle of the overlap, so h = R − δ/2.

use engine::grains::Space;
use engine::math::Vec3;
use engine::world::World;

use crate::case::{Case, Outcome};
use crate::rig::{S1, SMALL, on_floor, run, run_while};

pub(crate) const CASE: Case = Case {
    name: "sliding-to-rolling",
    claim: "A disc launched along the floor slides for v₀/(3 μ g) and rolls on with 2/3 of its \
            speed; a sphere, or a disc with its moment of inertia, for 2 v₀/(7 μ g) and with 5/7.",
    run: launches,
};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1e-5;
const SPEED: f64 = 0.3;
/// Twenty times what it takes.
const MOST_STEPS: usize = 100_000;

fn launches() -> Vec<Outcome> {
    let kinds = [
        ("disc", Space::Planar, 0.5),
        ("sphere", Space::Spatial, 0.4),
        ("disc that turns as a sphere", Space::Planar, 0.4),
    ];
    kinds.into_iter().flat_map(|(name, space, inertia)| launch(name, (space, inertia))).collect()
}

fn launch(name: &str, (space, inertia): (Space, f64)) -> [Outcome; 2] {
    let gravity = -Vec3::z() * GRAVITY;
    let start = (Vec3::x() * SPEED, Vec3::zeros());
    let laws = (vec![S1.stage()], S1.normal_stiffness);
    let mut world = on_floor((space, inertia), SMALL, start, gravity, laws, DT);
    let lever = SMALL.radius - 0.5 * SMALL.mass * GRAVITY / S1.normal_stiffness;
    let slip = |world: &World| {
        let grains = &world.bed().grains;
        grains.velocity(0).x - lever * grains.spin(0).y
    };
    let (mut before, mut now) = (SPEED, SPEED);
    run_while(&mut world, MOST_STEPS, |world| {
        (before, now) = (now, slip(world));
        now > 0.0
    });
    let time = world.clock().time() - DT * now / (now - before);
    // Long enough for the tangential spring to come to rest.
    run(&mut world, 1_000);
    let speed = world.bed().grains.velocity(0).x;

    let rolling = (lever / SMALL.radius).powi(2) / inertia;
    let exact = SPEED / (S1.friction * GRAVITY * (1.0 + rolling));
    [
        Outcome::near(
            format!("{name}: time of sliding (s)"),
            time,
            (exact, DT),
            "slip falls off linearly and is found between steps; in the last one the spring \
             unloads, so one step",
        ),
        Outcome::near(
            format!("{name}: speed of rolling over that of the launch (–)"),
            speed / SPEED,
            (rolling / (1.0 + rolling), 1e-12),
            "friction cannot change the angular momentum about the contact: only round-off of \
             some 10⁴ steps can",
        ),
    ]
}
