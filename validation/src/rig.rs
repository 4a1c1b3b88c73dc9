//! Small experiments put together from parts, without a model file.
//!
//! A container cannot be left out of a bed, so free experiments happen around [`MIDDLE`], out of
//! reach of its walls.

use engine::body::{NoIntruder, RigidBody};
use engine::boundary::Container;
use engine::grain_bed::{GrainBed, RestingBed};
use engine::grains::{Grain, Space};
use engine::math::{Quat, Vec3};
use engine::params::ParamTable;
use engine::stage::ContactStage;
use engine::world::World;

/// Where free experiments happen (m): below an eighth of a metre positions are rounded to 7e-18 m.
pub const MIDDLE: Vec3 = Vec3::new(0.09375, 0.0, 0.09375);

/// A container a metre wide and deep.
pub const ROOM: Container = Container::walled_box(1.0, 1.0);

/// Size and mass of a grain or a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
}

/// The small grain of Wang, Ye & Zheng (2012).
pub const SMALL: Size = Size { radius: 2.28e-3, mass: 4.9e-5 };

/// Their large grain.
pub const LARGE: Size = Size { radius: 3.175e-3, mass: 9.7e-5 };

/// Their intruder.
pub const DISC: Size = Size { radius: 2.23e-2, mass: 3.22e-2 };

impl Size {
    /// A grain of this size that moves without spin.
    #[must_use]
    pub fn grain(self, position: Vec3, velocity: Vec3) -> Grain {
        let Self { radius, mass } = self;
        Grain { position, velocity, spin: Vec3::zeros(), radius, mass, id: 0 }
    }

    /// A disc of this size as an intruder.
    ///
    /// # Panics
    /// If the disc is not among the shapes.
    #[must_use]
    pub fn disc(self, position: Vec3, velocity: Vec3, spin: Vec3) -> RigidBody {
        let params = ParamTable::from_iter([("diameter", 2.0 * self.radius)]);
        let shape = intruders::find("disc").expect("the disc is registered");
        let body = (shape.build)(&params, Space::Planar);
        let inertia = body.inertia_per_mass * self.mass;
        let mut disc = RigidBody::new("disc", body.surface, self.mass, inertia);
        disc.launch(position, Quat::identity(), velocity, spin);
        disc
    }
}

/// The linear law, the same at grains, walls and intruder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// k_n (N/m).
    pub normal_stiffness: f64,
    /// k_t (N/m).
    pub tangential_stiffness: f64,
    /// γ_n (1/s).
    pub normal_damping_rate: f64,
    /// γ_t (1/s).
    pub tangential_damping_rate: f64,
    /// μ (–).
    pub friction: f64,
}

/// The law of Wang, Ye & Zheng (2012).
pub const S1: Linear = Linear {
    normal_stiffness: 3200.0,
    tangential_stiffness: 3200.0,
    normal_damping_rate: 1e4,
    tangential_damping_rate: 8e3,
    friction: 0.28,
};

impl Linear {
    /// The law, ready to run.
    pub fn stage(&self) -> Box<dyn ContactStage> {
        stage(
            "linear-spring-dashpot",
            &[
                ("normal_stiffness", self.normal_stiffness),
                ("tangential_stiffness", self.tangential_stiffness),
                ("normal_damping_rate", self.normal_damping_rate),
                ("tangential_damping_rate", self.tangential_damping_rate),
                ("friction", self.friction),
                ("wall_friction", self.friction),
                ("intruder_friction", self.friction),
            ],
        )
    }
}

/// Rolling resistance with the given μ_r and η_r (–).
pub fn rolling(rolling_friction: f64, rolling_damping_ratio: f64) -> Box<dyn ContactStage> {
    stage(
        "rolling-resistance",
        &[("rolling_friction", rolling_friction), ("rolling_damping_ratio", rolling_damping_ratio)],
    )
}

/// The law called `name`, with SI values for all of its parameters.
///
/// # Panics
/// If there is no such law, or a value is missing.
pub fn stage(name: &str, values: &[(&'static str, f64)]) -> Box<dyn ContactStage> {
    let params: ParamTable = values.iter().copied().collect();
    (contact_laws::find(name).expect("the law is registered").build)(&params)
}

/// A bed of these grains; each is numbered by its place in the list.
pub fn bed(
    (space, container): (Space, Container),
    gravity: Vec3,
    grains: &[Grain],
    stages: Vec<Box<dyn ContactStage>>,
    n_intruder_parts: usize,
) -> GrainBed {
    let grains: Vec<Grain> =
        grains.iter().zip(0..).map(|(&grain, id)| Grain { id, ..grain }).collect();
    let resting = RestingBed::without_history(space, grains);
    GrainBed::new(&resting, container, gravity, stages, n_intruder_parts)
}

/// Discs without gravity, stepped by `dt` (s).
pub fn free(grains: &[Grain], stages: Vec<Box<dyn ContactStage>>, dt: f64) -> World {
    let bed = bed((Space::Planar, ROOM), Vec3::zeros(), grains, stages, 0);
    World::new(bed, Box::new(NoIntruder), dt)
}

/// One grain with the moment of inertia `inertia` m r² at rest on the floor, in equilibrium with the part of
/// `gravity` (m/s²) along z, in a room so wide that it may move for metres; then given `velocity` and `spin`.
pub fn on_floor(
    (space, inertia): (Space, f64),
    size: Size,
    (velocity, spin): (Vec3, Vec3),
    gravity: Vec3,
    (stages, stiffness): (Vec<Box<dyn ContactStage>>, f64),
    dt: f64,
) -> World {
    let sunk = -size.mass * gravity.z / stiffness;
    let position = Vec3::new(8.0, 8.0, size.radius - sunk);
    let position = if space == Space::Planar { Vec3::new(8.0, 0.0, position.z) } else { position };
    let grain = Grain { spin, ..size.grain(position, velocity) };
    let container = Container::walled_box(16.0, 16.0);
    let bed = bed((space, container), gravity, &[grain], stages, 0).with_grain_inertia(inertia);
    World::new(bed, Box::new(NoIntruder), dt)
}

/// Advances by `n` steps.
///
/// # Panics
/// If a step cannot be trusted: an experiment of a case never fails.
pub fn run(world: &mut World, n: usize) {
    for _ in 0..n {
        world.advance().expect("a sound step");
    }
}

/// Advances as long as `goes_on` says so.
///
/// # Panics
/// If a step cannot be trusted, or after `most` steps: an experiment of a law that is wrong fails, and does not run for ever.
pub fn run_while(world: &mut World, most: usize, mut goes_on: impl FnMut(&World) -> bool) {
    for _ in 0..most {
        if !goes_on(world) {
            return;
        }
        run(world, 1);
    }
    panic!("after {most} steps there is no end");
}

/// Deterministic numbers in [0, 1): the fractional parts of multiples of the golden ratio, which
/// fill the interval evenly however many are taken.
pub fn phase(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_894_9).fract()
}
