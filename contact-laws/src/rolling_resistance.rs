//! Rolling resistance as an elastic–plastic spring with a dashpot.

use engine::ledger::{Channel, ChannelKind};
use engine::params::{Default, ParamSpec, Range};
use engine::units::Dimension;

use crate::registry::{ActsOn, LawEntry};

const CHANNELS: &[Channel] = &[
    Channel { name: "rolling-resistance", kind: ChannelKind::Stored },
    Channel { name: "rolling-resistance", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "rolling_friction",
        dimension: Dimension::NONE,
        default: Default::Required,
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.01, 0.3),
        meaning: "μ_r, limit of the rolling torque over R* |F_n|",
    },
    ParamSpec {
        key: "rolling_damping_ratio",
        dimension: Dimension::NONE,
        default: Default::Value(0.3),
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1.0),
        meaning: "η_r, damping of the rolling spring over its critical damping",
    },
];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    name: "rolling-resistance",
    acts_on: ActsOn::ContactEffect,
    summary: "A torque against rolling: elastic spring, dashpot, and a plastic limit.",
    formula: "M = −k_r θ − 2 η_r √(I_r k_r) dθ/dt, |M| ≤ μ_r R* |F_n|;  k_r = 2.25 k_n (μ_r R*)²",
    signature: "A higher angle of repose and depth-linear friction; depth and stopping time fall together.",
    source: "Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model C",
    params: PARAMS,
    channels: CHANNELS,
};
