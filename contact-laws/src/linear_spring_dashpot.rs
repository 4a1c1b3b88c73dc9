//! Linear spring–dashpot with a tangential spring and a Coulomb limit.

use engine::ledger::{Channel, ChannelKind};
use engine::params::{Default, ParamSpec, Range};
use engine::units::Dimension;

use crate::registry::{ActsOn, LawEntry};

const CHANNELS: &[Channel] = &[
    Channel { name: "normal", kind: ChannelKind::Stored },
    Channel { name: "tangential", kind: ChannelKind::Stored },
    Channel { name: "normal-damping", kind: ChannelKind::Dissipated },
    Channel { name: "tangential-damping", kind: ChannelKind::Dissipated },
    Channel { name: "sliding", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "normal_stiffness",
        dimension: Dimension::STIFFNESS,
        default: Default::Required,
        allowed: Range::POSITIVE,
        plausible: Range::closed(1e2, 1e8),
        meaning: "k_n, force per overlap",
    },
    ParamSpec {
        key: "tangential_stiffness",
        dimension: Dimension::STIFFNESS,
        default: Default::SameAs("normal_stiffness"),
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(1e2, 1e8),
        meaning: "k_t, force per length of the tangential spring",
    },
    ParamSpec {
        key: "normal_damping_rate",
        dimension: Dimension::RATE,
        default: Default::Required,
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1e6),
        meaning: "γ_n, damping force per reduced mass and normal velocity",
    },
    ParamSpec {
        key: "tangential_damping_rate",
        dimension: Dimension::RATE,
        default: Default::Value(0.0),
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1e6),
        meaning: "γ_t, damping force per reduced mass and slip velocity",
    },
    ParamSpec {
        key: "friction",
        dimension: Dimension::NONE,
        default: Default::Required,
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1.5),
        meaning: "μ, Coulomb limit of the tangential force over |F_n|",
    },
    ParamSpec {
        key: "wall_friction",
        dimension: Dimension::NONE,
        default: Default::SameAs("friction"),
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1.5),
        meaning: "μ between grains and walls",
    },
    ParamSpec {
        key: "intruder_friction",
        dimension: Dimension::NONE,
        default: Default::SameAs("friction"),
        allowed: Range::NOT_NEGATIVE,
        plausible: Range::closed(0.0, 1.5),
        meaning: "μ between grains and the intruder",
    },
];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    name: "linear-spring-dashpot",
    acts_on: ActsOn::ContactBase,
    summary: "Linear normal and tangential springs with mass-scaled damping and a Coulomb limit.",
    formula: "F_n = k_n δ + m_r γ_n dδ/dt;  F_t = −(k_t ξ + m_r γ_t v_t), |F_t| ≤ μ |F_n|",
    signature: "The base law of a bed; μ sets the depth-linear friction, γ_n the restitution.",
    source: "Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), eqs 3–4; Cundall & Strack (1979)",
    params: PARAMS,
    channels: CHANNELS,
};
