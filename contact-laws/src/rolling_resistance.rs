//! Rolling resistance as an elastic–plastic spring with a dashpot.

use engine::contact::{Contact, ContactLaw, Partner, Response, Slot};
use engine::lanes::{Lanes, Vector, length, select_vector, shortened, vector_where};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable};

use crate::candidate::{Candidacy, Candidate};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// A couple against rolling: a spring in the relative rotation with a dashpot, and a plastic limit.
///
/// M = −(k_r θ + c_r dθ/dt), |M| ≤ μ_r R* |F_n|   (N m)
///
/// k_r = 2.25 k_n (μ_r R*)², c_r = 2 η_r √(I_r k_r), 1/I_r = Σ 1/(I + m R²)
///
/// θ (rad) is the relative rotation ω_i − ω_j summed over the contact, without its part along the
/// normal. The spring yields where it alone exceeds the limit: it is cut back to limit/k_r and the
/// dashpot is dropped. Below, the dashpot adds at most what the spring leaves of the limit (the source
/// lets it add all of itself). Were spring and dashpot judged together, the dashpot would wind the
/// spring, and a bed at 2 m/s got 8 % of what rolling dissipates back out of this channel.
///
/// Where k_n changes with the overlap, what the spring loses or gains by it is booked as dissipated.
///
/// k_n is the stiffness that the base law reports; R* is half a radius for equal grains and the
/// radius at a wall, so codes that scale with R or the diameter have another μ_r.
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

engine::record! {
    /// What a contact remembers.
    pub(crate) struct Memory<R, const N: usize> {
        /// θ (rad).
        angle: Vector<R, N>,
        /// Viscous couple at the end of the last step (N m).
        damping: Vector<R, N>,
        /// k_r at the end of the last step (N m).
        stiffness: R,
    }
}

engine::record! {
    /// One number (J) per channel.
    pub(crate) struct Energy<R> {
        stored: R,
        dissipated: R,
    }
}

