//! Linear spring–dashpot with a tangential spring and a Coulomb limit.

use engine::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use engine::lanes::{Coarse, Lanes, Vector, select_vector, shortened, vector_where};
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable, Range};
use engine::units::Dimension;

use crate::damped::Damped;
use crate::registry::{ActsOn, FromParams, LawEntry};

/// Linear springs along the normal and in the contact plane, damping scaled with the reduced mass,
/// and a Coulomb limit.
///
/// F_n = k_n δ + m_r γ_n dδ/dt   (N), repulsion positive; it may attract while damping exceeds the
/// spring, as the source prints it
///
/// F_t = −(k_t ξ + m_r γ_t v_t), |F_t| ≤ μ |F_n|, where adhesion adds to F_n what [`Response`] says
///
/// ξ (m) is the tangential spring, kept in [`Memory`] and turned with the contact plane. Above the
/// limit the viscous part is dropped and ξ = −F_t/k_t: with the γ_t of the source the dashpot alone
/// exceeds the limit almost always, and keeping it would wind the spring backwards.
///
/// Channels: `normal`, `tangential` (stored); `normal-damping`, `tangential-damping`, `sliding`.
///
/// Source: Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), eqs 3 and 4. Differs from it in the sign
/// of the damping in eq. 4, which as printed pumps energy while the spring loads.
pub(crate) struct LinearSpringDashpot {
    normal_stiffness: f64,
    tangential_stiffness: f64,
    normal_damping_rate: f64,
    tangential_damping_rate: f64,
    friction: [f64; 3],
}

/// The law for one kind of partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    normal_stiffness: f64,
    tangential_stiffness: f64,
    /// 1/k_t (m/N).
    tangential_compliance: f64,
    normal_damping_rate: f64,
    tangential_damping_rate: f64,
    friction: f64,
}

engine::record! {
    /// What a contact remembers.
    pub(crate) struct Memory<R, const N: usize> {
        /// ξ (m).
        spring: Vector<R, N>,
        damping: Coarse<Damped<R, N>>,
    }
}

engine::record! {
    /// One number (J) per channel.
    pub(crate) struct Energy<R> {
        normal: R,
        tangential: R,
        normal_damping: R,
        tangential_damping: R,
        sliding: R,
    }
}

impl ContactLaw for LinearSpringDashpot {
    const NAME: &'static str = "linear-spring-dashpot";
    const SLOT: Slot = Slot::Base;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Memory<R, N>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, partner: Partner) -> Pair {
        Pair {
            normal_stiffness: self.normal_stiffness,
            tangential_stiffness: self.tangential_stiffness,
            tangential_compliance: 1.0 / self.tangential_stiffness,
            normal_damping_rate: self.normal_damping_rate,
            tangential_damping_rate: self.tangential_damping_rate,
            friction: self.friction[partner.index()],
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
        let half = R::splat(0.5);
        let touching = contact.overlaps();
        let overlap = contact.overlap.simd_max(R::zero());
        let mass = contact.mass_eff().select(touching, R::zero());

        let [k_n, k_t] = [pair.normal_stiffness, pair.tangential_stiffness].map(R::splat);
        let damping = mass * R::splat(pair.normal_damping_rate) * contact.overlap_rate;
        let normal_force = k_n * overlap + damping;
        energy.normal += half * k_n * overlap * overlap;
        let Coarse(damped) = history.damping;
        energy.normal_damping += half * (damped.normal + damping) * contact.overlap_step;

        let pressed = response.normal_force + normal_force + response.adhesive_force;
        let limit = R::splat(pair.friction) * pressed.simd_abs();
        let before = contact.turn(history.spring);
        let stretched = before + contact.slip_step;
        let viscous = contact.slip_velocity * (mass * R::splat(pair.tangential_damping_rate));
        let trial = -(stretched * k_t + viscous);
        let (force, slides) = shortened(trial, limit);
        let cut_back = force * -R::splat(pair.tangential_compliance);
        let spring = select_vector(slides, cut_back, stretched);
        let viscous = vector_where(!slides, viscous);
        energy.sliding += half * k_t * (before + spring).dot(&(stretched - spring));
        energy.tangential += half * k_t * spring.dot(&spring);
        energy.tangential_damping += half * (damped.tangential + viscous).dot(&contact.slip_step);

        let damping = Coarse(Damped { normal: damping, tangential: viscous });
        *history = Memory { spring, damping };
        response.normal_force += normal_force;
        response.normal_stiffness += k_n;
        response.tangential_force += force;
    }

    fn collision_time(pair: &Pair, encounter: &Encounter) -> Option<f64> {
        Some(std::f64::consts::PI * (encounter.mass_eff / pair.normal_stiffness).sqrt())
    }

    fn damping_time(pair: &Pair, _: &Encounter) -> Option<f64> {
        // Spin makes a contact lighter along its plane: 1 + m R²/I, 3.5 for spheres, 3 for discs.
        let rate = pair.normal_damping_rate.max(3.5 * pair.tangential_damping_rate);
        (rate > 0.0).then(|| 1.0 / rate)
    }
}

