//! What came of a point: the keys of `done.json`.

use std::collections::BTreeMap;

use crate::run::Summary;
use serde::{Deserialize, Serialize};

/// `done.json` of a point: there once the point is done, and not before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Done {
    /// How it ended.
    pub status: Status,
    /// The hash of the point.
    pub hash: String,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<String>,
    /// Its numbers, if it did not fail.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub headline: Option<Headline>,
    /// What it cost; the only part that depends on the machine.
    pub cost: Cost,
}

/// How a point ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Its impact was run to its end, whether or not the intruder stopped.
    Done,
    /// A step could not be trusted, or a bed not be prepared: a result like any other.
    Failed,
}

/// The numbers of an impact; see `summary.json` of its folder for all of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "the keys carry their units and are documented in docs/campaigns.md"
)]
pub struct Headline {
    pub speed_m_per_s: f64,
    pub angle_deg: f64,
    pub stopped: bool,
    pub stopping_time_s: Option<f64>,
    pub rest_time_s: Option<f64>,
    pub depth_m: f64,
    pub range_m: f64,
    #[serde(rename = "impact_energy_J")]
    pub impact_energy: f64,
    /// By channel, `snake_case`.
    #[serde(rename = "dissipated_J")]
    pub dissipated: BTreeMap<String, f64>,
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub closure: Option<f64>,
    /// Of a bed of grains.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub packing_fraction: Option<f64>,
}

/// What a point cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the key carries its unit")]
pub struct Cost {
    pub wall_s: f64,
}

impl Done {
    /// Of an impact that was run.
    pub(crate) fn of(hash: &str, summary: &Summary) -> Self {
        let Summary { impact, stop, energy, bed, cost, .. } = summary;
        let headline = Headline {
            speed_m_per_s: impact.speed_m_per_s,
            angle_deg: impact.angle_deg,
            stopped: stop.stopped,
            stopping_time_s: stop.stopping_time_s,
            rest_time_s: stop.rest_time_s,
            depth_m: stop.depth_m,
            range_m: stop.range_m,
            impact_energy: energy.initial,
            dissipated: energy.dissipated.clone(),
            closure: energy.closure,
            packing_fraction: bed.as_ref().map(|bed| bed.packing_fraction),
        };
        Self {
            status: Status::Done,
            hash: hash.to_owned(),
            error: None,
            headline: Some(headline),
            cost: Cost { wall_s: cost.wall_s.unwrap_or(0.0) },
        }
    }

    /// Of one that failed after `wall` (s).
    pub(crate) fn failed(hash: &str, error: String, wall: f64) -> Self {
        Self {
            status: Status::Failed,
            hash: hash.to_owned(),
            error: Some(error),
            headline: None,
            cost: Cost { wall_s: wall },
        }
    }
}