impl ContactLaw for RollingResistance {
    const NAME: &'static str = "rolling-resistance";
    const SLOT: Slot = Slot::Rolling;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Memory<R, N>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, _: Partner) -> Pair {
        Pair {
            rolling_friction: self.rolling_friction,
            rolling_damping_ratio: self.rolling_damping_ratio,
        }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut Memory<R, N>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        let (zero, half) = (R::zero(), R::splat(0.5));
        let lever = R::splat(pair.rolling_friction) * contact.radius_eff();
        let k_r = R::splat(2.25) * response.normal_stiffness * lever * lever;
        let critical = (k_r / contact.rolling_mobility).simd_sqrt();
        let damped = R::splat(2.0 * pair.rolling_damping_ratio) * critical;
        let c_r = damped.select(contact.overlaps(), zero);
        let limit = lever * (response.normal_force + response.adhesive_force).simd_abs();

        let turned = contact.across(contact.relative_turn);
        let before = contact.turn(history.angle);
        let wound = before + turned;
        let spring = length(wound) * k_r;
        let yields = spring.simd_gt(limit);
        let angle = select_vector(yields, wound * (limit / spring), wound);
        let plastic = half * k_r * (before + angle).dot(&(wound - angle));
        energy.dissipated += plastic.select(yields, zero);
        let trial = -(wound * k_r + contact.across(contact.relative_spin) * c_r);
        let couple = select_vector(yields, angle * -k_r, shortened(trial, limit).0);
        let viscous = -couple - angle * k_r;
        energy.dissipated += half * (history.stiffness - k_r) * before.dot(&wound);
        energy.stored += half * k_r * angle.dot(&angle);
        energy.dissipated += half * (history.damping + viscous).dot(&turned);

        // Without stiffness nothing was wound up that could come back.
        let angle = vector_where(k_r.simd_gt(zero), angle);
        *history = Memory { angle, damping: viscous, stiffness: k_r };
        response.couple += couple;
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
    ParamSpec::number("rolling_friction", "μ_r, limit of the rolling torque over R* |F_n|")
        .usual(0.01, 0.3),
    ParamSpec::number(
        "rolling_damping_ratio",
        "η_r, damping of the rolling spring over its critical damping",
    )
    .or(0.3)
    .usual(0.0, 1.0),
];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "A torque against rolling: elastic spring, dashpot, and a plastic limit.",
    formula: "M = −k_r θ − 2 η_r √(I_r k_r) dθ/dt, |M| ≤ μ_r R* |F_n|;  k_r = 2.25 k_n (μ_r R*)²",
    signature: "A higher angle of repose and depth-linear friction; depth and stopping time fall together.",
    source: "Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model C",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "rolling_friction",
        screen: 0.1,
        range: (0.0, 0.5),
        separable_from: "from grain-friction: several angles, or bed and impact by different friction",
        alike_below: &[],
        needs: &[],
        params: |_, q| vec![("rolling_friction", q)],
    }),
    ..LawEntry::of::<RollingResistance>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use engine::lanes::Record;
    use engine::math::Vec3;

    const FRICTION: f64 = 0.1;
    /// R* is 1 mm.
    const LEVER: f64 = FRICTION * 1e-3;
    const NORMAL_FORCE: f64 = 0.3;
    const STIFFNESS: f64 = 3200.0;

    fn act(turn: Vec3, history: &mut Memory<f64, 3>) -> (Vec3, Energy<f64>) {
        let law = RollingResistance { rolling_friction: FRICTION, rolling_damping_ratio: 0.0 };
        let contact = Contact {
            normal: Vec3::z(),
            overlap: NORMAL_FORCE / STIFFNESS,
            overlap_rate: 0.0,
            overlap_step: 0.0,
            slip_velocity: Vec3::zeros(),
            slip_step: Vec3::zeros(),
            relative_spin: Vec3::zeros(),
            relative_turn: turn,
            inverse_radius_eff: 1e3,
            inverse_radius_eff_before: 1e3,
            inverse_mass_eff: 1e4,
            rolling_mobility: 1e9,
        };
        let mut response = Response {
            normal_force: NORMAL_FORCE,
            normal_stiffness: STIFFNESS,
            ..Response::default()
        };
        let mut energy = Record::zero();
        let pair = law.pair(Partner::Grain);
        RollingResistance::act(&pair, &contact, 1e-5, history, &mut response, &mut energy);
        (response.couple, energy)
    }

    /// Sums of a handful of terms.
    fn close(value: f64, expected: f64) -> bool {
        (value - expected).abs() <= 1e-14 * expected.abs().max(LEVER * NORMAL_FORCE)
    }

    #[test]
    fn a_rolling_contact_resists_with_the_limit_couple_and_dissipates_the_rest() {
        let mut history = Record::zero();
        let limit = LEVER * NORMAL_FORCE;
        act(Vec3::y(), &mut history);
        let (couple, energy) = act(Vec3::y() * 0.2, &mut history);
        assert!(close(couple.y, -limit));
        assert!(close(history.angle.y, limit / (2.25 * STIFFNESS * LEVER * LEVER)));
        assert!(close(energy.stored, 0.5 * limit * history.angle.y));
        assert!(close(energy.dissipated, limit * 0.2));
    }

    #[test]
    fn a_small_turn_is_given_back_and_twisting_is_not_resisted() {
        let mut history = Record::zero();
        let stiffness = 2.25 * STIFFNESS * LEVER * LEVER;
        let (couple, energy) = act(Vec3::y() * 0.1 + Vec3::z() * 5.0, &mut history);
        assert!(close(couple.y, -0.1 * stiffness) && close(couple.z, 0.0));
        assert!(close(energy.stored, 0.5 * stiffness * 0.01) && close(energy.dissipated, 0.0));
        let (couple, energy) = act(Vec3::y() * -0.1, &mut history);
        assert!(close(couple.norm(), 0.0) && close(energy.stored, 0.0));
    }
}
