//! A body on a drive that keeps its velocity, whatever the medium does.

use super::assembly::{Assembly, COORDINATES, PARTS, Part, PartLoad, State};
use engine::math::Vec3;

/// An assembly of one part that moves along a straight line at constant speed: a plate, penetrometer or cone on an
/// actuator. The force of the medium along the way is what a run of it predicts.
pub struct Driven(Box<dyn Assembly>);

impl Driven {
    /// `assembly` with the velocity of its start.
    ///
    /// # Panics
    /// If it has more than one part.
    #[must_use]
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
