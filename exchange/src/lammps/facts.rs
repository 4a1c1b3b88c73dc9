//! What an import needs to know that LAMMPS does not say.

use std::collections::BTreeMap;

use configs::{Condition, GrainModel};
use engine::bed::BedReport;
use engine::grain_bed::RestingBed;
use engine::grains::Space;
use engine::math::Vec3;
use engine::simulation::Simulation;
use runner::run::{BedSummary, ImpactSummary};
use serde::{Deserialize, Serialize};

use super::intruder::body;

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

/// The intruder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Intruder {
    pub(super) name: String,
    /// The registry's name of it.
    pub(super) shape: String,
    /// What the shape takes, in SI.
    pub(super) parameters: BTreeMap<String, f64>,
    pub(super) mass_kg: f64,
    /// About its principal axes.
    pub(super) inertia_kg_m2: [f64; 3],
    /// By which its axis leans from the vertical towards +x at the start.
    pub(super) attitude_rad: f64,
}

impl Facts {
    pub(super) fn of(
        model: GrainModel<'_>,
        resting: &RestingBed,
        condition: &Condition,
        simulation: &Simulation,
    ) -> Self {
        let GrainModel { model: whole, medium } = model;
        let body = body(simulation);
        Self {
            plunge_version: env!("CARGO_PKG_VERSION").to_owned(),
            name: whole.run.name.clone(),
            model_hash: whole.hash(),
            seed: whole.run.seed,
            impact: ImpactSummary::new(condition, model.start_x(condition)),
            dimension: if medium.space == Space::Planar { 2 } else { 3 },
            gravity_m_per_s2: medium.gravity,
            surface_m: simulation.surface(),
            container_m: [medium.container.width, medium.container.depth],
            time_step_s: simulation.clock().dt,
            impact_energy: simulation.impact_energy(),
            intruder: Intruder {
                name: body.name.clone(),
                shape: whole.intruder.shape.name.to_owned(),
                parameters: (whole.intruder.params.iter())
                    .map(|(key, value)| (key.to_owned(), value))
                    .collect(),
                mass_kg: body.mass,
                inertia_kg_m2: body.inertia.into(),
                attitude_rad: 2.0 * libm::atan2(body.orientation.j, body.orientation.w),
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
}
