//! Cohesion as a constant pull, as Derjaguin, Muller and Toporov have it.

use std::f64::consts::PI;

use engine::contact::{Contact, ContactLaw, Partner, Response, Slot};
use engine::lanes::Lanes;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, ParamTable};
use engine::units::Dimension;

use crate::adhesion::{Bond, Energy, Pull};
use crate::candidate::{Candidacy, Candidate, Need};
use crate::registry::{ActsOn, FromParams, LawEntry};

/// A constant attraction while two bodies overlap.
///
/// F_a = 2π W R*   (N), so F_n falls by F_a while δ > 0, and the two part at that pull
///
/// Friction is measured by what the base law alone presses with. On any base law; Hertz's gives what the
/// source has, for small, stiff grains that adhere weakly.
///
/// Channels: `cohesion-dmt`, stored: −F_a δ, what the pull has done while closing, and has to be given
/// back while opening; dissipated: nothing but the share of the step in which the force jumps, of either
/// sign, at most F_a v dt/2.
///
/// Source: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 314 (1975).
pub(crate) struct CohesionDmt {
    work_of_adhesion: f64,
}

/// The law, the same for every partner.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    /// 2π W (N/m).
    pull_per_radius: f64,
}

impl ContactLaw for CohesionDmt {
    const NAME: &'static str = "cohesion-dmt";
    const SLOT: Slot = Slot::Normal;
    const CHANNELS: &'static [Channel] = CHANNELS;
    type Pair = Pair;
    type History<R: Lanes, const N: usize> = Bond<R>;
    type Energy<R: Lanes> = Energy<R>;

    fn pair(&self, _: Partner) -> Pair {
        Pair { pull_per_radius: std::f64::consts::TAU * self.work_of_adhesion }
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
        let force = R::splat(pair.pull_per_radius) * contact.radius_eff();
        let pull = Pull { force: -force, adhesive_force: force, stored: -force * contact.overlap };
        history.act((contact.overlaps(), pull), contact, response, energy);
    }
}

impl FromParams for CohesionDmt {
    fn from_params(params: &ParamTable) -> Self {
        Self { work_of_adhesion: params.get("work_of_adhesion") }
    }
}

const CHANNELS: &[Channel] = &[
    Channel { name: "cohesion-dmt", kind: ChannelKind::Stored },
    Channel { name: "cohesion-dmt", kind: ChannelKind::Dissipated },
];

const PARAMS: &[ParamSpec] = &[ParamSpec::required(
    "work_of_adhesion",
    Dimension::SURFACE_ENERGY,
    "W, energy per area that parting the surfaces takes, twice the surface energy",
)
.usual(1e-4, 10.0)];

/// The registry's line.
pub(crate) const ENTRY: LawEntry = LawEntry {
    acts_on: ActsOn::ContactEffect,
    summary: "Cohesion of dry grains: a constant pull while they touch (DMT).",
    formula: "F_n → F_n − 2π W R* while δ > 0;  friction is measured without it",
    signature: "A constant resistance: shallow impacts stop earlier, crater walls stand.",
    source: "Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 314 (1975)",
    params: PARAMS,
    candidacy: Candidacy::Candidate(Candidate {
        amplitude: "pull-off over the weight of a mean grain",
        screen: 5.0,
        range: (0.0, 100.0),
        separable_from: "from capillary-bridge: grains that are pulled apart; from friction: slow impacts",
        alike_below: &["rail-friction", "capillary-bridge"],
        needs: &[Need::Gravity],
        // Two equal grains have R* = r/2 and part at 2π W R*.
        params: |grain, q| vec![("work_of_adhesion", q * grain.weight / (PI * grain.radius))],
    }),
    ..LawEntry::of::<CohesionDmt>()
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::tests::{OVERLAP, RADIUS_EFF, acted, close, contact};
    use engine::lanes::Record;

    const WORK: f64 = 0.05;

    #[test]
    fn grains_that_touch_pull_with_two_pi_w_r_and_store_what_that_did() {
        let pair = CohesionDmt { work_of_adhesion: WORK }.pair(Partner::Grain);
        let pull = 2.0 * PI * WORK * RADIUS_EFF;
        let mut bond = Record::zero();
        let closing = Contact { overlap_step: 1.5 * OVERLAP, ..contact() };
        let (response, energy) = acted::<CohesionDmt>(&pair, &closing, &mut bond);
        assert!(close(response.normal_force, -pull) && close(response.adhesive_force, pull));
        assert!(close(energy.stored, -pull * OVERLAP));
        // The mean force of the step, half the pull, over 1.5 overlaps; it acted over one.
        assert!((energy.dissipated - pull * OVERLAP * (1.0 - 0.75)).abs() < 1e-14 * pull * OVERLAP);
        let open = Contact { overlap: -1e-9, overlap_step: -2.0 * OVERLAP, ..contact() };
        let (response, energy) = acted::<CohesionDmt>(&pair, &open, &mut bond);
        assert!(!response.holds && response.normal_force.abs() < 1e-300);
        assert!(energy.stored.abs() < 1e-300 && energy.dissipated.abs() < 1e-14 * pull * OVERLAP);
    }
}
