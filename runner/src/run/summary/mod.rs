//! What a run comes to: the keys of `summary.json`.

mod grains;
mod list;
mod resistive;
mod shares;

use std::collections::BTreeMap;

use configs::Condition;
use engine::ledger::{ChannelKind, Ledger, TermKind};
use serde::{Deserialize, Serialize};

pub(super) use grains::near_the_floor;
pub use list::{Group, ListSummary, Scatter};
pub(super) use resistive::Watched;
pub use resistive::{ForceSummary, LinkSummary};
pub use shares::EnergyShares;

/// `summary.json` of one impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Of the model.
    pub name: String,
    /// Of the program that ran it.
    pub version: String,
    /// Of the resolved model, in hexadecimal.
    pub model_hash: String,
    /// `grains` or `resistive-force`.
    pub medium: String,
    /// How it began.
    pub impact: ImpactSummary,
    /// How it ended.
    pub stop: StopSummary,
    /// Where the energy went.
    pub energy: EnergySummary,
    /// Of a bed of grains.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub bed: Option<BedSummary>,
    /// Of a resistive force.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub forces: Option<ForceSummary>,
    /// Of an intruder that a drive pushes.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub intrusion: Option<IntrusionSummary>,
    /// Of a chain, from its first link.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub links: Vec<LinkSummary>,
    /// What it cost.
    pub cost: CostSummary,
}

/// The impact as it was started.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImpactSummary {
    /// Speed at contact (m/s).
    pub speed_m_per_s: f64,
    /// Angle of the velocity below the horizontal (deg).
    pub angle_deg: f64,
    /// Where the intruder starts along the bed (m).
    pub x_m: f64,
    /// Place of this start among those of the same speed and angle.
    pub position_index: usize,
}

impl ImpactSummary {
    /// Of `condition`, which starts at `x` along the bed (m).
    pub fn new(condition: &Condition, x: f64) -> Self {
        Self {
            speed_m_per_s: condition.speed,
            angle_deg: condition.angle_deg(),
            x_m: x,
            position_index: condition.position_index,
        }
    }
}

/// The force along the way of a push: means over equal parts of the depth, from the surface down. `torque_y` is
/// about the centre of mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IntrusionSummary {
    /// Depth at which the push ends (m).
    pub to_depth_m: f64,
    /// Of the drive, against the bed and the weight.
    #[serde(rename = "work_J")]
    pub work: f64,
    /// Middle of each part (m).
    pub depth_m: Vec<f64>,
    /// Force along the surface, by part (N).
    #[serde(rename = "force_x_N")]
    pub force_x: Vec<f64>,
    /// Force upwards, by part (N).
    #[serde(rename = "force_z_N")]
    pub force_z: Vec<f64>,
    /// Torque about the horizontal axis across the motion, by part (N m).
    #[serde(rename = "torque_y_Nm")]
    pub torque_y: Vec<f64>,
}

/// When and where the intruder stopped; a time that was not reached is null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StopSummary {
    /// Whether every component of the velocity came to zero.
    pub stopped: bool,
    /// Later of the first zeros of the velocity components, from first contact (s).
    pub stopping_time_s: Option<f64>,
    /// First zero of the vertical velocity, from first contact (s).
    pub stopping_time_z_s: Option<f64>,
    /// First zero of the horizontal velocity, from first contact (s).
    pub stopping_time_x_s: Option<f64>,
    /// Since when the speed stays below 5 % of the greatest, from first contact (s).
    pub rest_time_s: Option<f64>,
    /// Largest depth of the lowest point up to the stop (m).
    pub depth_m: f64,
    /// Horizontal distance up to the stop (m).
    pub range_m: f64,
}

