//! Cohesion as Johnson, Kendall and Roberts have it: the contact area grows, and holds on.

use std::f64::consts::PI;

use engine::contact::{Contact, ContactLaw, Encounter, Partner, Response, Slot};
use engine::lanes::Lanes;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable};
use engine::units::Dimension;

use crate::adhesion::{Bond, Energy, Pull};
use crate::candidate::Candidacy;
use crate::hertz::{Elastic, params};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// What adhesion adds to Hertz's force: the contact pulls with 8/9 of the pull-off force 3/2 π W R* when
/// it is touched, and lets go when the bodies are apart by (3/4) (π² W² R*/E*²)^{1/3}.
///
/// F = 4 E* a³/(3 R*) − √(8π W E*) a^{3/2}, δ = a²/R* − √(2π W a/E*)   (N, m), a the contact radius (m)
///
/// F_n grows by F − 4/3 E* √R* δ^{3/2}, while open by F. Friction is measured by F_n and twice the
/// pull-off force; its spring is that of Hertz's contact radius and lets go when δ returns to zero.
///
/// With a = a_c u² and a_c³ = π W R*²/(8 E*) the radius at release, u solves u⁴ − 4u = 3 δ/δ_c, and
/// F = π W R* (u⁶/6 − u³); the root of the quartic is taken in closed form.
///
/// Channels: `cohesion-jkr`, stored: the energy of the contact beyond Hertz's, zero at first touch;
/// dissipated: what is stored at release, 7.09 (W⁵ R*⁴/E*²)^{1/3} per touch, and of either sign the share
/// of a step in which the force jumps.
///
/// Source: Johnson, Kendall & Roberts, Proc. R. Soc. Lond. A 324, 301 (1971); friction: Thornton & Yin,
/// Powder Technol. 65, 153 (1991).
pub(crate) struct CohesionJkr {
    work_of_adhesion: f64,
    elastic: [Elastic; 3],
}

/// The law for one kind of partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    /// W (J/m²).
    work_of_adhesion: f64,
    elastic: Elastic,
}

impl Pair {
    /// δ at which it lets go, without its sign: (3/4) (π² W² R*/E*²)^{1/3} (m).
    fn release_gap<R: Lanes>(&self, radius_eff: R) -> R {
        let length = PI * self.work_of_adhesion / self.elastic.modulus;
        R::splat(0.75) * (R::splat(length * length) * radius_eff).map_lanes(libm::cbrt)
    }

    fn pull<R: Lanes>(&self, overlap: R, radius_eff: R) -> Pull<R> {
        let unit = R::splat(PI * self.work_of_adhesion) * radius_eff;
        let span = R::splat(4.0 / 3.0) * self.release_gap(radius_eff);
        let u = (overlap / span).map_lanes(root);
        let cube = u * u * u;
        let open = overlap.simd_max(R::zero());
        let hertz = self.elastic.normal_force((radius_eff * open).simd_sqrt(), open);
        let done = u.map_lanes(energy) - R::splat(energy_at_touch());
        Pull {
            force: unit * cube * (cube / R::splat(6.0) - R::one()) - hertz,
            adhesive_force: R::splat(3.0) * unit,
            stored: unit * span * done - R::splat(0.4) * hertz * open,
        }
    }
}

/// The largest u with u⁴ − 4u = 4d, for d from −3/4 on, where it is 1 (Ferrari, with Cardano's root of
/// m³ + 4 d m = 2 written without a difference of like numbers).
fn root(d: f64) -> f64 {
    let third = 4.0 / 3.0 * d;
    let big = libm::cbrt(1.0 + (1.0 + third * third * third).max(0.0).sqrt());
    let small = third / big;
    let m = 2.0 / (big * big + third + small * small);
    let inner = 4.0 * (2.0 / m).sqrt() - 2.0 * m;
    0.5 * ((2.0 * m).sqrt() + inner.max(0.0).sqrt())
}

