//! What an import needs to know that LAMMPS does not say.

use configs::engine::bed::BedReport;
use configs::engine::grain_bed::RestingBed;
use configs::engine::grains::Space;
use configs::engine::math::Vec3;
use configs::engine::record::BodySample;
use configs::engine::simulation::Simulation;
use configs::engine::stopping::Followed;
use configs::run::{BedSummary, ImpactSummary};
use configs::{Condition, GrainModel};
use serde::{Deserialize, Serialize};

use super::data::intruder_radius;
use super::samples::Sample;

/// The energies that are known of a run of LAMMPS, as plunge calls them.
pub(super) const ENERGIES: [&str; 6] = [
    "kinetic_intruder_translation_J",
    "kinetic_intruder_rotation_J",
    "kinetic_grains_translation_J",
    "kinetic_grains_rotation_J",
    "potential_intruder_J",
    "potential_grains_J",
];

/// The content of [`FACTS`](super::FACTS): the impact, as plunge would log it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Facts {
    pub(super) plunge_version: String,
    pub(super) name: String,
    pub(super) model_hash: String,
    pub(super) seed: u64,
    pub(super) impact: ImpactSummary,
    /// 2 or 3.
    pub(super) dimension: usize,
    pub(super) gravity_m_per_s2: f64,
    /// Height of the undisturbed surface.
    pub(super) surface_m: f64,
    /// Width and depth.
    pub(super) container_m: [f64; 2],
    pub(super) time_step_s: f64,
    #[serde(rename = "impact_energy_J")]
    pub(super) impact_energy: f64,
    pub(super) intruder: Intruder,
    pub(super) bed: BedSummary,
    /// The resolved model, in TOML.
    pub(super) model: String,
}

/// The intruder, a disc or a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Intruder {
    pub(super) name: String,
    pub(super) radius_m: f64,
    pub(super) mass_kg: f64,
    /// About its centre; of a disc, about its axis.
    pub(super) inertia_kg_m2: f64,
}

impl Facts {
    pub(super) fn of(
        model: GrainModel<'_>,
        resting: &RestingBed,
        condition: &Condition,
        simulation: &Simulation,
    ) -> Self {
        let GrainModel { model: whole, medium } = model;
        let body = &simulation.intruder().bodies()[0];
        Self {
            plunge_version: env!("CARGO_PKG_VERSION").to_owned(),
            name: whole.run.name.clone(),
            model_hash: whole.hash(),
            seed: whole.run.seed,
            impact: ImpactSummary {
                speed_m_per_s: condition.speed,
                angle_deg: condition.angle_deg(),
                x_m: model.start_x(condition),
                position_index: condition.position_index,
            },
            dimension: if medium.space == Space::Planar { 2 } else { 3 },
            gravity_m_per_s2: medium.gravity,
            surface_m: simulation.surface(),
            container_m: [medium.container.width, medium.container.depth],
            time_step_s: simulation.clock().dt,
            impact_energy: simulation.impact_energy(),
            intruder: Intruder {
                name: body.name.clone(),
                radius_m: intruder_radius(simulation),
                mass_kg: body.mass,
                // The axis of a disc is y; a sphere has the same about every axis.
                inertia_kg_m2: body.inertia.y,
            },
            bed: BedSummary::new(&BedReport::of(&model.bed(resting)), "export", model),
            model: whole.resolved_toml().to_owned(),
        }
    }

    pub(super) fn space(&self) -> Space {
        if self.dimension == 2 { Space::Planar } else { Space::Spatial }
    }

    /// Of the intruder (N).
    pub(super) fn weight(&self) -> Vec3 {
        Vec3::new(0.0, 0.0, -self.intruder.mass_kg * self.gravity_m_per_s2)
    }

    pub(super) fn state(&self, sample: &Sample) -> BodySample {
        let Sample { position, velocity, spin, .. } = *sample;
        let depth_m = self.surface_m - (position.z - self.intruder.radius_m);
        BodySample { position, velocity, spin, depth_m }
    }

    pub(super) fn followed(&self, sample: &Sample) -> Followed {
        let Sample { position, velocity, .. } = *sample;
        Followed { position, velocity, reach: self.intruder.radius_m }
    }

    /// What is known of the energies, in the order of [`ENERGIES`] (J).
    pub(super) fn energies(&self, sample: &Sample) -> [f64; 6] {
        let [translation, rotation, height] = sample.energies;
        let Intruder { mass_kg: mass, inertia_kg_m2: inertia, .. } = self.intruder;
        [
            0.5 * mass * sample.velocity.norm_squared(),
            0.5 * inertia * sample.spin.norm_squared(),
            translation,
            rotation,
            mass * self.gravity_m_per_s2 * sample.position.z,
            height,
        ]
    }
}