/// Where the energy went: `initial` is `final` plus what was dissipated, less what was put in and what
/// is unaccounted for. What another program does not tell of an imported run is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergySummary {
    /// At the start of the impact (J).
    #[serde(rename = "initial_J")]
    pub initial: f64,
    /// What is still there.
    #[serde(rename = "final")]
    pub at_end: FinalEnergy,
    /// By channel, `snake_case`.
    #[serde(rename = "dissipated_J")]
    pub dissipated: BTreeMap<String, f64>,
    /// By channel, `snake_case`; left out if no law puts energy in.
    #[serde(rename = "input_J", skip_serializing_if = "BTreeMap::is_empty", default)]
    pub input: BTreeMap<String, f64>,
    /// What the intruder has given of its height; negative if it ends higher.
    #[serde(rename = "released_J", skip_serializing_if = "Option::is_none", default)]
    pub released: Option<f64>,
    /// What the ledger does not explain (J).
    #[serde(rename = "unaccounted_J", skip_serializing_if = "Option::is_none", default)]
    pub unaccounted: Option<f64>,
    /// The same over the energy of the impact (–).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub closure: Option<f64>,
}

/// What is still there at the end. Potential energy and everything of the bed count from the start of
/// the impact: the springs of a bed at rest hold energy that is not the intruder's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinalEnergy {
    /// Kinetic and potential, of the intruder (J).
    #[serde(rename = "intruder_J")]
    pub intruder: f64,
    /// Kinetic and potential, of the grains (J).
    #[serde(rename = "grains_J")]
    pub grains: f64,
    /// In contacts (J).
    #[serde(rename = "elastic_J", skip_serializing_if = "Option::is_none", default)]
    pub elastic: Option<f64>,
}

/// The bed before the impact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BedSummary {
    /// How many.
    pub grains: usize,
    /// Area (volume) of the grains over base times mean height of the surface (–).
    pub packing_fraction: f64,
    /// The same away from walls, floor and surface, where there is room (–).
    pub packing_fraction_inside: Option<f64>,
    /// Mean height of the surface (m).
    pub height_m: f64,
    /// Mean number of contacts of a grain (–).
    pub coordination: f64,
    /// How deep the bed should be for its floor not to be felt, see `docs/beds.md`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub required_depth_m: Option<f64>,
    /// Where the bed is from: `hit`, `miss` (prepared now) or `file`.
    pub cache: String,
    /// What took part in the impact, once there is one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub activity: Option<ActivitySummary>,
    /// What to know of the bed, in sentences.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub warnings: Vec<String>,
}

/// How much of the bed took part in the impact, and for how long: γ and T of the three-shape manuscript, eq. 24.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActivitySummary {
    /// γ, the largest share of the grains that move at one time (–).
    pub largest_moving_share: f64,
    /// Of all grains at one time (J).
    #[serde(rename = "largest_kinetic_energy_J")]
    pub largest_kinetic_energy: f64,
    /// When that is reached (s).
    pub peak_time_s: f64,
    /// T, from which on the kinetic energy of the grains stays below 1 % of the largest (s).
    pub dissipation_time_s: Option<f64>,
}

/// What it cost; the only part of a summary that depends on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostSummary {
    /// Time steps.
    pub steps: u64,
    /// The time step (s); none of an adaptive solver.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub dt_s: Option<f64>,
    /// Of an imported run, the processes; left out, like the time, if they are not known.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub threads: Option<usize>,
    /// Wall time (s).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub wall_s: Option<f64>,
    /// Grains times steps over the wall time (1/s).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub grain_steps_per_s: Option<f64>,
}

/// The account of the drive of a push, as [`by_channel`] spells it.
const DRIVE: &str = "drive";

/// The channels of `ledger` of one kind, by their names in `snake_case` (J).
fn by_channel(ledger: &Ledger, kind: ChannelKind) -> BTreeMap<String, f64> {
    let terms = ledger.terms().iter().zip(&ledger.balance().values);
    terms
        .filter(|(term, _)| term.kind == TermKind::Channel(kind))
        .map(|(term, value)| (term.name.replace('-', "_"), *value))
        .collect()
}
