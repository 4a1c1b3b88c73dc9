//! A sphere that meets a wall or another sphere in free flight, and how it leaves.
//!
//! It comes from above, so z is the normal and x lies in the contact plane. `spin` counts as the speed of
//! the lowest point does: the surface slips with v + r ω, which is a turn about −y.

use engine::body::NoIntruder;
use engine::boundary::Container;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::stage::ContactStage;
use engine::world::World;

use crate::rig::{bed, run, stage};

/// A material by its elastic constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Its name in tables.
    pub name: &'static str,
    /// E (Pa).
    pub young_modulus: f64,
    /// ν (–).
    pub poisson_ratio: f64,
    /// ρ (kg/m³).
    pub density: f64,
}

/// A solid sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
}

/// Motion of a sphere before or after a collision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Towards the target (m/s).
    pub normal: f64,
    /// Along the contact plane (m/s).
    pub tangential: f64,
    /// (rad/s).
    pub spin: f64,
}

/// What a sphere meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// A flat wall.
    Wall,
    /// Another sphere, and how it moves: `normal` towards the first, the rest as for the first.
    Sphere(Sphere, Motion),
}

/// How a collision went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// Of the sphere; `normal` away from the target.
    pub motion: Motion,
    /// (m).
    pub largest_overlap: f64,
    /// (N).
    pub largest_force: f64,
    /// (N); zero unless something attracts.
    pub largest_pull: f64,
    /// From touch to release (s).
    pub duration: f64,
}

/// Half the width (m) of a room whose walls are out of reach.
const MIDDLE: f64 = 8.0;

impl Material {
    /// The same, `factor` times as stiff.
    #[must_use]
    pub fn times_as_stiff(self, factor: f64) -> Self {
        Self { young_modulus: factor * self.young_modulus, ..self }
    }

    /// A solid sphere of it.
    pub fn sphere(&self, radius: f64) -> Sphere {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        Sphere { radius, mass: self.density * volume }
    }

    /// E* (Pa) of two bodies of it.
    pub fn modulus_of_two(&self) -> f64 {
        0.5 * self.modulus_at_rigid()
    }

    /// E* (Pa) of one body of it against a rigid one.
    pub fn modulus_at_rigid(&self) -> f64 {
        self.young_modulus / (1.0 - self.poisson_ratio * self.poisson_ratio)
    }

    /// The Hertz–Mindlin law for spheres of it and a rigid wall, damped to `restitution`.
    pub fn hertz_mindlin(&self, restitution: f64, friction: f64) -> Box<dyn ContactStage> {
        let mut values = self.hertz(friction, ("restitution", restitution), 1.0).to_vec();
        values.extend([("wall_restitution", restitution), ("intruder_restitution", restitution)]);
        stage("hertz-mindlin", &values)
    }

    /// The viscoelastic law for spheres of it and a rigid wall.
    pub fn hertz_mindlin_viscous(&self, viscous_time: f64, friction: f64) -> Box<dyn ContactStage> {
        stage("hertz-mindlin-viscous", &self.hertz(friction, ("viscous_time", viscous_time), 0.0))
    }

