//! Hertz's normal force and Mindlin's tangential spring, which laws damp in different ways.

mod constants;
pub(crate) mod params;
mod restitution;

use engine::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use engine::lanes::{Coarse, Lanes, Mask, Vector, select_vector, shortened, vector_where};
use engine::ledger::{Channel, ChannelKind};
use engine::params::ParamTable;

pub(crate) use constants::Elastic;
pub use restitution::damping_ratio;

use crate::damped::Damped;
use crate::registry::FromParams;

/// How a law damps.
pub(crate) trait Damping: Copy + Send + Sync + 'static {
    /// The name of the law in TOML.
    const NAME: &'static str;
    /// From the parameters of the law, for contacts with `partner`, which have these constants.
    fn of(elastic: &Elastic, values: &ParamTable, partner: Partner) -> Self;
    /// c_n and c_t (N s/m) at contact radius a = `contact_radius` (m) and m* = `mass_eff` (kg).
    fn coefficients<R: Lanes>(&self, contact_radius: R, mass_eff: R) -> [R; 2];
}

/// A law for one kind of partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair<D> {
    pub(crate) elastic: Elastic,
    pub(crate) damping: D,
    /// μ (–).
    pub(crate) friction: f64,
}

/// A base law that damps in the way of `D`.
pub(crate) struct Law<D> {
    pairs: [Pair<D>; 3],
}

impl<D: Damping> ContactLaw for Law<D> {
    const NAME: &'static str = D::NAME;
    const SLOT: Slot = Slot::Base;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair<D>;
    type History<R: Lanes, const N: usize> = Memory<R, N>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, partner: Partner) -> Pair<D> {
        self.pairs[partner.index()]
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair<D>,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut Memory<R, N>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        act(pair, contact, history, response, energy);
    }

    fn collision_time(pair: &Pair<D>, encounter: &Encounter) -> Option<f64> {
        Some(pair.elastic.collision_time(encounter))
    }

    fn damping_time(pair: &Pair<D>, encounter: &Encounter) -> Option<f64> {
        damping_time(pair, encounter)
    }

    fn wave_time(pair: &Pair<D>, radius: f64, density: f64) -> Option<f64> {
        Some(pair.elastic.wave_time(radius, density))
    }
}

impl<D: Damping> FromParams for Law<D> {
    fn from_params(values: &ParamTable) -> Self {
        let pair = |partner| {
            let elastic = Elastic::of(values, partner);
            let friction = params::friction(values, partner);
            Pair { damping: D::of(&elastic, values, partner), elastic, friction }
        };
        Self { pairs: Partner::ALL.map(pair) }
    }
}

engine::record! {
    /// What a contact remembers.
    pub(crate) struct Memory<R, const N: usize> {
        /// ξ (m).
        spring: Vector<R, N>,
        /// k_t at the end of the last step (N/m).
        tangential_stiffness: R,
        damping: Coarse<Damped<R, N>>,
    }
}

engine::record! {
    /// One number (J) per channel.
    pub(crate) struct Energy<R> {
        pub(crate) normal: R,
        pub(crate) tangential: R,
        pub(crate) normal_damping: R,
        pub(crate) tangential_damping: R,
        pub(crate) sliding: R,
        pub(crate) stiffness_change: R,
    }
}

/// The accounts of every law of this kind.
pub(crate) const CHANNELS: &[Channel] = &[
    Channel { name: "normal", kind: ChannelKind::Stored },
    Channel { name: "tangential", kind: ChannelKind::Stored },
    Channel { name: "normal-damping", kind: ChannelKind::Dissipated },
    Channel { name: "tangential-damping", kind: ChannelKind::Dissipated },
    Channel { name: "sliding", kind: ChannelKind::Dissipated },
    Channel { name: "stiffness-change", kind: ChannelKind::Dissipated },
];

