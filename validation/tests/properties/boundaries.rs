//! What stands in the place of walls: layers that absorb, sides that repeat, walls that only grains feel.

use std::sync::Arc;

use engine::bed::{GrainKind, Settling, fill, random};
use engine::body::{NoIntruder, RigidBody};
use engine::boundary::{Base, Container, Layer, Sides};
use engine::grains::{Grain, Space};
use engine::math::{Quat, Vec3};
use engine::params::ParamTable;
use engine::stage::ContactStage;
use engine::world::World;
use rand::RngExt;
use validation::rig::{Linear, S1, SMALL, Size, bed, run, stage};

/// Springs alone.
const ELASTIC: Linear = Linear {
    normal_damping_rate: 0.0,
    tangential_damping_rate: 0.0,
    friction: 0.0,
    tangential_stiffness: 1000.0,
    normal_stiffness: 1000.0,
};

const GRAIN: Size = Size { radius: 1e-3, mass: 1e-5 };

/// A chain of spheres between two walls, pressed together.
struct Chain {
    n: usize,
    law: fn() -> Box<dyn ContactStage>,
    /// dF/dδ of neighbours (N/m).
    stiffness: f64,
    /// Overlap of neighbours (m).
    overlap: f64,
    /// Overlap at the walls under the same load (m).
    wall_overlap: f64,
}

/// Elastic spheres, soft for a long step.
fn elastic_spheres() -> Box<dyn ContactStage> {
    let body = |young, poisson| [(young, YOUNG_MODULUS), (poisson, 0.25)];
    let params = [
        body("young_modulus", "poisson_ratio"),
        body("wall_young_modulus", "wall_poisson_ratio"),
        body("intruder_young_modulus", "intruder_poisson_ratio"),
        [("friction", 0.0), ("wall_friction", 0.0)],
        [("intruder_friction", 0.0), ("restitution", 1.0)],
        [("wall_restitution", 1.0), ("intruder_restitution", 1.0)],
    ];
    let tangential_damping = [("tangential_damping", 0.0)];
    stage("hertz-mindlin", &[params.as_flattened(), &tangential_damping].concat())
}

/// (Pa).
const YOUNG_MODULUS: f64 = 1e8;

impl Chain {
    fn linear(n: usize) -> Self {
        let overlap = 1e-3 * GRAIN.radius;
        let (law, stiffness): (fn() -> _, _) = (|| ELASTIC.stage(), ELASTIC.normal_stiffness);
        Self { n, law, stiffness, overlap, wall_overlap: overlap }
    }

    fn hertzian(n: usize) -> Self {
        let overlap = 1e-3 * GRAIN.radius;
        let modulus_eff = 0.5 * YOUNG_MODULUS / (1.0 - 0.25 * 0.25);
        let stiffness = 2.0 * modulus_eff * (0.5 * GRAIN.radius * overlap).sqrt();
        // A flat wall has twice the R* of two grains.
        let wall_overlap = overlap / libm::cbrt(2.0);
        Self { n, law: elastic_spheres, stiffness, overlap, wall_overlap }
    }

    /// Distance of neighbours (m).
    fn spacing(&self) -> f64 {
        2.0 * GRAIN.radius - self.overlap
    }

    /// c = d √(k/m) (m/s).
    fn wave_speed(&self) -> f64 {
        self.spacing() * (self.stiffness / GRAIN.mass).sqrt()
    }

    fn place(&self, i: usize) -> f64 {
        GRAIN.radius - self.wall_overlap + i as f64 * self.spacing()
    }

