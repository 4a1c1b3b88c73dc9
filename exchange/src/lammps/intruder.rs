//! The intruder among the atoms of LAMMPS: one atom, or a rigid clump of them.

use configs::GrainModel;
use engine::body::RigidBody;
use engine::math::Vec3;
use engine::simulation::Simulation;

use super::atom_type::INTRUDER;
use super::clump::{Ball, Clump};
use super::law::Law;

/// Balls whose springs are within this ratio of each other are of one type.
const RATIO: f64 = 1.05;

/// What LAMMPS is told of the intruder.
pub(super) struct Intruder {
    /// None of a disc or a sphere, which is one atom.
    pub(super) clump: Option<Clump>,
    /// Factors on the springs of Hertz and Mindlin, one for each atom type from [`INTRUDER`] on.
    pub(super) stiffness: Vec<f64>,
}

/// An atom of the intruder, body frame.
pub(super) struct Member {
    pub(super) kind: usize,
    /// From the centre of mass (m).
    pub(super) arm: Vec3,
    /// (m).
    pub(super) radius: f64,
}

impl Intruder {
    pub(super) fn of(model: GrainModel<'_>, simulation: &Simulation, law: &Law<'_>) -> Self {
        let body = body(simulation);
        if is_round(model) {
            return Self { clump: None, stiffness: vec![1.0] };
        }
        let grain = 0.5 * simulation.bed().grains.mean_diameter();
        let clump = Clump::of(body.surface(), model.medium.space, grain);
        let mut powers: Vec<i32> = match law.knows_curvature() {
            true => clump.balls.iter().map(|ball| power(ball, grain)).collect(),
            false => vec![0],
        };
        powers.sort_unstable();
        powers.dedup();
        let stiffness = powers.into_iter().map(|power| RATIO.powi(power)).collect();
        Self { clump: Some(clump), stiffness }
    }

    /// Its atoms, where the body of `simulation` is one.
    pub(super) fn members(&self, simulation: &Simulation) -> Vec<Member> {
        let Some(clump) = &self.clump else {
            let radius = body(simulation).surface().bounding_radius();
            return vec![Member { kind: INTRUDER, arm: Vec3::zeros(), radius }];
        };
        let members = clump.balls.iter().map(|ball| {
            let factor = RATIO.powi(power(ball, clump.grain));
            let class = self.stiffness.partition_point(|one| *one < factor);
            // Under a law that knows no curvature there is one class.
            let class = class.min(self.stiffness.len() - 1);
            Member { kind: INTRUDER + class, arm: ball.centre, radius: ball.radius }
        });
        members.collect()
    }

    /// The largest atom type.
    pub(super) fn last_kind(&self) -> usize {
        INTRUDER + self.stiffness.len() - 1
    }
}

/// The body that falls in `simulation`.
pub(super) fn body(simulation: &Simulation) -> &RigidBody {
    &simulation.intruder().bodies()[0]
}

fn is_round(model: GrainModel<'_>) -> bool {
    ["disc", "sphere"].contains(&model.model.intruder.shape.name)
}

/// What the springs of Hertz and Mindlin between `ball` and a grain of radius `grain` (m) have to
/// be multiplied with, as a power of [`RATIO`]: both go with √R*, and the body is flatter than its
/// balls.
fn power(ball: &Ball, grain: f64) -> i32 {
    let factor = ((1.0 / grain + 1.0 / ball.radius) / (1.0 / grain + ball.curvature)).sqrt();
    (libm::log(factor) / libm::log(RATIO)).round() as i32
}
