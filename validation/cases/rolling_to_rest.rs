//! A disc and a sphere that roll without slip until rolling resistance has stopped them.
//!
//! The couple M = μ_r R N (R* is the radius at a flat floor) and the friction F that keeps the roll,
//! at a lever h, give m a = F and I a/h = M − F h, so a = M h / (I + m h²): ⅔ μ_r g for a disc,
//! 5/7 μ_r g for a sphere, as h → R. The way is v₀²/2a.

use engine::grains::Space;
use engine::math::Vec3;
use engine::stage::ContactStage;

use crate::case::{Case, Outcome};
use crate::rig::{S1, SMALL, on_floor, rolling, run_while, stage};

pub(crate) const CASE: Case = Case {
    name: "rolling-to-rest",
    claim: "Rolling resistance stops a disc after v₀²/2a with a = ⅔ μ_r g, a sphere with 5/7 μ_r g.",
    run: rolls,
};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1e-5;
const SPEED: f64 = 0.1;
const FRICTION: f64 = 0.1;
/// Ten times what the slowest takes.
const MOST_STEPS: usize = 500_000;

type Resistance = fn() -> Box<dyn ContactStage>;

fn rolls() -> Vec<Outcome> {
    let laws: [(&str, Resistance); 2] = [
        ("rolling-resistance", || rolling(FRICTION, 0.3)),
        ("rolling-constant-torque", || {
            stage("rolling-constant-torque", &[("rolling_friction", FRICTION)])
        }),
    ];
    let mut rows = Vec::new();
    for (law, resistance) in laws {
        for (body, space) in [("disc", Space::Planar), ("sphere", Space::Spatial)] {
            rows.push(roll(&format!("{law}, {body}"), space, resistance));
        }
    }
    rows
}

fn roll(name: &str, space: Space, resistance: Resistance) -> Outcome {
    let overlap = SMALL.mass * GRAVITY / S1.normal_stiffness;
    let lever = SMALL.radius - 0.5 * overlap;
    let start = (Vec3::x() * SPEED, Vec3::y() * (SPEED / lever));
    let laws = (vec![S1.stage(), resistance()], S1.normal_stiffness);
    let mut world = on_floor(
        (space, space.inertia_coefficient()),
        SMALL,
        start,
        -Vec3::z() * GRAVITY,
        laws,
        DT,
    );
    let from = world.bed().grains.position(0).x;
    // A couple that cannot turn the rotation round leaves a creep that dies away.
    run_while(&mut world, MOST_STEPS, |world| world.bed().grains.velocity(0).x > 1e-6 * SPEED);
    let way = world.bed().grains.position(0).x - from;

    let couple = FRICTION * SMALL.radius * SMALL.mass * GRAVITY;
    let inertia = space.grain_inertia(SMALL.mass, SMALL.radius) + SMALL.mass * lever * lever;
    let exact = 0.5 * SPEED * SPEED * inertia / (couple * lever);
    // The angle at which the rolling spring, of stiffness 2.25 k_n (μ_r R)², holds the couple.
    let wound = couple / (2.25 * S1.normal_stiffness * (FRICTION * SMALL.radius).powi(2));
    Outcome::near(
        format!("{name}: way (m)"),
        way,
        (exact, wound * SMALL.radius + overlap),
        "the rolling spring is wound before it yields, on half the couple, and the tangential \
         spring stretched: as far as their elastic ways the work is not yet the full one",
    )
}