/// With a = √(R* δ) the contact radius:
///
/// F_n = max(0, 4/3 E* a δ + c_n dδ/dt)   (N), of which damping is what is not elastic
///
/// F_t = −(k_t ξ + c_t v_t), k_t = 8 G* a, |F_t| ≤ μ (F_n + F_a)
///
/// ξ (m) sums up the slip, is turned with the contact plane and cut back to −F_t/k_t above the limit,
/// where the viscous part is dropped. A contact that opens loses force in proportion to k_t: were force
/// kept instead, the spring would give back more than it took. What k_t gives and takes while ξ stays
/// is `stiffness-change`, below zero while the contact closes.
///
/// Effects that damp or attract have had their say: damping takes no more than what they and the
/// elastic force leave.
#[inline(always)]
pub(crate) fn act<D: Damping, R: Lanes, const N: usize>(
    pair: &Pair<D>,
    contact: &Contact<R, N>,
    history: &mut Memory<R, N>,
    response: &mut Response<R, N>,
    energy: &mut Energy<R>,
) {
    let (zero, half) = (R::zero(), R::splat(0.5));
    let Coarse(damped) = history.damping;
    let touching = contact.overlaps();
    let overlap = contact.overlap.simd_max(zero);
    let a = (overlap / contact.inverse_radius_eff).simd_sqrt();
    let elastic = pair.elastic.normal_force(a, overlap);
    // Both vanish with a where nothing touches.
    let [c_n, c_t] = pair.damping.coefficients(a, contact.mass_eff());

    let spare = (elastic + response.normal_force + response.adhesive_force).simd_max(zero);
    // Damping never takes more than the elastic force, also where adhesion would hold the two together.
    let damping = (c_n * contact.overlap_rate).simd_max(-spare.simd_min(elastic));
    energy.normal += R::splat(0.4) * elastic * overlap;
    let [now, before] = [contact.inverse_radius_eff, contact.inverse_radius_eff_before];
    if now.simd_ne(before).any() {
        // Over an edge or along a cone the same overlap holds another energy.
        let half_way = (overlap - half * contact.overlap_step).simd_max(zero);
        let held = |curvature| pair.elastic.energy(curvature, half_way);
        energy.stiffness_change += held(before) - held(now);
    }
    energy.normal_damping += half * (damped.normal + damping) * contact.overlap_step;

    let k_t = pair.elastic.tangential_stiffness(a);
    let before = contact.turn(history.spring);
    let stretched = before + contact.slip_step;
    let viscous = contact.slip_velocity * c_t;
    let trial = -(stretched * k_t + viscous);
    let limit = R::splat(pair.friction) * (spare + damping);
    let (force, slides) = shortened(trial, limit);
    // A contact that attraction holds open has no spring that could come back.
    let cut_back = vector_where(touching, force * (-R::one() / k_t));
    let spring = select_vector(slides, cut_back, stretched);
    let viscous = vector_where(!slides, viscous);
    let softening = half * (history.tangential_stiffness - k_t) * before.dot(&spring);
    let pull = before * history.tangential_stiffness + spring * k_t;
    energy.sliding += (half * pull.dot(&(stretched - spring))).select(touching, softening);
    energy.stiffness_change += softening.select(touching, zero);
    energy.tangential += half * k_t * spring.dot(&spring);
    energy.tangential_damping += half * (damped.tangential + viscous).dot(&contact.slip_step);

    *history = Memory {
        spring: vector_where(touching, spring),
        tangential_stiffness: k_t,
        damping: Coarse(Damped { normal: damping, tangential: viscous }),
    };
    response.normal_force += elastic + damping;
    response.normal_stiffness += pair.elastic.normal_stiffness(a);
    response.tangential_force += force;
}

/// In how short a time (s) damping acts at the largest overlap of `encounter`.
pub(crate) fn damping_time<D: Damping>(pair: &Pair<D>, encounter: &Encounter) -> Option<f64> {
    let a = pair.elastic.largest_contact_radius(encounter);
    let [c_n, c_t] = pair.damping.coefficients(a, encounter.mass_eff);
    // Spin makes a contact lighter along its plane: 1 + m R²/I, 3.5 for spheres, 3 for discs.
    let rate = c_n.max(3.5 * c_t) / encounter.mass_eff;
    (rate > 0.0).then(|| 1.0 / rate)
}

#[cfg(test)]
pub(crate) mod tests {
    use engine::contact::{ContactLaw, Partner};
    use engine::lanes::Record;
    use engine::math::Vec3;
    use engine::params::ParamTable;

    use super::*;

