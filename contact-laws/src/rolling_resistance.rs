//! Rolling resistance as an elastic–plastic spring with a dashpot.

use engine::contact::{Contact, ContactLaw, Partner, Response, Slot};
use engine::ledger::{Channel, ChannelKind};
use engine::math::Vec3;
use engine::params::{Default, ParamSpec, ParamTable, Range};
use engine::units::Dimension;

use crate::registry::{ActsOn, FromParams, LawEntry};

/// A couple against rolling: a spring in the relative rotation with a dashpot, and a plastic limit.
///
/// M = −(k_r θ + c_r dθ/dt), |M| ≤ μ_r R* |F_n|   [N m]
///
/// k_r = 2.25 k_n (μ_r R*)², c_r = 2 η_r √(I_r k_r), 1/I_r = Σ 1/(I + m R²)
///
/// θ [rad] is the relative rotation ω_i − ω_j summed over the contact, without its part along the
/// normal. While it yields the dashpot is dropped and θ = −M/k_r. k_n is the stiffness that the base
/// law reports; R* is half a radius for equal grains and the radius at a wall, so codes that scale
/// with R or the diameter have another μ_r.
///
/// Channels: `rolling-resistance`, stored and dissipated.
///
/// Source: Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model C.
pub(crate) struct RollingResistance {
    rolling_friction: f64,
    rolling_damping_ratio: f64,
}

/// The law, the same for every partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    rolling_friction: f64,
    rolling_damping_ratio: f64,
}

/// What a contact remembers.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Memory {
    /// θ [rad].
    angle: Vec3,
    /// Viscous couple at the end of the last step [N m].
    damping: Vec3,
}

#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct Energy {
    stored: f64,
    dissipated: f64,
}

impl ContactLaw for RollingResistance {
    const NAME: &'static str = "rolling-resistance";
    const SLOT: Slot = Slot::Rolling;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History = Memory;
    type Energy = Energy;

    fn pair(&self, _: Partner) -> Pair {
        Pair {
            rolling_friction: self.rolling_friction,
            rolling_damping_ratio: self.rolling_damping_ratio,
        }
    }

    #[inline]
    fn act(
        pair: &Pair,
        contact: &Contact,
        _dt: f64,
        history: &mut Memory,
        response: &mut Response,
        energy: &mut Energy,
    ) {
        let lever = pair.rolling_friction * contact.radius_eff();
        let k_r = 2.25 * response.normal_stiffness * lever * lever;
        let c_r = if contact.overlap > 0.0 {
            2.0 * pair.rolling_damping_ratio * (k_r / contact.rolling_mobility).sqrt()
        } else {
            0.0
        };
        let limit = lever * response.normal_force.abs();
        let rolling = |spin: Vec3| spin - contact.normal * spin.dot(&contact.normal);

        let turned = rolling(contact.relative_turn);
        let before = contact.turn(history.angle);
        let wound = before + turned;
        let viscous = rolling(contact.relative_spin) * c_r;
        let trial = -(wound * k_r + viscous);
        let trial_2 = trial.norm_squared();
        let (couple, angle, viscous) = if trial_2 > limit * limit {
            let couple = trial * (limit / trial_2.sqrt());
            let angle = couple / -k_r;
            energy.dissipated += 0.5 * k_r * (before + angle).dot(&(wound - angle));
            (couple, angle, Vec3::zeros())
        } else {
            (trial, wound, viscous)
        };
        energy.stored += 0.5 * k_r * angle.norm_squared();
        energy.dissipated += 0.5 * (history.damping + viscous).dot(&turned);

        *history = Memory { angle, damping: viscous };
        response.couple += couple;
    }

    fn collision_time(_: &Pair, _: f64) -> Option<f64> {
        None
    }

    fn damping_time(_: &Pair) -> Option<f64> {
        None
    }
}

impl FromParams for RollingResistance {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            rolling_friction: params.get("rolling_friction"),
            rolling_damping_ratio: params.get("rolling_damping_ratio"),
        }
    }
}

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
    acts_on: ActsOn::ContactEffect,
    summary: "A torque against rolling: elastic spring, dashpot, and a plastic limit.",
    formula: "M = −k_r θ − 2 η_r √(I_r k_r) dθ/dt, |M| ≤ μ_r R* |F_n|;  k_r = 2.25 k_n (μ_r R*)²",
    signature: "A higher angle of repose and depth-linear friction; depth and stopping time fall together.",
    source: "Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model C",
    params: PARAMS,
    ..LawEntry::of::<RollingResistance>()
};