/// ∫ (u⁶/6 − u³) d(u⁴/4 − u).
fn energy(u: f64) -> f64 {
    let (cube, fourth) = (u * u * u, u * u * u * u);
    fourth * (0.25 + cube * (cube / 60.0 - 1.0 / 6.0))
}

/// The same where δ = 0, u³ = 4.
fn energy_at_touch() -> f64 {
    -0.6 * libm::cbrt(4.0)
}

impl ContactLaw for CohesionJkr {
    const NAME: &'static str = "cohesion-jkr";
    const SLOT: Slot = Slot::Normal;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Bond<R>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, partner: Partner) -> Pair {
        let elastic = self.elastic[partner.index()];
        Pair { work_of_adhesion: self.work_of_adhesion, elastic }
    }

    #[inline(always)]
    fn act<R: Lanes, const N: usize>(
        pair: &Pair,
        contact: &Contact<R, N>,
        _dt: f64,
        history: &mut Bond<R>,
        response: &mut Response<R, N>,
        energy: &mut Energy<R>,
    ) {
        let radius = contact.radius_eff();
        let gap = pair.release_gap(radius);
        let held = contact.overlaps() | history.is_bound() & contact.overlap.simd_gt(-gap);
        let adheres = R::splat(pair.work_of_adhesion).simd_gt(R::zero());
        let pull = pair.pull(contact.overlap, radius);
        history.act((held & adheres, pull), contact, response, energy);
    }

    /// Half a swing about the overlap at which two bodies rest, u³ = 6.
    fn collision_time(pair: &Pair, encounter: &Encounter) -> Option<f64> {
        let radius = encounter.radius_eff;
        let span = 4.0 / 3.0 * pair.release_gap(radius);
        let u = libm::cbrt(6.0);
        let stiffness = PI * pair.work_of_adhesion * radius * u * u * 3.0 / (span * 5.0);
        (stiffness > 0.0).then(|| PI * (encounter.mass_eff / stiffness).sqrt())
    }

    fn reach(pair: &Pair, radius_eff: f64) -> f64 {
        pair.release_gap(radius_eff)
    }
}

impl FromParams for CohesionJkr {
    fn from_params(params: &ParamTable) -> Self {
        Self {
            work_of_adhesion: params.get("work_of_adhesion"),
            elastic: Partner::ALL.map(|partner| Elastic::of(params, partner)),
        }
    }
}

