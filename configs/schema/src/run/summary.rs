//! What a run comes to: the keys of `summary.json`.

use std::collections::BTreeMap;

use engine::bed::BedReport;
use engine::ledger::{ChannelKind, TermKind};
use engine::simulation::Simulation;
use serde::{Deserialize, Serialize};

use crate::model::{Condition, Model};

/// `summary.json` of one impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct Summary {
    pub name: String,
    pub version: String,
    pub model_hash: String,
    pub medium: String,
    pub impact: ImpactSummary,
    pub stop: StopSummary,
    pub energy: EnergySummary,
    pub bed: BedSummary,
    pub cost: CostSummary,
}

/// The impact as it was started.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct ImpactSummary {
    pub speed_m_per_s: f64,
    pub angle_deg: f64,
    pub x_m: f64,
    pub position_index: usize,
}

/// When and where the intruder stopped; a time that was not reached is null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct StopSummary {
    pub stopped: bool,
    pub stopping_time_s: Option<f64>,
    pub stopping_time_z_s: Option<f64>,
    pub stopping_time_x_s: Option<f64>,
    pub rest_time_s: Option<f64>,
    pub depth_m: f64,
    pub range_m: f64,
}

/// Where the energy went: `initial` is `final` plus what was dissipated, less what was put in and what
/// is unaccounted for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct EnergySummary {
    #[serde(rename = "initial_J")]
    pub initial: f64,
    #[serde(rename = "final")]
    pub at_end: FinalEnergy,
    /// By channel, `snake_case`.
    #[serde(rename = "dissipated_J")]
    pub dissipated: BTreeMap<String, f64>,
    /// By channel, `snake_case`; left out if no law puts energy in.
    #[serde(rename = "input_J", skip_serializing_if = "BTreeMap::is_empty", default)]
    pub input: BTreeMap<String, f64>,
    #[serde(rename = "unaccounted_J")]
    pub unaccounted: f64,
    pub closure: f64,
}

/// What is still there at the end. Potential energy and everything of the bed count from the start of
/// the impact: the springs of a bed at rest hold energy that is not the intruder's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct FinalEnergy {
    #[serde(rename = "intruder_J")]
    pub intruder: f64,
    #[serde(rename = "grains_J")]
    pub grains: f64,
    #[serde(rename = "elastic_J")]
    pub elastic: f64,
}

/// The bed before the impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct BedSummary {
    pub grains: usize,
    pub packing_fraction: f64,
    pub packing_fraction_inside: Option<f64>,
    pub height_m: f64,
    pub coordination: f64,
    pub cache: String,
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub warnings: Vec<String>,
}

/// What it cost; the only part of a summary that depends on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct CostSummary {
    pub steps: u64,
    pub dt_s: f64,
    pub threads: usize,
    pub wall_s: f64,
    pub grain_steps_per_s: f64,
}

