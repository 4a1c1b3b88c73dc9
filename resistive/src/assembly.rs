//! What falls: parts that the medium acts on, and how they move under that.

use std::sync::Arc;

use super::Immersion;
use super::silhouette::Silhouette;
use engine::math::Vec3;

/// Most coordinates of an assembly.
pub const COORDINATES: usize = 4;

/// Most parts of an assembly.
pub const PARTS: usize = 2;

/// Coordinates and their rates; what an assembly does not need stays zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// (m or rad).
    pub position: [f64; COORDINATES],
    /// (m/s or rad/s).
    pub rate: [f64; COORDINATES],
    /// Since the start (s).
    pub time: f64,
}

/// One immersed part at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// How far it is in the medium.
    pub immersion: Immersion,
    /// Velocity of the point of application (m/s).
    pub velocity: Vec3,
    /// Angular velocity about y (rad/s).
    pub spin: f64,
    /// Its lowest point (m).
    pub tip: Vec3,
    /// Velocity of the body there (m/s).
    pub tip_velocity: Vec3,
    /// Where loads act (m).
    pub point: Vec3,
}

/// What acts on a part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartLoad {
    /// At the point of application (N).
    pub force: Vec3,
    /// About y (N m).
    pub couple: f64,
    /// Moves with the point of application (kg).
    pub added_mass: f64,
}

/// Bodies with at most [`COORDINATES`] planar coordinates and [`PARTS`] parts.
pub trait Assembly: Send + Sync {
    /// How many parts.
    fn n_parts(&self) -> usize;

    /// Part `index`.
    fn part(&self, index: usize, state: &State) -> Part;

    /// Accelerations of the coordinates under gravity (m/s², downward) and the loads of the parts.
    /// They are affine in the forces.
    fn accelerate(
        &self,
        state: &State,
        loads: &[PartLoad; PARTS],
        gravity: f64,
    ) -> [f64; COORDINATES];

    /// Kinetic energy of part `index` (J), of translation and of rotation.
    fn kinetic_energy(&self, index: usize, state: &State) -> [f64; 2];

    /// Height of the centre of mass of part `index` above the undisturbed surface (m), and its mass
    /// (kg).
    fn weight_at(&self, index: usize, state: &State) -> (f64, f64);

    /// Where part `index` is drawn: the centre of its shape (m) and its rotation about y (rad).
    fn placement(&self, index: usize, state: &State) -> (Vec3, f64);

    /// Whether it is one part whose point of application moves as the first two coordinates do, x and
    /// z.
    fn moves_as_a_point(&self) -> bool {
        false
    }

    /// Whether a drive keeps its velocity, which does what work that takes.
    fn is_driven(&self) -> bool {
        false
    }

    /// Whether an impact of it is over when every tip has stopped sinking; else when it is at rest.
    fn ends_with_its_tips(&self) -> bool {
        false
    }
}

/// A compact body that keeps its attitude: the medium acts on its centre of mass.
///
/// Coordinates: x and z of the lowest point, and the angle it has turned about y by its spin, which
/// shows in no force but those that ask for the spin.
pub struct Compact {
    silhouette: Arc<dyn Silhouette>,
    /// Of the silhouette, which are asked for at every evaluation of a force (m; m², planar m; m³, planar m²).
    diameter: f64,
    frontal_area: f64,
    volume: f64,
    /// Of the lowest point below the centre of the shape (m).
    reach: f64,
    mass: f64,
    inertia: f64,
}

impl Compact {
    /// A body of `mass` (kg) and moment of `inertia` about y (kg m²), whose centre is `reach` (m)
    /// above its lowest point.
    pub fn new(silhouette: Arc<dyn Silhouette>, reach: f64, mass: f64, inertia: f64) -> Self {
        let (diameter, frontal_area) = (silhouette.diameter(), silhouette.frontal_area());
        let volume = silhouette.volume(silhouette.height());
        Self { silhouette, diameter, frontal_area, volume, reach, mass, inertia }
    }

    /// The state with the lowest point at the surface at x = 0, moving with `velocity` (m/s) and
    /// turning with `spin` about y (rad/s).
    pub fn at_surface(velocity: Vec3, spin: f64) -> State {
        State { rate: [velocity.x, velocity.z, spin, 0.0], ..State::default() }
    }
}

impl Assembly for Compact {
    fn n_parts(&self) -> usize {
        1
    }

    fn moves_as_a_point(&self) -> bool {
        true
    }

    fn part(&self, _: usize, state: &State) -> Part {
        let [x, z, _, _] = state.position;
        let [vx, vz, spin, _] = state.rate;
        let shape = &*self.silhouette;
        let frontal_area = self.frontal_area;
        // Not `-z`: at contact the depth is 0, not −0.
        let depth = 0.0 - z;
        let below = depth.max(0.0);
        let velocity = Vec3::new(vx, 0.0, vz);
        let section = shape.section(below);
        let tip = Vec3::new(x, 0.0, z);
        Part {
            immersion: Immersion {
                depth,
                diameter: self.diameter,
                frontal_area,
                immersed_area: shape.immersed_area(below),
                reference_area: frontal_area,
                end_area: 0.0,
                volume: shape.volume(below),
                section,
                volume_rate: -section * vz,
                body_volume: self.volume,
                mass: self.mass,
                effective_depth: below,
                loaded_area: frontal_area,
                drag_factor: 1.0,
                friction_factor: 1.0,
                sideways_drag: 1.0,
                sideways_friction: 1.0,
            },
            velocity,
            spin,
            tip,
            tip_velocity: velocity,
            point: Vec3::new(x, 0.0, z + self.reach),
        }
    }

    fn accelerate(&self, _: &State, loads: &[PartLoad; PARTS], gravity: f64) -> [f64; COORDINATES] {
        let load = &loads[0];
        let mass = self.mass + load.added_mass;
        [
            load.force.x / mass,
            (load.force.z - self.mass * gravity) / mass,
            load.couple / self.inertia,
            0.0,
        ]
    }

    fn kinetic_energy(&self, _: usize, state: &State) -> [f64; 2] {
        let [vx, vz, spin, _] = state.rate;
        [0.5 * self.mass * (vx * vx + vz * vz), 0.5 * self.inertia * spin * spin]
    }

    fn weight_at(&self, _: usize, state: &State) -> (f64, f64) {
        (state.position[1] + self.reach, self.mass)
    }

    fn placement(&self, _: usize, state: &State) -> (Vec3, f64) {
        let [x, z, turned, _] = state.position;
        (Vec3::new(x, 0.0, z + self.reach), turned)
    }
}
