//! Coulomb friction on an inclined floor: a disc that cannot roll stands, or slides steadily.
//!
//! Above the angle of friction it accelerates by g (sin α − μ cos α); below it stays.

use engine::grains::Space;
use engine::math::Vec3;
use engine::world::World;

use crate::case::{Case, Outcome};
use crate::rig::{S1, SMALL, on_floor, rolling, run};

pub(crate) const CASE: Case = Case {
    name: "friction-on-incline",
    claim: "A block stands on a slope below the angle of friction and slides above it with \
            g (sin α − μ cos α).",
    run: slopes,
};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1e-5;

fn slopes() -> Vec<Outcome> {
    let mut rows = Vec::new();
    for (name, excess) in [("2 %", 0.02), ("20 %", 0.2)] {
        rows.push(sliding(name, excess));
        rows.extend(standing(name, excess));
    }
    rows
}

/// A disc on a slope of tan α = `slope`, released from rest. Its rolling resistance, four times the
/// couple that friction can exert, makes a block of it.
fn block(slope: f64) -> World {
    let cos = 1.0 / (1.0 + slope * slope).sqrt();
    let gravity = Vec3::new(slope * cos, 0.0, -cos) * GRAVITY;
    let laws = (vec![S1.stage(), rolling(4.0 * S1.friction, 0.3)], S1.normal_stiffness);
    on_floor((Space::Planar, 0.5), SMALL, (Vec3::zeros(), Vec3::zeros()), gravity, laws, DT)
}

fn velocity(world: &World) -> f64 {
    world.bed().grains.velocity(0).x
}

fn sliding(name: &str, excess: f64) -> Outcome {
    let slope = S1.friction * (1.0 + excess);
    let mut world = block(slope);
    run(&mut world, 5_000);
    let (start, from) = (world.clock().time(), velocity(&world));
    run(&mut world, 15_000);
    let acceleration = (velocity(&world) - from) / (world.clock().time() - start);
    let exact = GRAVITY * (slope - S1.friction) / (1.0 + slope * slope).sqrt();
    Outcome::near(
        format!("{name} above the angle of friction: acceleration (m/s²)"),
        acceleration,
        (exact, 1e-9 * GRAVITY),
        "exact once the springs have come to rest, which 50 ms of damping bring below 1e-9",
    )
}

fn standing(name: &str, excess: f64) -> [Outcome; 2] {
    let slope = S1.friction * (1.0 - excess);
    let mut world = block(slope);
    let start = world.bed().grains.position(0).x;
    run(&mut world, 20_000);
    let cos = 1.0 / (1.0 + slope * slope).sqrt();
    let pull = SMALL.mass * GRAVITY * slope * cos;
    // Released without a stretch, it passes its equilibrium at this speed at most: the rolling spring
    // in series is stiffer than the tangential one, so together they are more than half as stiff.
    let speed_2 = pull * pull * 2.0 / (S1.tangential_stiffness * SMALL.mass);
    let overshoot = 0.5 * speed_2 / (GRAVITY * cos * S1.friction * excess);
    [
        Outcome::at_most(
            format!("{name} below: speed after 0.2 s (m/s)"),
            velocity(&world),
            1e-12,
            "the springs come to rest with time constants below a millisecond",
        ),
        Outcome::at_most(
            format!("{name} below: way in 0.2 s (m)"),
            world.bed().grains.position(0).x - start,
            4.0 * pull / S1.tangential_stiffness + overshoot,
            "twice the stretch of the tangential and the rolling spring, and the way that sliding \
             friction needs to stop the swing of the release, v²/2a",
        ),
    ]
}
