//! The summary of an impact on a bed of grains.

use configs::{BedSource, Condition, GrainModel};
use engine::bed::BedReport;
use engine::body::RigidBody;
use engine::course::Course;
use engine::ledger::{ChannelKind, TermKind};
use engine::simulation::Simulation;
use engine::stopping::Stopping;

use crate::run::intrusion::Push;

use super::resistive::LinkCourse;
use super::{
    ActivitySummary, BedSummary, CostSummary, DRIVE, EnergySummary, FinalEnergy, ImpactSummary,
    LinkSummary, StopSummary, Summary, by_channel,
};

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
            elastic: Some(ledger.sum(|term| term.kind == TermKind::Channel(ChannelKind::Stored))),
        }
    }
}

impl BedSummary {
    /// The bed as `report` has it; `cache` says where it came from.
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
            let settles = matches!(model.medium.bed.source, BedSource::Settle(_));
            let advice = match found > target && settles {
                true => "; a higher preparation_friction makes it looser",
                false => "",
            };
            warnings.push(format!(
                "the packing fraction is {found:.3}, not {target} ± \
                 {PACKING_FRACTION_TOLERANCE}{advice}"
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
/// Source: three-shape manuscript, eq. 5, a rule of dynamic compaction. At laboratory masses it asks for
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
    Some(format!("the bed is {:.4} m deep; this impact needs {required:.4} m", report.height))
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
             use a deeper bed"
        )
    })
}

/// When the intruder stopped. Of a chain, from the first contact of any link to the last stop of any.
fn stop(simulation: &Simulation) -> StopSummary {
    let courses = simulation.courses();
    let first = courses.iter().filter_map(Course::contact).reduce(f64::min).unwrap_or(0.0);
    let latest = |time: fn(&Stopping) -> Option<f64>| {
        let times = courses.iter().map(|course| time(course.stopping()));
        times.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
    };
    // What a chain does not have at its start stays zero.
    let after = |time: Option<f64>| time.map(|time| if time > 0.0 { time - first } else { 0.0 });
    let largest = |of: fn(&Stopping) -> f64| {
        courses.iter().map(|course| of(course.stopping())).fold(f64::NEG_INFINITY, f64::max)
    };
    let stopping_time = after(latest(Stopping::stopping_time));
    StopSummary {
        stopped: stopping_time.is_some(),
        stopping_time_s: stopping_time,
        stopping_time_z_s: after(latest(Stopping::vertical_time)),
        stopping_time_x_s: after(latest(Stopping::horizontal_time)),
        rest_time_s: after(latest(Stopping::rest_time)),
        depth_m: largest(Stopping::depth),
        range_m: largest(Stopping::range),
    }
}

/// Every link of a chain; nothing for an intruder of one body.
fn links(simulation: &Simulation) -> Vec<LinkSummary> {
    let (courses, bodies) = (simulation.courses(), simulation.intruder().bodies());
    if courses.len() == 1 {
        return Vec::new();
    }
    let all: f64 = courses.iter().map(Course::given).sum();
    let link = |(course, body): (&Course, &RigidBody)| {
        let stopping = course.stopping();
        LinkSummary::new(LinkCourse {
            contact: course.contact(),
            stop: stopping.stopping_time(),
            depth: stopping.depth(),
            given: course.given(),
            given_by_all: all,
            lost: course.lost(body),
        })
    };
    courses.iter().zip(bodies).map(link).collect()
}

impl Summary {
    /// The impact `condition` of `grains`, at its end.
    pub(in crate::run) fn of_grains(
        grains: GrainModel<'_>,
        condition: &Condition,
        simulation: &Simulation,
        start: &FinalEnergy,
        (bed, push): (&BedSummary, Option<&Push>),
        cost: CostSummary,
    ) -> Self {
        let model = grains.model;
        let ledger = simulation.ledger();
        let end = FinalEnergy::held_by(simulation);
        let initial = simulation.impact_energy();
        let input = by_channel(ledger, ChannelKind::Input);
        let work = input.get(DRIVE).copied().unwrap_or(0.0);
        let intrusion = push.map(|push| push.summary(work));
        let mut stop = stop(simulation);
        if let Some(intrusion) = &intrusion {
            stop.stopped = intrusion.is_complete(stop.depth_m);
        }
        let kinetic = ["kinetic_intruder_translation_J", "kinetic_intruder_rotation_J"]
            .map(|term| ledger.value(term).unwrap_or(0.0));
        // Its kinetic energy at the start is the energy of the impact.
        let intruder = end.intruder - (start.intruder - initial);
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
            impact: ImpactSummary::new(condition, grains.start_x(condition)),
            stop,
            energy: EnergySummary {
                initial,
                at_end: FinalEnergy {
                    intruder,
                    grains: end.grains - start.grains,
                    elastic: end.elastic.zip(start.elastic).map(|(end, start)| end - start),
                },
                dissipated: by_channel(ledger, ChannelKind::Dissipated),
                input,
                released: Some(kinetic[0] + kinetic[1] - intruder),
                unaccounted: Some(ledger.balance().unaccounted),
                closure: Some(simulation.closure()),
            },
            bed: Some(BedSummary {
                activity: Some(activity),
                required_depth_m: required_depth(grains),
                ..bed.clone()
            }),
            forces: None,
            intrusion,
            links: links(simulation),
            cost,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_is_near_within_five_grains_or_half_the_intruder() {
        // Grains of 4 mm: 20 mm; an intruder of 60 mm: 30 mm.
        assert!(near_the_floor(0.019, 4e-3, 0.02).is_some());
        assert!(near_the_floor(0.021, 4e-3, 0.02).is_none());
        assert!(near_the_floor(0.029, 4e-3, 0.06).is_some_and(|text| text.contains("0.0300 m")));
        assert!(near_the_floor(0.031, 4e-3, 0.06).is_none());
    }
}
