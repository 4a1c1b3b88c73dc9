//! Damping by a viscoelastic material, on top of a Hertz law.

use engine::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use engine::lanes::Lanes;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable};
use engine::units::Dimension;

use crate::candidate::{Candidacy, Candidate, Need};
use crate::hertz::{Elastic, params};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// A restitution that falls with speed.
///
/// F = A S_n dδ/dt, S_n = 2 E* √(R* δ), at least −4/3 E* √R* δ^{3/2}   (N)
///
/// So it takes at most the elastic force and nothing attracts; the base law's own damping takes no more
/// than what is then left. On `hertz-mindlin` with restitution 1 this is `hertz-mindlin-viscous`.
///
/// e = 1 − C₁ A κ + C₂ A² κ² − …, κ = (α² v)^{1/5}, α = (3/2)^{5/2} 4/3 E* √R*/m*, C₁ = 1.15344,
/// C₂ = 3/5 C₁²
///
/// Channels: `velocity-restitution` (dissipated).
///
/// Source: Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53, 5382 (1996); the series: Ramírez,
/// Pöschel, Brilliantov & Schwager, Phys. Rev. E 60, 4465 (1999).
pub(crate) struct VelocityRestitution {
    viscous_time: f64,
    elastic: [Elastic; 3],
}

/// The law for one kind of partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    viscous_time: f64,
    elastic: Elastic,
}

impl ContactLaw for VelocityRestitution {
    const NAME: &'static str = "velocity-restitution";
    const SLOT: Slot = Slot::Normal;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    /// Its force at the end of the last step (N).
    type History<R: Lanes, const N: usize> = R;
    type Energy<R: Lanes> = R;

    fn pair(&self, partner: Partner) -> Pair {
        Pair { viscous_time: self.viscous_time, elastic: self.elastic[partner.index()] }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut R,
        response: &mut Response<R, N>,
        energy: &mut R,
    ) {
        let overlap = contact.overlap.simd_max(R::zero());
        let a = (overlap / contact.inverse_radius_eff).simd_sqrt();
        let stiffness = pair.elastic.normal_stiffness(a);
        let damping = R::splat(pair.viscous_time) * stiffness * contact.overlap_rate;
        let force = damping.simd_max(-pair.elastic.normal_force(a, overlap));
        *energy += R::splat(0.5) * (*history + force) * contact.overlap_step;
        *history = force;
        response.normal_force += force;
    }

    fn damping_time(pair: &Pair, encounter: &Encounter) -> Option<f64> {
        let a = pair.elastic.largest_contact_radius(encounter);
        let rate = pair.viscous_time * pair.elastic.normal_stiffness(a) / encounter.mass_eff;
        (rate > 0.0).then(|| 1.0 / rate)
    }
}

impl FromParams for VelocityRestitution {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            viscous_time: params.get("viscous_time"),
            elastic: Partner::ALL.map(|partner| Elastic::of(params, partner)),
        }
    }
}

const CHANNELS: &[Channel] =
    &[Channel { name: "velocity-restitution", kind: ChannelKind::Dissipated }];

const PARAMS: &[ParamSpec] = &params::specs_on_base(
    ParamSpec::required(
        "viscous_time",
        Dimension::TIME,
        "A, damping force over stiffness and normal velocity",
    )
    .usual(1e-8, 1e-2),
);

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "Viscoelastic damping on a Hertz law: faster contacts lose a larger part.",
    formula: "F_n → F_n + A S_n dδ/dt, S_n = 2 E* √(R* δ), no attraction",
    signature: "Small: the early peak and the rebound of the bed fall with speed.",
    source: "Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53, 5382 (1996)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "viscous_time (us)",
        screen: 5.0,
        range: (0.0, 100.0),
        separable_from: "from restitution: a wide range of speeds",
        alike_below: &[],
        needs: &[Need::HertzLaw, Need::LawWithout("viscous_time")],
        params: |_, q| vec![("viscous_time", q / 1e6)],
    }),
    ..LawEntry::of::<VelocityRestitution>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::tests::{acted, beads, contact};
    use crate::hertz_mindlin::HertzMindlin;
    use crate::hertz_mindlin_viscous::HertzMindlinViscous;
    use engine::lanes::Record;

    const VISCOUS_TIME: f64 = 1e-6;

    #[test]
    fn on_an_undamped_hertz_law_it_is_the_viscous_law() {
        let elastic =
            [("restitution", 1.0), ("wall_restitution", 1.0), ("intruder_restitution", 1.0)];
        let more = [("viscous_time", VISCOUS_TIME), ("tangential_damping", 0.0)];
        let params = beads(&[&elastic[..], &more].concat());
        let base = HertzMindlin::from_params(&params).pair(Partner::Grain);
        let effect = VelocityRestitution::from_params(&params).pair(Partner::Grain);
        let whole = HertzMindlinViscous::from_params(&params).pair(Partner::Grain);
        for rate in [1e-2, 1e-3, 0.0, -1e-2, -0.5] {
            let moving = Contact { overlap_rate: rate, ..contact() };
            let mut memory = Record::zero();
            let (expected, _) = acted::<HertzMindlinViscous>(&whole, &moving, &mut memory);
            let (mut response, mut memory) = (Response::default(), Record::zero());
            let (mut lost, mut energy) = (0.0, Record::zero());
            let history = &mut 0.0;
            VelocityRestitution::act(&effect, &moving, 0.0, history, &mut response, &mut lost);
            HertzMindlin::act(&base, &moving, 0.0, &mut memory, &mut response, &mut energy);
            let difference = response.normal_force - expected.normal_force;
            // The same terms in another order.
            assert!(difference.abs() <= 1e-15 * expected.normal_stiffness * contact().overlap);
        }
    }

    #[test]
    fn its_work_is_the_mean_force_over_the_way() {
        let params = beads(&[("viscous_time", VISCOUS_TIME)]);
        let pair = VelocityRestitution::from_params(&params).pair(Partner::Grain);
        let mut history = 0.0;
        let moving = Contact { overlap_rate: 1e-3, overlap_step: 1e-9, ..contact() };
        let (response, energy) = acted::<VelocityRestitution>(&pair, &moving, &mut history);
        assert!((energy - 0.5 * response.normal_force * 1e-9).abs() <= 1e-15 * energy);
        let (_, energy) = acted::<VelocityRestitution>(&pair, &moving, &mut history);
        assert!((energy - response.normal_force * 1e-9).abs() <= 1e-15 * energy);
    }
}