    /// Share of the energy of a pulse that is still before the layers when the pulse that went in has had
    /// time to come back: `profile` is its velocity over −½ … ½, `width` its length in grains.
    fn returned(&self, profile: fn(f64) -> f64, width: f64, layer: Option<Layer>) -> f64 {
        // Weak, so that no contact opens and a Hertz contact is as good as linear.
        let peak = 0.02 * self.overlap / self.spacing() * self.wave_speed();
        let middle = (self.n / 2) as f64;
        let velocity = |i: f64| {
            let s = (i - middle) / width;
            if s.abs() < 0.5 { peak * profile(s) } else { 0.0 }
        };
        // A wave to the right has the strain −v/c; what is behind it rests, what is ahead has still to
        // be moved.
        let shift = |i: usize| -> f64 {
            let behind = (0..i * 100).map(|k| velocity((k as f64 + 0.5) / 100.0));
            behind.sum::<f64>() * -0.01 * self.spacing() / self.wave_speed()
        };
        let length = 2.0 * self.place(0) + (self.n - 1) as f64 * self.spacing() + shift(self.n - 1);
        let sides = layer.map_or(Sides::Wall, Sides::Absorbing);
        let container = Container { sides, ..Container::walled_box(length, 1.0) };
        let grains: Vec<Grain> = (0..self.n)
            .map(|i| {
                let at = Vec3::new(self.place(i) + shift(i), 0.0, 0.5);
                GRAIN.grain(at, Vec3::x() * velocity(i as f64))
            })
            .collect();
        let bed = bed((Space::Planar, container), Vec3::zeros(), &grains, vec![(self.law)()], 0);
        // A fortieth of the collision of two grains.
        let dt = 0.025 * std::f64::consts::PI * (0.5 * GRAIN.mass / self.stiffness).sqrt();
        let mut world = World::new(bed, Box::new(NoIntruder), dt);
        let thickness = layer.map_or(0.0, |layer| layer.thickness);
        let kinetic = |world: &World| -> f64 {
            let grains = &world.bed().grains;
            let before_layer = grains.iter().filter(|grain| {
                grain.position.x > thickness && grain.position.x < length - thickness
            });
            before_layer.map(|grain| grain.velocity.norm_squared()).sum()
        };
        let start = kinetic(&world);
        // To the wall and back to the middle.
        let time = length / self.wave_speed();
        run(&mut world, (time / dt) as usize);
        // Half of the energy of a wave is kinetic.
        kinetic(&world) / start
    }
}

/// A push.
fn one_sided(s: f64) -> f64 {
    let cos = libm::cos(std::f64::consts::PI * s);
    cos * cos
}

/// A push and a pull: one wavelength.
fn two_sided(s: f64) -> f64 {
    libm::sin(2.0 * std::f64::consts::PI * s) * one_sided(s)
}

#[test]
fn a_layer_swallows_the_wave_that_a_wall_sends_back() {
    for chain in [Chain::linear(200), Chain::hertzian(200)] {
        let diameters = |n: f64| Layer::for_waves(n * 2.0 * GRAIN.radius, chain.wave_speed());
        for width in [10.0, 20.0] {
            // What runs slower than long waves has not yet come back.
            let wall = chain.returned(two_sided, width, None);
            assert!(wall > 0.9, "{width}: {wall}");
            let layer = chain.returned(two_sided, width, Some(diameters(8.0)));
            assert!(layer < 0.05, "{width}: {layer}");
        }
        // A push alone is made of waves of every length, and the longest feel the wall behind the layer.
        let [thin, thick] =
            [8.0, 24.0].map(|n| chain.returned(one_sided, 10.0, Some(diameters(n))));
        assert!(thin < 0.25 && thick < 0.5 * thin, "{thin} {thick}");
    }
}

/// Grains that fly about, away from the floor.
fn cloud(space: Space, container: &Container) -> Vec<Grain> {
    let kinds = [GrainKind { count: 150, radius: SMALL.radius, mass: SMALL.mass }];
    let mut rng = random(3, "cloud");
    fill(&kinds, (space, container), 3)
        .into_iter()
        .map(|grain| {
            let mut number = || 2.0 * rng.random::<f64>() - 1.0;
            let y = if space == Space::Spatial { number() } else { 0.0 };
            Grain {
                position: grain.position + Vec3::z(),
                velocity: Vec3::new(number(), y, number()),
                ..grain
            }
        })
        .collect()
}

