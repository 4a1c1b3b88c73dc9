//! Rolling resistance as a constant torque.

use engine::contact::{Contact, ContactLaw, Partner, Response, Slot};
use engine::lanes::{Lanes, Vector, length, vector_where};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable};

use crate::candidate::Candidacy;
use crate::registry::{ActsOn, FromParams, LawEntry};

/// A couple against rolling that does not depend on how fast it rolls.
///
/// M = −μ_r R* F_n ω_r/|ω_r|, |M| ≤ I_r |ω_r|/(κ dt)   (N m), 1/I_r = Σ 1/(I + m R²)
///
/// ω_r (rad/s) is the relative spin without its part along the normal. The second limit keeps the couple of
/// one contact from turning the rotation round within a step: a free sphere answers 1/I, κ = 7/2 times the
/// mobility of one that rolls. Several contacts of a grain may together, and then a slow spin dithers,
/// within what μ_r R* F_n can do in a step. Where it acts the couple is that of a dashpot, so a grain at rest on a slope creeps;
/// `rolling-resistance` holds it.
///
/// Channels: `rolling-constant-torque` (dissipated).
///
/// Source: Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model A. Differs from it in the second
/// limit.
pub(crate) struct RollingConstantTorque {
    rolling_friction: f64,
}

/// The law, the same for every partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    rolling_friction: f64,
}

/// 1 + m R²/I of a sphere, which no grain exceeds.
const FREE_OVER_ROLLING: f64 = 3.5;

impl ContactLaw for RollingConstantTorque {
    const NAME: &'static str = "rolling-constant-torque";
    const SLOT: Slot = Slot::Rolling;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    /// The couple at the end of the last step (N m).
    type History<R: Lanes, const N: usize> = Vector<R, N>;
    type Energy<R: Lanes> = R;

    fn pair(&self, _: Partner) -> Pair {
        Pair { rolling_friction: self.rolling_friction }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        dt: f64,
        history: &mut Vector<R, N>,
        response: &mut Response<R, N>,
        energy: &mut R,
    ) {
        let spin = contact.across(contact.relative_spin);
        let speed = length(spin);
        let pressed = (response.normal_force + response.adhesive_force).simd_max(R::zero());
        let limit = R::splat(pair.rolling_friction) * contact.radius_eff() * pressed;
        let stopping = speed / (R::splat(FREE_OVER_ROLLING * dt) * contact.rolling_mobility);
        let rolls = speed.simd_gt(R::zero());
        let couple = vector_where(rolls, spin * (-limit.simd_min(stopping) / speed));
        let turned = contact.across(contact.relative_turn);
        *energy -= R::splat(0.5) * (*history + couple).dot(&turned);
        *history = couple;
        response.couple += couple;
    }
}

impl FromParams for RollingConstantTorque {
    fn from_params(params: &ParamTable) -> Self {
        Self { rolling_friction: params.get("rolling_friction") }
    }
}

const CHANNELS: &[Channel] =
    &[Channel { name: "rolling-constant-torque", kind: ChannelKind::Dissipated }];

const PARAMS: &[ParamSpec] =
    &[ParamSpec::number("rolling_friction", "μ_r, rolling torque over R* F_n").usual(0.01, 0.3)];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "A torque of constant size against rolling; grains at rest may creep.",
    formula: "M = −μ_r R* F_n ω_r/|ω_r|, never enough to turn the rotation round within a step",
    signature: "More depth-linear friction, as rolling-resistance, but a bed that settles for long.",
    source: "Ai, Chen, Rotter & Ooi, Powder Technol. 206, 269 (2011), model A",
    params: PARAMS,
    candidacy: Candidacy::None(
        "rolling-resistance stands for it: both end at μ_r R* F_n, and they differ where grains are at rest",
    ),
    ..LawEntry::of::<RollingConstantTorque>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::tests::{RADIUS_EFF, contact};
    use engine::math::Vec3;

    const FRICTION: f64 = 0.1;
    const NORMAL_FORCE: f64 = 0.3;
    const DT: f64 = 1e-6;

    fn act(spin: Vec3, history: &mut Vec3) -> (Vec3, f64) {
        let pair = RollingConstantTorque { rolling_friction: FRICTION }.pair(Partner::Grain);
        let contact = Contact { relative_spin: spin, relative_turn: spin * DT, ..contact() };
        let mut response = Response { normal_force: NORMAL_FORCE, ..Response::default() };
        let mut energy = 0.0;
        RollingConstantTorque::act(&pair, &contact, DT, history, &mut response, &mut energy);
        (response.couple, energy)
    }

    /// Round-off of a handful of operations.
    fn close(value: f64, expected: f64) -> bool {
        (value - expected).abs() <= 1e-14 * expected.abs().max(1e-12)
    }

    #[test]
    fn the_couple_is_as_large_at_any_speed_and_leaves_twisting_alone() {
        let torque = FRICTION * RADIUS_EFF * NORMAL_FORCE;
        let mut history = Vec3::zeros();
        for speed in [1e3, 1e5] {
            let (couple, energy) = act(Vec3::y() * speed + Vec3::z() * 50.0, &mut history);
            assert!(close(couple.y, -torque) && close(couple.z, 0.0), "{couple:?}");
            let share = if speed < 1e4 { 0.5 } else { 1.0 };
            assert!(close(energy, share * torque * speed * DT));
        }
    }

    #[test]
    fn slow_rolling_is_not_turned_round() {
        let spin = 1e-3;
        let (couple, _) = act(Vec3::y() * spin, &mut Vec3::zeros());
        let mobility = 3.5 * contact().rolling_mobility;
        assert!(close(couple.y * mobility * DT, -spin));
    }
}