    /// The effect `name` on a Hertz law for grains of it, with one parameter of its own.
    pub fn effect(&self, name: &str, own: (&'static str, f64)) -> Box<dyn ContactStage> {
        let mut values = vec![own];
        values.extend(
            self.hertz(0.0, own, 0.0).into_iter().filter(|(key, _)| {
                key.ends_with("young_modulus") || key.ends_with("poisson_ratio")
            }),
        );
        stage(name, &values)
    }

    fn hertz(
        &self,
        friction: f64,
        damping: (&'static str, f64),
        tangential_damping: f64,
    ) -> [(&'static str, f64); 11] {
        let Self { young_modulus, poisson_ratio, .. } = *self;
        [
            ("young_modulus", young_modulus),
            ("poisson_ratio", poisson_ratio),
            damping,
            ("friction", friction),
            ("wall_friction", friction),
            ("intruder_friction", friction),
            // Stiff enough to add nothing to the last digit.
            ("wall_young_modulus", 1e30),
            ("wall_poisson_ratio", poisson_ratio),
            ("intruder_young_modulus", 1e30),
            ("intruder_poisson_ratio", poisson_ratio),
            ("tangential_damping", tangential_damping),
        ]
    }
}

/// How long (s) two bodies of reduced mass m* (kg), radius R* (m) and modulus E* (Pa) touch that approach
/// with `speed` (m/s): 2 ∫ dx/√(1 − x^{5/2}) times the largest overlap over the speed.
pub fn hertz_time(mass_eff: f64, radius_eff: f64, modulus: f64, speed: f64) -> f64 {
    hertz_overlap(mass_eff, radius_eff, modulus, speed) / speed * 2.943_275_3
}

/// Their largest overlap (m).
pub fn hertz_overlap(mass_eff: f64, radius_eff: f64, modulus: f64, speed: f64) -> f64 {
    let swing = 15.0 / 16.0 * mass_eff * speed * speed / (modulus * radius_eff.sqrt());
    libm::pow(swing, 0.4)
}

/// Lets `sphere` with `motion` collide, without gravity, in steps of `dt` (s).
///
/// # Panics
/// If it does not come back within a million steps.
pub fn collide(
    (sphere, motion): (Sphere, Motion),
    obstacle: Obstacle,
    stages: Vec<Box<dyn ContactStage>>,
    dt: f64,
) -> Rebound {
    let mut flight = Flight::new((sphere, motion), obstacle, stages, dt);
    let (mut before, mut rebound) = (flight.overlap(), None);
    for _ in 0..1_000_000 {
        run(&mut flight.world, 1);
        let overlap = flight.overlap();
        // Attraction may hold on to a contact that has opened.
        if overlap > 0.0 || rebound.is_some() && flight.normal_force() < 0.0 {
            let seen = rebound.get_or_insert(Rebound {
                motion: Motion::default(),
                largest_overlap: 0.0,
                largest_force: 0.0,
                largest_pull: 0.0,
                duration: 0.0,
            });
            seen.largest_overlap = seen.largest_overlap.max(overlap);
            seen.largest_force = seen.largest_force.max(flight.normal_force());
            seen.largest_pull = seen.largest_pull.max(-flight.normal_force());
        } else if let Some(mut seen) = rebound {
            let released = flight.world.clock().time() + dt * overlap / (before - overlap);
            seen.duration = released - flight.touch;
            seen.motion = flight.motion();
            return seen;
        }
        before = overlap;
    }
    panic!("the sphere comes back within a million steps");
}

/// A sphere above what it will meet.
struct Flight {
    world: World,
    target: Option<f64>,
    radius: f64,
    /// When the two touch (s).
    touch: f64,
}

impl Flight {
    fn new(
        (sphere, motion): (Sphere, Motion),
        obstacle: Obstacle,
        stages: Vec<Box<dyn ContactStage>>,
        dt: f64,
    ) -> Self {
        let (floor, target) = match obstacle {
            Obstacle::Wall => (0.0, None),
            Obstacle::Sphere(other, motion) => (MIDDLE + other.radius, Some((other, motion))),
        };
        let approach = motion.normal + target.map_or(0.0, |(_, motion)| motion.normal);
        let gap = 1.6 * dt * approach;
        let grain = |Sphere { radius, mass }, height, motion: Motion, towards: f64| Grain {
            position: Vec3::new(MIDDLE, MIDDLE, height),
            velocity: Vec3::new(motion.tangential, 0.0, towards * motion.normal),
            spin: -Vec3::y() * motion.spin,
            radius,
            mass,
            id: 0,
        };
        let mut grains = vec![grain(sphere, floor + sphere.radius + gap, motion, -1.0)];
        grains.extend(target.map(|(other, motion)| grain(other, MIDDLE, motion, 1.0)));
        let room = Container::walled_box(2.0 * MIDDLE, 2.0 * MIDDLE);
        let bed = bed((Space::Spatial, room), Vec3::zeros(), &grains, stages, 0);
        // The gap as it is once positions are rounded.
        let mut flight = Self {
            world: World::new(bed, Box::new(NoIntruder), dt),
            target: target.map(|(other, _)| other.radius),
            radius: sphere.radius,
            touch: 0.0,
        };
        flight.touch = -flight.overlap() / approach;
        flight
    }

    /// Places of the sphere and of the other one in the bed.
    fn places(&self) -> (usize, usize) {
        let first = self.world.bed().grains.id.iter().position(|&id| id == 0).unwrap_or(0);
        (first, 1 - first.min(1))
    }

    fn overlap(&self) -> f64 {
        let (one, other) = self.places();
        let position = |i| self.world.bed().grains.position(i);
        match self.target {
            None => self.radius - position(one).z,
            Some(radius) => self.radius + radius - (position(one) - position(other)).norm(),
        }
    }

    fn normal_force(&self) -> f64 {
        self.world.bed().grains.force(self.places().0).z
    }

    fn motion(&self) -> Motion {
        let (grains, (one, _)) = (&self.world.bed().grains, self.places());
        let velocity = grains.velocity(one);
        Motion { normal: velocity.z, tangential: velocity.x, spin: -grains.spin(one).y }
    }
}
