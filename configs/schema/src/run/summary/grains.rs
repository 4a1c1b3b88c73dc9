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
            required_depth_m: required_depth(model),
            cache: cache.to_owned(),
            activity: None,
            warnings: off_target(report, model)
                .into_iter()
                .chain(too_shallow(report, model))
                .collect(),
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

/// κ of [`required_depth`]: 0.42 to 0.8 for granular materials.
const DEPTH_COEFFICIENT: f64 = 0.6;

/// How deep (m) the shock of the fastest impact reaches, D = κ √(M H/10³), with the mass M in kg and the
/// height of fall H = v²/2g in m; `None` without gravity.
///
/// Source: three-shape study, eq. 5, a rule of dynamic compaction. At laboratory masses it asks for
/// millimetres, so it is no more than a first bound.
fn required_depth(model: GrainModel<'_>) -> Option<f64> {
    let impacts = model.model.conditions();
    let speed = impacts.iter().fold(0.0_f64, |speed, impact| speed.max(impact.speed));
    let gravity = model.medium.gravity;
    let height = speed * speed / (2.0 * gravity);
    (gravity > 0.0).then(|| DEPTH_COEFFICIENT * (model.model.intruder.mass * height / 1e3).sqrt())
}

fn too_shallow(report: &BedReport, model: GrainModel<'_>) -> Option<String> {
    let required = required_depth(model).filter(|required| report.height < *required)?;
    Some(format!(
        "the bed is {:.4} m deep; for this impact {required:.4} m are wanted",
        report.height
    ))
}

/// Mean grain diameters that are left below an intruder that the floor has not stopped.
const GRAINS_BELOW: f64 = 5.0;

/// What to say of an intruder that ended `left` (m) above the floor, where that is less than five mean
/// grain diameters or half its own.
pub(in crate::run) fn near_the_floor(
    left: f64,
    mean_grain_diameter: f64,
    intruder_diameter: f64,
) -> Option<String> {
    let wanted = (GRAINS_BELOW * mean_grain_diameter).max(0.5 * intruder_diameter);
    (left < wanted).then(|| {
        format!(
            "the intruder ended {left:.4} m above the floor, which is felt from about {wanted:.4} m; \
             a deeper bed is wanted"
        )
    })
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
