//! Free flight of a grain and of an intruder under gravity.

use engine::grains::Space;
use engine::math::Vec3;
use engine::world::World;

use crate::case::{Case, Outcome};
use crate::rig::{DISC, MIDDLE, ROOM, S1, SMALL, bed, run};

pub(crate) const CASE: Case = Case {
    name: "ballistic-flight",
    claim: "A grain and an intruder that touch nothing fly along exact parabolas.",
    run: flights,
};

const DT: f64 = 1e-5;
const STEPS: usize = 10_000;

fn flights() -> Vec<Outcome> {
    let gravity = Vec3::new(0.5, 0.0, -9.81);
    let (from, thrown) = (MIDDLE, Vec3::new(1.0, 0.0, 1.5));
    let (other, dropped) = (MIDDLE + Vec3::x() * 0.2, Vec3::new(0.3, 0.0, 0.0));
    let bed =
        bed((Space::Planar, ROOM), gravity, &[SMALL.grain(from, thrown)], vec![S1.stage()], 1);
    let mut world = World::new(bed, Box::new(DISC.disc(other, dropped, Vec3::zeros())), DT);
    let (mut of_grain, mut of_disc) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        run(&mut world, 1);
        let t = world.clock().time();
        let fallen = gravity * (0.5 * t * t);
        let grain = world.bed().grains.position(0) - (from + thrown * t + fallen);
        let disc = world.intruder().bodies()[0].position - (other + dropped * t + fallen);
        of_grain = of_grain.max(grain.norm());
        of_disc = of_disc.max(disc.norm());
    }
    let why = "velocity Verlet integrates a constant force exactly; each of the steps rounds a \
               position below 1 m and a velocity below 2 m/s that acts for 0.1 s";
    let limit = STEPS as f64 * f64::EPSILON * (1.0 + 2.0 * 0.1);
    vec![
        Outcome::at_most("grain, distance from the parabola (m)", of_grain, limit, why),
        Outcome::at_most("disc, distance from the parabola (m)", of_disc, limit, why),
    ]
}