fn periodic(width: f64, depth: f64) -> Container {
    Container { sides: Sides::Periodic, ..Container::walled_box(width, depth) }
}

#[test]
fn grains_between_periodic_sides_keep_their_momentum() {
    for (space, container) in
        [(Space::Planar, periodic(0.06, 0.0)), (Space::Spatial, periodic(0.03, 0.035))]
    {
        let grains = cloud(space, &container);
        let bed = bed((space, container), Vec3::zeros(), &grains, vec![S1.stage()], 0);
        let mut world = World::new(bed, Box::new(NoIntruder), 1e-5);
        let momentum = |world: &World| -> Vec3 {
            let grains = &world.bed().grains;
            grains.iter().map(|grain| grain.velocity * grain.mass).sum()
        };
        let start = momentum(&world);
        let scale: f64 = grains.iter().map(|grain| grain.mass * grain.velocity.norm()).sum();
        let mut seen = 0;
        for _ in 0..50 {
            run(&mut world, 60);
            seen += world.bed().touching_pairs().len();
        }
        assert!(seen > 50, "{seen} contacts are few");
        // Round-off of 3 000 steps.
        assert!((momentum(&world) - start).norm() < 1e-13 * scale);
        let [width, depth] = container.extents();
        assert!(world.bed().grains.positions().all(|at| {
            (0.0..width).contains(&at.x) && (space == Space::Planar || (0.0..depth).contains(&at.y))
        }));
    }
}

#[test]
fn a_collision_across_a_periodic_side_is_that_in_the_middle() {
    let width = 0.0625;
    let after = |shift: f64| {
        let inside = |x: f64| (x + shift).rem_euclid(width);
        let at = |x: f64, z: f64| Vec3::new(inside(x), 0.0, 0.5 + z);
        let grains = [
            SMALL.grain(at(-0.0024, 0.0), Vec3::new(0.7, 0.0, 0.1)),
            SMALL.grain(at(0.0024, 0.001), Vec3::new(-0.5, 0.0, 0.0)),
        ];
        let container = periodic(width, 0.0);
        let bed = bed((Space::Planar, container), Vec3::zeros(), &grains, vec![S1.stage()], 0);
        let mut world = World::new(bed, Box::new(NoIntruder), 1e-6);
        run(&mut world, 3_000);
        let grains = &world.bed().grains;
        let of = |id: u32| grains.id.iter().position(|own| *own == id).expect("it is there");
        (grains.velocity(of(0)) - grains.velocity(of(1)), grains.spin(of(0)), grains.spin(of(1)))
    };
    let (across, middle) = (after(0.0), after(0.5 * width));
    assert!((middle.0 - Vec3::new(1.2, 0.0, 0.1)).norm() > 0.1, "they have met");
    // Positions near 0.06 m are rounded to 7e-18 m, and a stiffness of 3200 N/m over 5e-5 kg makes
    // velocities of that.
    assert!((across.0 - middle.0).norm() < 1e-12, "{across:?} {middle:?}");
    assert!((across.1 - middle.1).norm() < 1e-9);
    assert!((across.2 - middle.2).norm() < 1e-9);
}

#[test]
fn where_nothing_comes_near_them_periodic_sides_change_no_bit() {
    let after = |container: Container| {
        let grains: Vec<Grain> = cloud(Space::Planar, &Container::walled_box(0.06, 0.0))
            .into_iter()
            .map(|grain| Grain { position: grain.position + Vec3::x() * 0.47, ..grain })
            .collect();
        let bed = bed((Space::Planar, container), Vec3::zeros(), &grains, vec![S1.stage()], 0);
        let mut world = World::new(bed, Box::new(NoIntruder), 1e-5);
        run(&mut world, 2_000);
        world.bed().grains.positions().collect::<Vec<_>>()
    };
    let walled = after(Container::walled_box(1.0, 0.0));
    assert_eq!(walled, after(periodic(1.0, 0.0)));
}

