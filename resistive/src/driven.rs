//! A body on a drive that keeps its velocity, whatever the medium does.

use super::assembly::{Assembly, COORDINATES, PARTS, Part, PartLoad, State};
use super::error::ImpactError;
use super::impact::Impact;
use super::modes::{AXES, Modes, Sense};
use engine::math::Vec3;

/// An assembly of one part that moves along a straight line at constant speed: a plate, penetrometer or cone on an
/// actuator. The force of the medium along the way is what a run of it predicts.
pub struct Driven(Box<dyn Assembly>);

impl Driven {
    /// `assembly` with the velocity of its start.
    ///
    /// # Panics
    /// If it has more than one part.
    pub fn new(assembly: Box<dyn Assembly>) -> Self {
        assert_eq!(assembly.n_parts(), 1, "a drive moves one body");
        Self(assembly)
    }
}

impl Assembly for Driven {
    fn n_parts(&self) -> usize {
        self.0.n_parts()
    }

    fn part(&self, index: usize, state: &State) -> Part {
        self.0.part(index, state)
    }

    fn accelerate(&self, _: &State, _: &[PartLoad; PARTS], _: f64) -> [f64; COORDINATES] {
        [0.0; COORDINATES]
    }

    fn kinetic_energy(&self, index: usize, state: &State) -> [f64; 2] {
        self.0.kinetic_energy(index, state)
    }

    fn weight_at(&self, index: usize, state: &State) -> (f64, f64) {
        self.0.weight_at(index, state)
    }

    fn placement(&self, index: usize, state: &State) -> (Vec3, f64) {
        self.0.placement(index, state)
    }

    fn moves_as_a_point(&self) -> bool {
        self.0.moves_as_a_point()
    }

    fn ends_with_its_tips(&self) -> bool {
        self.0.ends_with_its_tips()
    }

    fn is_driven(&self) -> bool {
        true
    }
}

impl Impact {
    /// Force of the medium against the motion (N) on a body that has kept the velocity of its start until its lowest
    /// point is `depth` (m) below the surface.
    ///
    /// # Errors
    /// If a law gives no finite force there.
    pub fn resistance_at(&self, depth: f64) -> Result<f64, ImpactError> {
        let system = self.system();
        let start = self.assembly().part(0, self.start());
        let sinking = -start.tip_velocity.z;
        // A body that does not sink stays as deep as it starts.
        let time = if sinking > 0.0 { (depth - start.immersion.depth) / sinking } else { 0.0 };
        let mut state = *self.start();
        state.time += time;
        for (position, rate) in state.position.iter_mut().zip(state.rate) {
            *position += time * rate;
        }
        let velocity = self.assembly().part(0, &state).velocity;
        let mut modes = Modes {
            in_bed: [depth > 0.0; PARTS],
            straight: None,
            sense: [AXES.map(|axis| Sense::of(velocity[axis])); PARTS],
            gripping: false,
            creeping: false,
        };
        modes.gripping = system.loaded(0, &state, &modes).load.gripping;
        let loaded = system.loaded(0, &state, &modes);
        let force = -loaded.load.on_part(&loaded.motion).force.dot(&loaded.motion.direction);
        match force.is_finite() {
            true => Ok(force),
            false => Err(system.broken(Some(state), &modes, state.time)),
        }
    }
}
