//! Restitution of viscoelastic spheres by the series e = 1 − C₁ Aκ + C₂ (Aκ)² − …, κ = (α² v)^{1/5}.
//!
//! C₁ = 1.15344 and C₂ = 3/5 C₁²; α = (3/2)^{5/2} k/m*, k = 4/3 E* √R*. Source: Ramírez, Pöschel,
//! Brilliantov & Schwager, Phys. Rev. E 60, 4465 (1999).

use engine::stage::ContactStage;

use crate::case::{Case, Outcome};
use crate::spheres::{Material, Motion, Obstacle, collide, hertz_time};

pub(crate) const CASE: Case = Case {
    name: "viscoelastic-restitution",
    claim: "Viscoelastic spheres rebound less the faster they meet, as the series in v^{1/5} says.",
    run: rebounds,
};

const STEPS_PER_CONTACT: f64 = 2000.0;
const RADIUS: f64 = 1e-3;
const VISCOUS_TIME: f64 = 2e-7;

const BEAD: Material =
    Material { name: "bead", young_modulus: 1e9, poisson_ratio: 0.3, density: 2500.0 };

fn rebounds() -> Vec<Outcome> {
    let mut rows = Vec::new();
    for speed in [1e-3, 0.03, 1.0] {
        let law = || vec![BEAD.hertz_mindlin_viscous(VISCOUS_TIME, 0.0)];
        let sum = || {
            let damping = ("viscous_time", VISCOUS_TIME);
            vec![BEAD.hertz_mindlin(1.0, 0.0), BEAD.effect("velocity-restitution", damping)]
        };
        let (series, next) = series(speed);
        rows.push(Outcome::near(
            format!("hertz-mindlin-viscous at {speed} m/s: restitution (–)"),
            restitution(law(), speed),
            (series, next + 2e-6),
            "the size of the term that the series is cut before, (C₁ Aκ)³, and a second-order error at \
             2 000 steps per contact",
        ));
        rows.push(Outcome::near(
            format!("velocity-restitution on hertz-mindlin at {speed} m/s: restitution (–)"),
            restitution(sum(), speed),
            (restitution(law(), speed), 1e-12),
            "the same law in two parts: round-off of 2 000 steps",
        ));
    }
    rows
}

/// e (–) to second order, and the size of what follows.
fn series(speed: f64) -> (f64, f64) {
    let stiffness = 4.0 / 3.0 * BEAD.modulus_at_rigid() * RADIUS.sqrt();
    let alpha = libm::pow(1.5, 2.5) * stiffness / BEAD.sphere(RADIUS).mass;
    let first = 1.153_44 * VISCOUS_TIME * libm::pow(alpha * alpha * speed, 0.2);
    (1.0 - first + 0.6 * first * first, first.powi(3))
}

fn restitution(laws: Vec<Box<dyn ContactStage>>, speed: f64) -> f64 {
    let sphere = BEAD.sphere(RADIUS);
    let motion = Motion { normal: speed, ..Motion::default() };
    let duration = hertz_time(sphere.mass, RADIUS, BEAD.modulus_at_rigid(), speed);
    let dt = duration / STEPS_PER_CONTACT;
    collide((sphere, motion), Obstacle::Wall, laws, dt).motion.normal / speed
}
