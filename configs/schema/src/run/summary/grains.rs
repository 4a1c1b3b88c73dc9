//! The summary of an impact on a bed of grains.

use engine::bed::BedReport;
use engine::ledger::{ChannelKind, TermKind};
use engine::simulation::Simulation;

use super::{
    ActivitySummary, BedSummary, CostSummary, EnergySummary, FinalEnergy, ImpactSummary,
    StopSummary, Summary, by_channel,
};
use crate::model::{Condition, GrainModel};

impl FinalEnergy {
    /// What the ledger of `simulation` holds now, the intruder's kinetic and potential energy, and the
    /// bed's.
    pub(in crate::run) fn held_by(simulation: &Simulation) -> Self {
        let ledger = simulation.ledger();
        let value = |key| ledger.value(key).unwrap_or(0.0);
        Self {
            intruder: value("kinetic_intruder_translation_J")
                + value("kinetic_intruder_rotation_J")
                + value("potential_intruder_J"),
            grains: value("kinetic_grains_translation_J")
                + value("kinetic_grains_rotation_J")
                + value("potential_grains_J"),
            elastic: ledger.sum(|term| term.kind == TermKind::Channel(ChannelKind::Stored)),
        }
    }
}

impl BedSummary {
    /// The bed as `report` has it; `cache` says where it came from.
    #[must_use]
    pub fn new(report: &BedReport, cache: &str, model: GrainModel<'_>) -> Self {
        Self {
            grains: report.grains,
            packing_fraction: report.packing_fraction,
            packing_fraction_inside: report.packing_fraction_inside,
            height_m: report.height,
            coordination: report.coordination,
            cache: cache.to_owned(),
            activity: None,
            warnings: off_target(report, model),
        }
    }
}

/// By how much a packing fraction may miss its target.
const PACKING_FRACTION_TOLERANCE: f64 = 0.01;

/// What the bed misses of the model's targets: more than 0.01 in the packing fraction, or one mean
/// grain diameter in height.
fn off_target(report: &BedReport, model: GrainModel<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(target) = model.medium.bed.target_packing_fraction {
        let found = report.packing_fraction;
        if (found - target).abs() > PACKING_FRACTION_TOLERANCE {
            warnings.push(format!(
                "the packing fraction is {found:.3}, not {target} ± {PACKING_FRACTION_TOLERANCE}"
            ));
        }
    }
    if let Some(target) = model.medium.bed.target_height {
        let (found, diameter) = (report.height, report.mean_diameter);
        if (found - target).abs() > diameter {
            warnings.push(format!(
                "the bed is {:.1} mean grain diameters high, not {:.1} ± 1",
                found / diameter,
                target / diameter
            ));
        }
    }
    warnings
}

impl Summary {
    /// The impact `condition` of `grains`, at its end.
    pub(in crate::run) fn of_grains(
        grains: GrainModel<'_>,
        condition: &Condition,
        simulation: &Simulation,
        start: &FinalEnergy,
        bed: &BedSummary,
        cost: CostSummary,
    ) -> Self {
        let model = grains.model;
        let stop = simulation.stopping();
        let ledger = simulation.ledger();
        let end = FinalEnergy::held_by(simulation);
        let initial = simulation.impact_energy();
        let activity = simulation.activity();
        let activity = ActivitySummary {
            largest_moving_share: activity.largest_share(),
            largest_kinetic_energy: activity.largest_energy(),
            peak_time_s: activity.peak_time(),
            dissipation_time_s: activity.dissipation_time(),
        };
        Self {
            name: model.run.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: model.hash(),
            medium: model.medium.kind().to_owned(),
            impact: ImpactSummary {
                speed_m_per_s: condition.speed,
                angle_deg: condition.angle_deg(),
                x_m: grains.start_x(condition),
                position_index: condition.position_index,
            },
            stop: StopSummary {
                stopped: stop.stopping_time().is_some(),
                stopping_time_s: stop.stopping_time(),
                stopping_time_z_s: stop.vertical_time(),
                stopping_time_x_s: stop.horizontal_time(),
                rest_time_s: stop.rest_time(),
                depth_m: stop.depth(),
                range_m: stop.range(),
            },
            energy: EnergySummary {
                initial,
                at_end: FinalEnergy {
                    // Its kinetic energy at the start is the energy of the impact.
                    intruder: end.intruder - (start.intruder - initial),
                    grains: end.grains - start.grains,
                    elastic: end.elastic - start.elastic,
                },
                dissipated: by_channel(ledger, ChannelKind::Dissipated),
                input: by_channel(ledger, ChannelKind::Input),
                unaccounted: ledger.balance().unaccounted,
                closure: simulation.closure(),
            },
            bed: Some(BedSummary { activity: Some(activity), ..bed.clone() }),
            forces: None,
            links: Vec::new(),
            cost,
        }
    }
}
