//! Head-on collisions of spheres by Hertz: tests 1 to 3 of Chung & Ooi, Granul. Matter 13, 643 (2011).
//!
//! Parameters are theirs; what has to come out is Hertz's solution, or the restitution asked for.

use crate::case::{Case, Outcome};
use crate::spheres::{Material, Motion, Obstacle, Rebound, collide, hertz_time};

pub(crate) const CASE: Case = Case {
    name: "hertz-collisions",
    claim: "Spheres collide head-on as Hertz's law says, and rebound with the given restitution \
            (tests 1 to 3 of Chung & Ooi).",
    run: collisions,
};

const STEPS_PER_CONTACT: f64 = 1000.0;

const GLASS: Material =
    Material { name: "glass", young_modulus: 48e9, poisson_ratio: 0.2, density: 2800.0 };
const LIMESTONE: Material =
    Material { name: "limestone", young_modulus: 20e9, poisson_ratio: 0.25, density: 2500.0 };
const ALUMINIUM: Material =
    Material { name: "aluminium alloy", young_modulus: 70e9, poisson_ratio: 0.3, density: 2699.0 };
const MAGNESIUM: Material =
    Material { name: "magnesium alloy", young_modulus: 40e9, poisson_ratio: 0.35, density: 1800.0 };
const OXIDE: Material = Material {
    name: "aluminium oxide",
    young_modulus: 380e9,
    poisson_ratio: 0.23,
    density: 4000.0,
};
const IRON: Material =
    Material { name: "cast iron", young_modulus: 100e9, poisson_ratio: 0.25, density: 7000.0 };

/// Largest overlap (m) and force (N), and duration (s), to six and five digits.
struct Hertz([f64; 3]);

fn collisions() -> Vec<Outcome> {
    let mut rows = Vec::new();
    for (material, hertz) in [
        (GLASS, Hertz([274.113e-6, 10.6969e3, 40.338e-6])),
        (LIMESTONE, Hertz([368.304e-6, 7.108_24e3, 54.200e-6])),
    ] {
        rows.extend(elastic(&format!("1, two {} spheres", material.name), pair(material), &hertz));
    }
    for (material, hertz) in [
        (ALUMINIUM, Hertz([49.7172e-6, 11.3699e3, 731.64e-6])),
        (MAGNESIUM, Hertz([52.1233e-6, 7.232_68e3, 767.05e-6])),
    ] {
        let rebound = at_wall(material, 0.1, 0.2, 1.0);
        rows.extend(elastic(&format!("2, {} on a wall", material.name), rebound, &hertz));
    }
    for material in [OXIDE, IRON] {
        for restitution in [0.2, 0.4, 0.6, 0.8, 1.0] {
            let rebound = at_wall(material, 2.5e-3, 3.9, restitution);
            rows.push(Outcome::near(
                format!("3, {} on a wall: restitution for {restitution} (–)", material.name),
                rebound.motion.normal / 3.9,
                (restitution, 1e-3 * restitution),
                "a thousandth, some hundred times what a second-order step leaves at a thousand \
                 steps per contact",
            ));
        }
    }
    rows
}

fn pair(material: Material) -> Rebound {
    let sphere = material.sphere(0.01);
    let motion = Motion { normal: 10.0, ..Motion::default() };
    let modulus = material.modulus_of_two();
    let duration = hertz_time(0.5 * sphere.mass, 0.5 * sphere.radius, modulus, 20.0);
    let law = vec![material.hertz_mindlin(1.0, 0.35)];
    let other = Obstacle::Sphere(sphere, motion);
    collide((sphere, motion), other, law, duration / STEPS_PER_CONTACT)
}

fn at_wall(material: Material, radius: f64, speed: f64, restitution: f64) -> Rebound {
    let sphere = material.sphere(radius);
    let motion = Motion { normal: speed, ..Motion::default() };
    let duration = hertz_time(sphere.mass, radius, material.modulus_at_rigid(), speed);
    let law = vec![material.hertz_mindlin(restitution, 0.0)];
    collide((sphere, motion), Obstacle::Wall, law, duration / STEPS_PER_CONTACT)
}

fn elastic(
    name: &str,
    rebound: Rebound,
    Hertz([overlap, force, duration]): &Hertz,
) -> Vec<Outcome> {
    let why = "1e-4: what is printed to six digits, at a thousand steps per contact";
    [
        ("largest overlap (m)", rebound.largest_overlap, *overlap),
        ("largest force (N)", rebound.largest_force, *force),
        ("duration (s)", rebound.duration, *duration),
    ]
    .map(|(what, measured, exact)| {
        Outcome::near(format!("{name}: {what}"), measured, (exact, 1e-4 * exact), why)
    })
    .into()
}