impl FromParams for LinearSpringDashpot {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            normal_stiffness: params.get("normal_stiffness"),
            tangential_stiffness: params.get("tangential_stiffness"),
            normal_damping_rate: params.get("normal_damping_rate"),
            tangential_damping_rate: params.get("tangential_damping_rate"),
            friction: ["friction", "wall_friction", "intruder_friction"].map(|key| params.get(key)),
        }
    }
}

const CHANNELS: &[Channel] = &[
    Channel { name: "normal", kind: ChannelKind::Stored },
    Channel { name: "tangential", kind: ChannelKind::Stored },
    Channel { name: "normal-damping", kind: ChannelKind::Dissipated },
    Channel { name: "tangential-damping", kind: ChannelKind::Dissipated },
    Channel { name: "sliding", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[
    ParamSpec::required("normal_stiffness", Dimension::STIFFNESS, "k_n, force per overlap")
        .allowed(Range::POSITIVE)
        .usual(1e2, 1e8),
    ParamSpec::required(
        "tangential_stiffness",
        Dimension::STIFFNESS,
        "k_t, force per length of the tangential spring",
    )
    .same_as("normal_stiffness")
    .allowed(Range::POSITIVE)
    .usual(1e2, 1e8),
    ParamSpec::required(
        "normal_damping_rate",
        Dimension::RATE,
        "γ_n, damping force per reduced mass and normal velocity",
    )
    .usual(0.0, 1e6),
    ParamSpec::required(
        "tangential_damping_rate",
        Dimension::RATE,
        "γ_t, damping force per reduced mass and slip velocity",
    )
    .or(0.0)
    .usual(0.0, 1e6),
    ParamSpec::number("friction", "μ, Coulomb limit of the tangential force over |F_n|")
        .usual(0.0, 1.5),
    ParamSpec::number("wall_friction", "μ between grains and walls")
        .same_as("friction")
        .usual(0.0, 1.5),
    ParamSpec::number("intruder_friction", "μ between grains and the intruder")
        .same_as("friction")
        .usual(0.0, 1.5),
];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactBase,
    summary: "Linear normal and tangential springs with mass-scaled damping and a Coulomb limit.",
    formula: "F_n = k_n δ + m_r γ_n dδ/dt;  F_t = −(k_t ξ + m_r γ_t v_t), |F_t| ≤ μ |F_n|",
    signature: "The base law of a bed; μ sets the depth-linear friction, γ_n the restitution.",
    source: "Wang, Ye & Zheng, Eur. Phys. J. E 35, 7 (2012), eqs 3–4; Cundall & Strack (1979)",
    params: PARAMS,
    ..LawEntry::of::<LinearSpringDashpot>()
};

#[cfg(test)]
mod tests {
    use engine::lanes::Record;
    use engine::math::Vec3;

    use super::*;

    /// γ = 0, μ = 1/2; overlap of 1e-4 m, so F_n = 0.1 N and the limit is 0.05 N.
    const FRICTION: f64 = 0.5;
    const STIFFNESS: f64 = 1000.0;

    fn act(
        damping_rate: f64,
        slip_step: f64,
        slip_rate: f64,
        history: &mut Memory<f64, 3>,
    ) -> Outcome {
        let law = LinearSpringDashpot {
            normal_stiffness: STIFFNESS,
            tangential_stiffness: STIFFNESS,
            normal_damping_rate: 0.0,
            tangential_damping_rate: damping_rate,
            friction: [FRICTION; 3],
        };
        let contact = Contact {
            normal: Vec3::z(),
            overlap: 1e-4,
            overlap_rate: 0.0,
            overlap_step: 0.0,
            slip_velocity: Vec3::x() * slip_rate,
            slip_step: Vec3::x() * slip_step,
            relative_spin: Vec3::zeros(),
            relative_turn: Vec3::zeros(),
            inverse_radius_eff: 1e3,
            inverse_radius_eff_before: 1e3,
            inverse_mass_eff: 1e4,
            rolling_mobility: 1e9,
        };
        let (mut response, mut energy) = (Response::default(), Record::zero());
        let pair = law.pair(Partner::Grain);
        LinearSpringDashpot::act(&pair, &contact, 1e-5, history, &mut response, &mut energy);
        Outcome { response, energy }
    }

    struct Outcome {
        response: Response,
        energy: Energy<f64>,
    }

    /// Sums of a handful of terms of order one.
    fn close(value: f64, expected: f64) -> bool {
        (value - expected).abs() <= 1e-14 * expected.abs().max(1e-3)
    }

    #[test]
    fn a_sliding_contact_resists_with_friction_times_the_normal_force_and_cuts_its_spring() {
        let mut history = Record::zero();
        let slip = 1e-3;
        let Outcome { response, energy } = act(0.0, slip, 100.0, &mut history);
        let limit = FRICTION * response.normal_force;
        assert!(close(response.normal_force, 0.1));
        assert!(close(response.tangential_force.x, -limit));
        assert!(close(history.spring.x, limit / STIFFNESS));
        // From no force to the limit, so half the limit on average, over what was not stored.
        assert!(close(energy.sliding, 0.5 * limit * (slip - history.spring.x)));
        // From the limit on, all of it over all of the way.
        let Outcome { energy, .. } = act(0.0, slip, 100.0, &mut history);
        assert!(close(energy.sliding, limit * slip));
    }

    #[test]
    fn a_sliding_contact_drops_its_viscous_part() {
        let mut history = Record::zero();
        let Outcome { response, energy } = act(8e3, 1e-6, 0.1, &mut history);
        assert!(close(response.tangential_force.x, -FRICTION * response.normal_force));
        assert!(close(history.spring.x, -response.tangential_force.x / STIFFNESS));
        assert!(close(energy.tangential_damping, 0.0));
        assert!(close(history.damping.0.tangential.norm(), 0.0));
    }

    #[test]
    fn a_sticking_contact_gives_back_what_its_spring_took() {
        let mut history = Record::zero();
        let there = act(0.0, 2e-5, 2.0, &mut history);
        assert!(close(there.response.tangential_force.x, -2e-5 * STIFFNESS));
        assert!(close(there.energy.tangential, 0.5 * STIFFNESS * 2e-5 * 2e-5));
        let back = act(0.0, -2e-5, -2.0, &mut history);
        assert!(close(back.response.tangential_force.x, 0.0));
        assert!(close(back.energy.tangential, 0.0));
        assert!(close(there.energy.sliding + back.energy.sliding, 0.0));
    }
}