    /// Glass beads of 1 mm, so R* = 0.5 mm; μ = 1/2.
    pub(crate) fn beads(more: &[(&'static str, f64)]) -> ParamTable {
        let mut params = ParamTable::new();
        for body in [
            ["young_modulus", "poisson_ratio", "friction"],
            ["wall_young_modulus", "wall_poisson_ratio", "wall_friction"],
            ["intruder_young_modulus", "intruder_poisson_ratio", "intruder_friction"],
        ] {
            for (key, value) in body.into_iter().zip([70e9, 0.25, 0.5]) {
                params.set(key, value);
            }
        }
        for &(key, value) in more {
            params.set(key, value);
        }
        params
    }

    /// E* and G* of the beads (Pa).
    pub(crate) const MODULUS: f64 = 70e9 / (2.0 * (1.0 - 0.0625));
    const SHEAR_MODULUS: f64 = 70e9 / (2.0 * 1.25) / (2.0 * 1.75);
    pub(crate) const OVERLAP: f64 = 1e-7;
    pub(crate) const RADIUS_EFF: f64 = 5e-4;

    /// Two beads at [`OVERLAP`], at rest.
    pub(crate) fn contact() -> Contact {
        Contact {
            normal: Vec3::z(),
            overlap: OVERLAP,
            overlap_rate: 0.0,
            overlap_step: 0.0,
            slip_velocity: Vec3::zeros(),
            slip_step: Vec3::zeros(),
            relative_spin: Vec3::zeros(),
            relative_turn: Vec3::zeros(),
            inverse_radius_eff: 1.0 / RADIUS_EFF,
            inverse_radius_eff_before: 1.0 / RADIUS_EFF,
            inverse_mass_eff: 1e5,
            rolling_mobility: 1e9,
        }
    }

    /// What `pair` of the law `L` answers and books.
    pub(crate) fn acted<L: ContactLaw>(
        pair: &L::Pair,
        contact: &Contact,
        history: &mut L::History<f64, 3>,
    ) -> (Response, L::Energy<f64>) {
        let (mut response, mut energy) = (Response::default(), Record::zero());
        L::act(pair, contact, 1e-7, history, &mut response, &mut energy);
        (response, energy)
    }

    #[derive(Clone, Copy)]
    struct Undamped;

    impl Damping for Undamped {
        const NAME: &'static str = "undamped";

        fn of(_: &Elastic, _: &ParamTable, _: Partner) -> Self {
            Self
        }

        fn coefficients<R: Lanes>(&self, _: R, _: R) -> [R; 2] {
            [R::zero(); 2]
        }
    }

    fn undamped(contact: &Contact, history: &mut Memory<f64, 3>) -> (Response, Energy<f64>) {
        let (mut response, mut energy) = (Response::default(), Record::zero());
        let elastic = Elastic::of(&beads(&[]), Partner::Grain);
        let pair = Pair { elastic, damping: Undamped, friction: 0.5 };
        act(&pair, contact, history, &mut response, &mut energy);
        (response, energy)
    }

    /// Sums of a handful of terms of the size of `expected`.
    pub(crate) fn close(value: f64, expected: f64) -> bool {
        (value - expected).abs() <= 1e-14 * expected.abs()
    }

    #[test]
    fn the_force_is_that_of_hertz_and_its_slope_the_stiffness() {
        let (response, energy) = undamped(&contact(), &mut Record::zero());
        let a = (RADIUS_EFF * OVERLAP).sqrt();
        assert!(close(response.normal_force, 4.0 / 3.0 * MODULUS * a * OVERLAP));
        assert!(close(response.normal_stiffness, 2.0 * MODULUS * a));
        assert!(close(energy.normal, 8.0 / 15.0 * MODULUS * a * OVERLAP * OVERLAP));
    }

    #[test]
    fn a_small_slip_is_resisted_by_mindlin_s_spring_and_a_large_one_by_friction() {
        let a = (RADIUS_EFF * OVERLAP).sqrt();
        let (k_t, mut history) = (8.0 * SHEAR_MODULUS * a, Record::zero());
        let slip = 1e-10;
        let slid = |by: f64| Contact { slip_step: Vec3::x() * by, ..contact() };
        let (response, energy) = undamped(&slid(slip), &mut history);
        assert!(close(response.tangential_force.x, -k_t * slip));
        assert!(close(energy.tangential, 0.5 * k_t * slip * slip));
        let (response, energy) = undamped(&slid(1e-5), &mut history);
        let limit = 0.5 * response.normal_force;
        assert!(close(response.tangential_force.x, -limit));
        let slipped = slip + 1e-5 - limit / k_t;
        assert!(close(energy.sliding, 0.5 * (k_t * slip + limit) * slipped));
    }

    #[test]
    fn what_a_spring_gains_or_loses_with_its_stiffness_is_booked() {
        let mut history = Record::zero();
        let slip = 1e-10;
        undamped(&Contact { slip_step: Vec3::x() * slip, ..contact() }, &mut history);
        let k_t = history.tangential_stiffness;
        let (response, energy) =
            undamped(&Contact { overlap: 4.0 * OVERLAP, ..contact() }, &mut history);
        assert!(close(response.tangential_force.x, -2.0 * k_t * slip));
        assert!(close(energy.stiffness_change, -0.5 * k_t * slip * slip));
        let (response, energy) = undamped(&Contact { overlap: -1e-9, ..contact() }, &mut history);
        assert!(response.tangential_force.norm() < 1e-300);
        assert!(close(energy.sliding, k_t * slip * slip) && energy.tangential < 1e-300);
    }
}
