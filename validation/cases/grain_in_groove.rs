//! A small sphere that rolls off the neck of two large ones that touch and are held in place.
//!
//! The three-particle case of Vyas et al., Comput. Phys. Commun. 310, 109524 (2025): schemes that take
//! the tangential spring from half-step velocities and the contact plane at the end of the step let the
//! small sphere stick above a ratio of sizes of about three.
//!
//! Its centre runs along a ring of radius ρ about the line of centres, ρ² = (R + r)² − R², and its
//! contacts lie r ρ/(R + r) from its axis of spin. Rolling without slip it is a pendulum upside
//! down, θ'' = g sin θ / (ρ (1 + κ)), with κ = ⅖ (R + r)²/ρ² the share of its spin in the inertia.

use std::f64::consts::PI;

use engine::grains::Space;
use engine::math::Vec3;
use engine::world::World;

use crate::case::{Case, Outcome};
use crate::fixed::FixedSpheres;
use crate::rig::{Linear, MIDDLE, ROOM, Size, bed, run};

pub(crate) const CASE: Case = Case {
    name: "grain-in-groove",
    claim: "A small sphere rolls off the neck between two large ones as an inverted pendulum, at \
            any ratio of sizes.",
    run: ratios,
};

const GRAVITY: f64 = 9.81;

/// Of the paper: 0.5 mm across and of glass.
const GRAIN: Size = Size { radius: 2.5e-4, mass: 1.636e-7 };

/// Of the paper; damping for a restitution of one half. A collision lasts 13 steps.
const LAW: Linear = Linear {
    normal_stiffness: 1e4,
    tangential_stiffness: 8235.0,
    normal_damping_rate: 1.065e5,
    tangential_damping_rate: 0.0,
    friction: 0.5,
};
const DT: f64 = 1e-6;

/// From 1° to 30° off the top: there friction still holds the roll at every ratio.
const FROM: f64 = 1.0 * PI / 180.0;
const TO: f64 = 30.0 * PI / 180.0;

fn ratios() -> Vec<Outcome> {
    [1.0, 3.0, 20.0, 100.0].into_iter().flat_map(ratio).collect()
}

fn ratio(ratio: f64) -> [Outcome; 2] {
    let large = ratio * GRAIN.radius;
    let reach = large + GRAIN.radius;
    let ring = (reach * reach - large * large).sqrt();
    let rate_2 = GRAVITY / (ring * (1.0 + 0.4 * (reach / ring).powi(2)));

    let centre = MIDDLE + Vec3::y() * 0.5;
    let boulders =
        FixedSpheres::new(large, &[centre - Vec3::x() * large, centre + Vec3::x() * large]);
    let (sin, cos) = libm::sincos(FROM);
    let grain = GRAIN.grain(centre + Vec3::new(0.0, sin, cos) * ring, Vec3::zeros());
    let gravity = -Vec3::z() * GRAVITY;
    let bed = bed((Space::Spatial, ROOM), gravity, &[grain], vec![LAW.stage()], 2);
    let mut world = World::new(bed, Box::new(boulders), DT);
    let (time, theory) = (pendulum_time(rate_2), pendulum_speed(rate_2, ring));
    // A grain that sticks is caught by a time three times too long.
    while angle(&world, centre) < TO && world.clock().time() < 3.0 * time {
        run(&mut world, 1);
    }
    let speed = world.bed().grains.velocity(0).norm();
    let why = "1 % is what an integration may cost; the springs give way by a millionth of the ring, \
               and a grain that sticks never arrives";
    [
        Outcome::near(
            format!("ratio {ratio}: time from 1° to 30° off the top (s)"),
            world.clock().time(),
            (time, 0.01 * time),
            why,
        ),
        Outcome::near(
            format!("ratio {ratio}: speed at 30° (m/s)"),
            speed,
            (theory, 0.01 * theory),
            why,
        ),
    ]
}

/// Of the grain off the top (rad).
fn angle(world: &World, centre: Vec3) -> f64 {
    let place = world.bed().grains.position(0) - centre;
    libm::atan2(place.y, place.z)
}

/// (m/s), by its energy.
fn pendulum_speed(rate_2: f64, ring: f64) -> f64 {
    ring * (2.0 * rate_2 * (libm::cos(FROM) - libm::cos(TO))).sqrt()
}

/// How long (s) the pendulum takes: ∫ dθ/θ' with θ = `FROM` + s², which takes away the pole at rest;
/// midpoint rule.
fn pendulum_time(rate_2: f64) -> f64 {
    let n = 10_000;
    let width = (TO - FROM).sqrt() / f64::from(n);
    let at = |k: i32| {
        let s = (f64::from(k) + 0.5) * width;
        let fallen = libm::cos(FROM) - libm::cos(FROM + s * s);
        2.0 * s * width / (2.0 * rate_2 * fallen).sqrt()
    };
    (0..n).map(at).sum()
}