const CHANNELS: &[Channel] = &[
    Channel { name: "cohesion-jkr", kind: ChannelKind::Stored },
    Channel { name: "cohesion-jkr", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &params::specs_on_base(
    ParamSpec::required(
        "work_of_adhesion",
        Dimension::SURFACE_ENERGY,
        "W, energy per area that parting the surfaces takes, twice the surface energy",
    )
    .usual(1e-4, 10.0),
);

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "Cohesion of dry grains on a Hertz law: the contact area pulls and holds on (JKR).",
    formula: "F = 4 E* a³/(3 R*) − √(8π W E*) a^(3/2), δ = a²/R* − √(2π W a/E*), until \
              δ = −(3/4)(π² W² R*/E*²)^(1/3)",
    signature: "A constant resistance with hysteresis: grains stick, crater walls stand.",
    source: "Johnson, Kendall & Roberts, Proc. R. Soc. Lond. A 324, 301 (1971)",
    params: PARAMS,
    candidacy: Candidacy::None(
        "cohesion-dmt stands for it: grains let go at 3/2 π W R* and not 2π W R*, and depths and times do not \
         tell the two apart",
    ),
    ..LawEntry::of::<CohesionJkr>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::tests::{MODULUS, RADIUS_EFF, acted, beads, contact};
    use engine::lanes::Record;

    const WORK: f64 = 0.05;
    const UNIT: f64 = PI * WORK * RADIUS_EFF;

    fn pair() -> Pair {
        CohesionJkr::from_params(&beads(&[("work_of_adhesion", WORK)])).pair(Partner::Grain)
    }

    /// F (N), Hertz's part included, and its energy.
    fn force(overlap: f64) -> (f64, f64) {
        let pull = pair().pull(overlap, RADIUS_EFF);
        let open = overlap.max(0.0);
        let hertz = 4.0 / 3.0 * MODULUS * RADIUS_EFF.sqrt() * open * open.sqrt();
        (pull.force + hertz, pull.stored + 0.4 * hertz * open)
    }

    #[test]
    fn the_largest_pull_is_three_halves_pi_w_r() {
        let gap = pair().release_gap(RADIUS_EFF);
        // Ternary search: the pull has one greatest value.
        let (mut low, mut high) = (-gap, gap);
        for _ in 0..200 {
            let (left, right) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
            if force(left).0 > force(right).0 { low = left } else { high = right }
        }
        let (pull, _) = force(low);
        assert!((pull / UNIT + 1.5).abs() < 1e-10, "{}", pull / UNIT);
        // It is there that u³ = 3, so δ/δ_c = (3^{4/3} − 4 · 3^{1/3})/3.
        let place = (libm::pow(3.0, 4.0 / 3.0) - 4.0 * libm::cbrt(3.0)) / 3.0;
        assert!((low / gap - place).abs() < 1e-6, "{} {place}", low / gap);
    }

    #[test]
    fn a_touched_contact_pulls_with_eight_ninths_and_lets_go_at_five() {
        let gap = pair().release_gap(RADIUS_EFF);
        assert!((force(0.0).0 / UNIT + 4.0 / 3.0).abs() < 1e-13);
        // At release u is a double root: round-off of the overlap shows by its square root.
        assert!((force(-gap).0 / UNIT + 5.0 / 6.0).abs() < 1e-7);
        let length = PI * WORK / MODULUS;
        assert!((gap / (0.75 * libm::cbrt(length * length * RADIUS_EFF)) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy_and_of_hertz_where_it_is_pressed() {
        let gap = pair().release_gap(RADIUS_EFF);
        for overlap in [-0.9, -0.5, 0.1, 1.0, 30.0].map(|share| share * gap) {
            let h = 1e-4 * gap;
            let slope = (force(overlap + h).1 - force(overlap - h).1) / (2.0 * h);
            // A central difference is good to (h/δ_c)² and the round-off of the energy over h.
            let (expected, scale) = (force(overlap).0, force(overlap).0.abs().max(UNIT));
            assert!((slope - expected).abs() < 1e-7 * scale, "{overlap:e}: {slope} {expected}");
        }
        let pull = pair().pull(1e4 * gap, RADIUS_EFF);
        let (total, _) = force(1e4 * gap);
        assert!((pull.force / total).abs() < 1e-3, "a pressed contact is one of Hertz");
    }

    #[test]
    fn a_contact_holds_on_until_release_and_loses_there_what_it_stored() {
        let (pair, gap) = (pair(), pair().release_gap(RADIUS_EFF));
        let mut bond = Record::zero();
        let at = |overlap: f64| Contact { overlap, ..contact() };
        let open = |bond: &mut Bond<f64>| acted::<CohesionJkr>(&pair, &at(-0.5 * gap), bond);
        assert!(!open(&mut bond).0.holds, "nothing holds what never touched");
        acted::<CohesionJkr>(&pair, &at(1e-12), &mut bond);
        assert!(open(&mut bond).0.holds);
        let (_, held) = acted::<CohesionJkr>(&pair, &at(-gap * (1.0 - 1e-12)), &mut bond);
        let (response, lost) = acted::<CohesionJkr>(&pair, &at(-gap * (1.0 + 1e-12)), &mut bond);
        assert!(!response.holds && response.normal_force.abs() < 1e-300);
        let work = libm::cbrt(libm::pow(WORK, 5.0) * RADIUS_EFF.powi(4) / (MODULUS * MODULUS));
        // 7.09 is how the sources print it.
        assert!((lost.dissipated / work - 7.09).abs() < 5e-3, "{}", lost.dissipated / work);
        assert!((held.stored / lost.dissipated - 1.0).abs() < 1e-12);
    }
}
