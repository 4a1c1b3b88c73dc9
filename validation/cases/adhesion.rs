//! Spheres that stick: pull-off and loss of a head-on collision with a rigid wall.
//!
//! Derjaguin, Muller & Toporov: the largest pull is 2π W R*, and nothing is lost. Johnson, Kendall &
//! Roberts: it is 3/2 π W R*, and what is stored where the two let go, 7.092 (W⁵ R*⁴/E*²)^{1/3}, is lost.
//! A bridge pulls with 2π R γ, R = 2 R*, and loses ∫ F dS up to its rupture.

use std::f64::consts::PI;

use engine::stage::ContactStage;

use crate::case::{Case, Outcome};
use crate::rig::stage;
use crate::spheres::{Material, Motion, Obstacle, Rebound, collide, hertz_time};

pub(crate) const CASE: Case = Case {
    name: "adhesion",
    claim: "Spheres that stick pull and lose energy as DMT, JKR and Willett's bridge say.",
    run: sticking,
};

const STEPS_PER_CONTACT: f64 = 4000.0;
const RADIUS: f64 = 1e-3;
const SPEED: f64 = 0.1;
const WORK: f64 = 0.1;

const RUBBER: Material =
    Material { name: "soft", young_modulus: 1e7, poisson_ratio: 0.3, density: 1500.0 };

fn sticking() -> Vec<Outcome> {
    let jkr_loss = {
        let modulus = RUBBER.modulus_at_rigid();
        let length = libm::cbrt(libm::pow(WORK, 5.0) * RADIUS.powi(4) / (modulus * modulus));
        // π^{5/3} (1/10 + 3/5 · 4^{1/3}).
        libm::pow(PI, 5.0 / 3.0) * (0.1 + 0.6 * libm::cbrt(4.0)) * length
    };
    let (tension, volume) = (0.05, 1e-12);
    let touch = 4.0 * PI * RADIUS * tension;
    let bridge_loss = {
        // ∫ ds/(1 + 1.05 s + 2.5 s²) up to rupture, by Simpson's rule.
        let scale = (2.0 * RADIUS / volume).sqrt();
        let end = libm::cbrt(volume) * scale;
        touch / scale * simpson(|s| 1.0 / (1.0 + s * (1.05 + 2.5 * s)), end)
    };
    let work = ("work_of_adhesion", WORK);
    let water = [("surface_tension", tension), ("contact_angle", 0.0), ("liquid_volume", volume)];
    let mut rows = Vec::new();
    for (name, effect, pull, loss) in [
        ("DMT", stage("cohesion-dmt", &[work]), 2.0 * PI * WORK * RADIUS, 0.0),
        ("JKR", RUBBER.effect("cohesion-jkr", work), 1.5 * PI * WORK * RADIUS, jkr_loss),
        ("bridge", stage("capillary-bridge", &water), touch, bridge_loss),
    ] {
        rows.extend(collision(name, effect, pull, loss));
    }
    rows
}

fn collision(name: &str, effect: Box<dyn ContactStage>, pull: f64, loss: f64) -> [Outcome; 2] {
    let sphere = RUBBER.sphere(RADIUS);
    let motion = Motion { normal: SPEED, ..Motion::default() };
    let duration = hertz_time(sphere.mass, RADIUS, RUBBER.modulus_at_rigid(), SPEED);
    let laws = vec![RUBBER.hertz_mindlin(1.0, 0.0), effect];
    let after: Rebound =
        collide((sphere, motion), Obstacle::Wall, laws, duration / STEPS_PER_CONTACT);
    let energy = 0.5 * sphere.mass * SPEED * SPEED;
    let lost = energy - 0.5 * sphere.mass * after.motion.normal * after.motion.normal;
    [
        Outcome::near(
            format!("{name}: largest pull (N)"),
            after.largest_pull,
            (pull, 1e-3 * pull),
            "1e-3: the pull changes by less from one of 4 000 steps to the next",
        ),
        Outcome::near(
            format!("{name}: energy lost over that of the impact (–)"),
            lost / energy,
            (loss / energy, 2.0 * pull * SPEED * duration / STEPS_PER_CONTACT / energy),
            "a force that jumps does so somewhere within a step: half of its work over the step at \
             touch, as much at release, twice that for the speed of the pull itself",
        ),
    ]
}

/// ∫ from 0 to `end`, good to ten digits for a smooth function.
fn simpson(of: impl Fn(f64) -> f64, end: f64) -> f64 {
    let n = 200;
    let h = end / f64::from(n);
    let inner: f64 =
        (1..n).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * of(h * f64::from(k))).sum();
    h / 3.0 * (of(0.0) + inner + of(end))
}