impl FinalEnergy {
    /// What the ledger of `simulation` holds now, the intruder's kinetic and potential energy, and the
    /// bed's.
    pub(super) fn held_by(simulation: &Simulation) -> Self {
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
    pub fn new(report: &BedReport, cache: &str, model: &Model) -> Self {
        Self {
            grains: report.grains,
            packing_fraction: report.packing_fraction,
            packing_fraction_inside: report.packing_fraction_inside,
            height_m: report.height,
            coordination: report.coordination,
            cache: cache.to_owned(),
            warnings: off_target(report, model),
        }
    }
}

/// By how much a packing fraction may miss its target.
const PACKING_FRACTION_TOLERANCE: f64 = 0.01;

/// What the bed misses of the model's targets: more than 0.01 in the packing fraction, or one mean
/// grain diameter in height.
fn off_target(report: &BedReport, model: &Model) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(target) = model.bed.target_packing_fraction {
        let found = report.packing_fraction;
        if (found - target).abs() > PACKING_FRACTION_TOLERANCE {
            warnings.push(format!(
                "the packing fraction is {found:.3}, not {target} ± {PACKING_FRACTION_TOLERANCE}"
            ));
        }
    }
    if let Some(target) = model.bed.target_height {
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
    pub(super) fn new(
        model: &Model,
        condition: &Condition,
        simulation: &Simulation,
        start: &FinalEnergy,
        bed: &BedSummary,
        cost: CostSummary,
    ) -> Self {
        let stop = simulation.stopping();
        let ledger = simulation.ledger();
        let by_channel = |kind| {
            let terms = ledger.terms().iter().zip(&ledger.balance().values);
            terms
                .filter(|(term, _)| term.kind == TermKind::Channel(kind))
                .map(|(term, value)| (term.name.replace('-', "_"), *value))
                .collect()
        };
        let end = FinalEnergy::held_by(simulation);
        let initial = simulation.impact_energy();
        Self {
            name: model.run.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: model.hash(),
            medium: "grains".to_owned(),
            impact: ImpactSummary {
                speed_m_per_s: condition.speed,
                angle_deg: condition.angle_deg(),
                x_m: model.start_x(condition),
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
                dissipated: by_channel(ChannelKind::Dissipated),
                input: by_channel(ChannelKind::Input),
                unaccounted: ledger.balance().unaccounted,
                closure: simulation.closure(),
            },
            bed: bed.clone(),
            cost,
        }
    }
}

/// `summary.json` of a list of conditions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct ListSummary {
    pub name: String,
    pub version: String,
    pub model_hash: String,
    pub medium: String,
    pub runs: Vec<Summary>,
    pub groups: Vec<Group>,
}

/// All positions of one speed and angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys carry their units and are documented in the README")]
pub struct Group {
    pub speed_m_per_s: f64,
    pub angle_deg: f64,
    pub n: usize,
    pub depth_m: Scatter,
    pub range_m: Scatter,
    pub stopping_time_s: Scatter,
    pub rest_time_s: Scatter,
    pub closure: Scatter,
}

/// Mean and standard deviation over the `n` runs that reached the quantity; null where too few did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the keys say what they are")]
pub struct Scatter {
    pub n: usize,
    pub mean: Option<f64>,
    pub sd: Option<f64>,
}

impl Scatter {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Self {
            n: values.len(),
            mean: (!values.is_empty()).then_some(mean),
            sd: (values.len() > 1).then(|| (squares / (n - 1.0)).sqrt()),
        }
    }
}

impl ListSummary {
    /// The summaries of all conditions of `model`, in order.
    #[must_use]
    pub fn new(model: &Model, runs: Vec<Summary>) -> Self {
        let mut groups: Vec<(f64, f64, Vec<&Summary>)> = Vec::new();
        for run in &runs {
            let (speed, angle) = (run.impact.speed_m_per_s, run.impact.angle_deg);
            let same = |group: &&mut (f64, f64, Vec<&Summary>)| {
                group.0.to_bits() == speed.to_bits() && group.1.to_bits() == angle.to_bits()
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.2.push(run),
                None => groups.push((speed, angle, vec![run])),
            }
        }
        let groups = groups
            .into_iter()
            .map(|(speed, angle, members)| {
                let each = |value: fn(&Summary) -> Option<f64>| {
                    Scatter::of(&members.iter().filter_map(|run| value(run)).collect::<Vec<_>>())
                };
                Group {
                    speed_m_per_s: speed,
                    angle_deg: angle,
                    n: members.len(),
                    depth_m: each(|run| Some(run.stop.depth_m)),
                    range_m: each(|run| Some(run.stop.range_m)),
                    stopping_time_s: each(|run| run.stop.stopping_time_s),
                    rest_time_s: each(|run| run.stop.rest_time_s),
                    closure: each(|run| Some(run.energy.closure)),
                }
            })
            .collect();
        Self {
            name: model.run.name.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: model.hash(),
            medium: "grains".to_owned(),
            groups,
            runs,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_the_sample_standard_deviation() {
        let scatter = Scatter::of(&[1.0, 2.0, 3.0, 6.0]);
        assert_eq!(scatter.mean, Some(3.0));
        assert!((scatter.sd.unwrap() - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Scatter::of(&[]), Scatter { n: 0, mean: None, sd: None });
        assert_eq!(Scatter::of(&[4.0]), Scatter { n: 1, mean: Some(4.0), sd: None });
    }
}
