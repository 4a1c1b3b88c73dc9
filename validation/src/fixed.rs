//! Bodies that never move.

use engine::body::{Mechanism, Part, RigidBody};
use engine::contact::Partner;
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::surface::{Placement, Wrench};

/// Spheres held in their places, in the role of the intruder.
pub struct FixedSpheres(Vec<Part>);

impl FixedSpheres {
    /// Spheres of one `radius` (m) about these centres (m).
    ///
    /// # Panics
    /// If the sphere is not among the shapes.
    pub fn new(radius: f64, centres: &[Vec3]) -> Self {
        let params = ParamTable::from_iter([("diameter", 2.0 * radius)]);
        let shape = intruders::find("sphere").expect("the sphere is registered");
        let part = |&centre: &Vec3| Part {
            surface: (shape.build)(&params, Space::Spatial).surface,
            placement: Placement { position: centre, position_half: centre, ..Placement::fixed() },
            partner: Partner::Intruder,
        };
        Self(centres.iter().map(part).collect())
    }
}

impl Mechanism for FixedSpheres {
    fn kick_drift(&mut self, _: f64) {}

    fn kick(&mut self, _: f64) {}

    fn parts(&self) -> &[Part] {
        &self.0
    }

    fn load(&mut self, _: &[Wrench], _: Vec3) {}

    fn bodies(&self) -> &[RigidBody] {
        &[]
    }

    fn save(&self) -> Vec<f64> {
        Vec::new()
    }

    fn restore(&mut self, state: &[f64]) -> bool {
        state.is_empty()
    }
}