#[test]
fn spheres_settle_inside_of_a_cylinder() {
    let diameter = 0.03;
    let container =
        Container { base: Base::Circle { diameter }, ..Container::walled_box(0.0, 0.0) };
    let kinds = [GrainKind { count: 250, radius: 1.5e-3, mass: 3.5e-5 }];
    let room = (Space::Spatial, container);
    let grains = fill(&kinds, (Space::Spatial, &container), 1);
    let soft = Linear {
        normal_stiffness: 300.0,
        tangential_stiffness: 300.0,
        normal_damping_rate: 2e3,
        tangential_damping_rate: 1e3,
        friction: 0.3,
    };
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let mut settling = Settling::new(&grains, room, gravity, vec![soft.stage()], 2.5e-5);
    while !settling.is_at_rest() {
        settling.advance().expect("a sound step");
        assert!(settling.clock().time() < 1.0, "no rest: {}", settling.restlessness());
    }
    let mut at_side = 0;
    for position in settling.bed().grains.positions() {
        let from_axis = (position - Vec3::new(0.015, 0.015, position.z)).norm();
        // The load of the bed is some grains' weight: an overlap of 1e-5 m or less.
        assert!(from_axis < 0.015 - 1.5e-3 + 2e-5 && position.z > 1.5e-3 - 2e-5);
        at_side += usize::from(from_axis > 0.015 - 1.5e-3);
    }
    assert!(at_side > 20, "{at_side} grains touch the side");
}

/// Worst share of unaccounted energy, and the work of the wall over the energy at the start, of a cylinder
/// under a long shaft that tumbles through flying spheres for 12 ms.
fn tumbling_under_a_shaft(dt: f64) -> (f64, f64) {
    let container = Container::walled_box(0.05, 0.05);
    let kinds = [GrainKind { count: 600, radius: SMALL.radius, mass: SMALL.mass }];
    let params = ParamTable::from_iter([("diameter", 0.012), ("height", 0.01)]);
    let shape = intruders::find("cylinder").expect("the cylinder is registered");
    let under_shaft = shape.under_shaft.expect("it has a top");
    let surface = under_shaft(&params, Space::Spatial, 0.04);
    let mut rng = random(9, "velocities");
    let middle = Vec3::new(0.025, 0.025, 0.015);
    let grains: Vec<Grain> = fill(&kinds, (Space::Spatial, &container), 9)
        .into_iter()
        .filter(|grain| surface.closest(grain.position - middle).gap > grain.radius)
        .map(|grain| {
            let mut number = || 2.0 * rng.random::<f64>() - 1.0;
            Grain { velocity: Vec3::new(number(), number(), number()), ..grain }
        })
        .collect();
    let inertia = Vec3::new(2e-6, 3e-6, 2.5e-6);
    let mut body = RigidBody::new("cylinder", Arc::clone(&surface), 0.01, inertia);
    body.launch(middle, Quat::identity(), Vec3::new(0.5, 0.2, -0.3), Vec3::new(20.0, -15.0, 5.0));
    let law = Linear { normal_damping_rate: 3e3, ..S1 };
    let bed = bed((Space::Spatial, container), Vec3::zeros(), &grains, vec![law.stage()], 1);
    let mut world = World::new(bed, Box::new(body), dt);
    let energy = world.ledger().value("kinetic_grains_translation_J").expect("a term of every bed");
    let mut worst = 0.0_f64;
    for _ in 0..(0.012 / dt) as usize {
        run(&mut world, 1);
        worst = worst.max((world.ledger().balance().unaccounted / energy).abs());
    }
    let input = world.ledger().value("input_recessive_wall_J").expect("the wall has an account");
    (worst, (input / energy).abs())
}

#[test]
fn the_work_of_a_wall_that_only_grains_feel_is_accounted_for_to_second_order() {
    let (coarse, work) = tumbling_under_a_shaft(8e-6);
    let (fine, _) = tumbling_under_a_shaft(4e-6);
    assert!(work > 0.02, "{work}");
    // A contact that opens inside of a step leaves an error of its own phase.
    assert!(coarse < 2e-3 && coarse / fine > 3.0, "{coarse:e} {fine:e}");
}
