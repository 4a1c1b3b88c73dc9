//! Resistance against twisting about the normal.

use engine::contact::{Contact, ContactLaw, Partner, Response, Slot};
use engine::lanes::Lanes;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable, Range};

use crate::candidate::{Candidacy, Candidate, Need};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// A couple along the normal against the relative rotation about it: a spring with a plastic limit.
///
/// M = −k_o R*² θ, |M| ≤ μ_o R* F_n   (N m), k_o = ratio · k_n
///
/// θ (rad) is the rotation ω_i − ω_j about the normal, summed over the contact and cut back to the limit.
/// k_n is the stiffness that the base law reports; what the spring gains or loses as it changes is booked
/// as dissipated. In a plane nothing twists.
///
/// Channels: `twisting-resistance`, stored and dissipated.
///
/// Source: Luding, Granul. Matter 10, 235 (2008), its torsion spring. Differs from it in that it has no
/// dashpot.
pub(crate) struct TwistingResistance {
    twisting_friction: f64,
    twisting_stiffness_ratio: f64,
}

/// The law, the same for every partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    twisting_friction: f64,
    twisting_stiffness_ratio: f64,
}

engine::record! {
    /// What a contact remembers.
    pub(crate) struct Memory<R> {
        /// θ (rad).
        angle: R,
        /// k_o R*² at the end of the last step (N m).
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

impl ContactLaw for TwistingResistance {
    const NAME: &'static str = "twisting-resistance";
    const SLOT: Slot = Slot::Twisting;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Memory<R>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, _: Partner) -> Pair {
        Pair {
            twisting_friction: self.twisting_friction,
            twisting_stiffness_ratio: self.twisting_stiffness_ratio,
        }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut Memory<R>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        let (zero, half) = (R::zero(), R::splat(0.5));
        let radius = contact.radius_eff();
        let k_n = response.normal_stiffness.select(contact.overlaps(), zero);
        let stiffness = R::splat(pair.twisting_stiffness_ratio) * k_n * radius * radius;
        let pressed = (response.normal_force + response.adhesive_force).simd_max(zero);
        let limit = R::splat(pair.twisting_friction) * radius * pressed;

        let before = history.angle;
        let wound = before + contact.along(contact.relative_turn);
        let yields = (stiffness * wound.simd_abs()).simd_gt(limit);
        let angle = (limit / stiffness).simd_copysign(wound).select(yields, wound);
        let pull = history.stiffness * before + stiffness * angle;
        energy.dissipated +=
            half * pull * (wound - angle) + half * (history.stiffness - stiffness) * before * angle;
        energy.stored += half * stiffness * angle * angle;
        response.couple -= contact.normal * (stiffness * angle);
        // Without stiffness nothing was wound up that could come back.
        *history = Memory { angle: angle.select(stiffness.simd_gt(zero), zero), stiffness };
    }
}

impl FromParams for TwistingResistance {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            twisting_friction: params.get("twisting_friction"),
            twisting_stiffness_ratio: params.get("twisting_stiffness_ratio"),
        }
    }
}

const CHANNELS: &[Channel] = &[
    Channel { name: "twisting-resistance", kind: ChannelKind::Stored },
    Channel { name: "twisting-resistance", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[
    ParamSpec::number("twisting_friction", "μ_o, limit of the twisting torque over R* F_n")
        .usual(0.001, 0.3),
    ParamSpec::number("twisting_stiffness_ratio", "stiffness of the twisting spring over R*² k_n")
        .or(0.1)
        .allowed(Range::POSITIVE)
        .usual(0.01, 1.0),
];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "A torque against twisting about the normal: elastic spring and plastic limit (3D).",
    formula: "M = −k_o R*² θ along n, |M| ≤ μ_o R* F_n",
    signature: "Small: a spinning intruder and grains that spin on their contacts stop earlier.",
    source: "Luding, Granul. Matter 10, 235 (2008)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "twisting_friction",
        screen: 0.1,
        range: (0.0, 1.0),
        separable_from: "from rolling-resistance: hardly by depths and times",
        alike_below: &[],
        needs: &[Need::Spheres("discs in a plane do not twist against each other")],
        params: |_, q| vec![("twisting_friction", q)],
    }),
    ..LawEntry::of::<TwistingResistance>()
};

#[cfg(test)]
mod tests {
    use engine::lanes::Record;
    use engine::math::Vec3;

    use super::*;
    use crate::hertz::tests::{RADIUS_EFF, contact};

    const FRICTION: f64 = 0.1;
    const NORMAL_FORCE: f64 = 0.3;
    const STIFFNESS: f64 = 3200.0;

    fn act(turn: Vec3, normal_stiffness: f64, history: &mut Memory<f64>) -> (Vec3, Energy<f64>) {
        let law = TwistingResistance { twisting_friction: FRICTION, twisting_stiffness_ratio: 0.1 };
        let contact = Contact { relative_turn: turn, ..contact() };
        let mut response =
            Response { normal_force: NORMAL_FORCE, normal_stiffness, ..Response::default() };
        let mut energy = Record::zero();
        let pair = law.pair(Partner::Grain);
        TwistingResistance::act(&pair, &contact, 1e-6, history, &mut response, &mut energy);
        (response.couple, energy)
    }

    /// Sums of a handful of terms.
    fn close(value: f64, expected: f64) -> bool {
        (value - expected).abs() <= 1e-14 * FRICTION * RADIUS_EFF * NORMAL_FORCE
    }

    #[test]
    fn a_small_twist_is_given_back_and_rolling_is_not_resisted() {
        let mut history = Record::zero();
        let k = 0.1 * STIFFNESS * RADIUS_EFF * RADIUS_EFF;
        let (couple, energy) = act(Vec3::new(0.3, -0.2, 0.1), STIFFNESS, &mut history);
        assert!(close(couple.z, -0.1 * k) && close(couple.x, 0.0) && close(couple.y, 0.0));
        assert!(close(energy.stored, 0.5 * k * 0.01) && close(energy.dissipated, 0.0));
        let (couple, energy) = act(Vec3::z() * -0.1, STIFFNESS, &mut history);
        assert!(close(couple.norm(), 0.0) && close(energy.stored, 0.0));
    }

    #[test]
    fn a_large_twist_is_resisted_with_the_limit_and_dissipated() {
        let mut history = Record::zero();
        let limit = FRICTION * RADIUS_EFF * NORMAL_FORCE;
        act(Vec3::z(), STIFFNESS, &mut history);
        let (couple, energy) = act(Vec3::z() * 0.2, STIFFNESS, &mut history);
        assert!(close(couple.z, -limit) && close(energy.dissipated, 0.2 * limit));
    }

    #[test]
    fn what_the_spring_gains_as_the_contact_stiffens_is_booked() {
        let mut history = Record::zero();
        let k = 0.1 * STIFFNESS * RADIUS_EFF * RADIUS_EFF;
        act(Vec3::z() * 0.05, STIFFNESS, &mut history);
        let (_, energy) = act(Vec3::zeros(), 2.0 * STIFFNESS, &mut history);
        assert!(close(energy.stored, k * 0.0025) && close(energy.dissipated, -0.5 * k * 0.0025));
    }
}
