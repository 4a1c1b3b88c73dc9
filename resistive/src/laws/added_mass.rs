//! Grains that move with the intruder.

use crate::{Account, Flow, Immersion, Load, Motion, ResistanceLaw, Surroundings};
use engine::fluid::added_mass_of_spheroid;
use engine::ledger::{Channel, ChannelKind};
use engine::params::{ParamSpec, Range};

use super::facts::{Confounder, Facts, Kind, Needs};
use super::registry::{OtherForm, ResistanceEntry, Role, amplitude};

/// (m + m_a) a = … − r dm_a/dt v,  m_a = q ρ V(z) (2 k)^s   (kg)
///
/// k is the coefficient of the spheroid with the diameter and the volume of the body, 1/2 of a sphere
/// ([`added_mass_of_spheroid`]): with s = 1 a blunt cone moves more than a sharp one of as much volume.
///
/// With r = 1 grains come in at rest and the body gives them their momentum: their kinetic energy is held, as much
/// again is lost in setting them in motion. With r = 1/2 nothing is lost, as in a fluid without viscosity; with less
/// the medium brings momentum of its own.
///
/// Sources: added-mass foot model of Aguilar & Goldman, Nature Phys. 12, 278 (2016), with the immersed volume in place
/// of its cone; Lamb, Hydrodynamics (1932), §137, for r = 1/2.
struct AddedMass {
    q: f64,
    recruitment: f64,
    shape_exponent: f64,
}

const ACCOUNTS: &[Account] = &[
    Account {
        channel: Channel { name: "added-mass", kind: ChannelKind::Stored },
        flow: Flow::AddedMass,
    },
    Account {
        channel: Channel { name: "added-mass", kind: ChannelKind::Dissipated },
        flow: Flow::Recruitment,
    },
];

/// The registry's line.
pub(super) const ENTRY: ResistanceEntry = ResistanceEntry {
    name: "added-mass",
    role: Role::Effect(Facts {
        kind: Kind::Physics,
        unit: "1",
        visible: &[],
        separable_from: &[
            Confounder { effect: "buoyancy", any_of: &[Needs::Masses] },
            Confounder { effect: "yield-stress", any_of: &[Needs::Masses] },
        ],
    }),
    summary: "Grains that move with the intruder and add to its inertia.",
    formula: "(m + q rho V (2k)^s) dv/dt = ... - r q rho dV/dt (2k)^s v",
    signature: "lower deceleration, longer and deeper path; a jerk at entry",
    source: "Aguilar & Goldman, Nature Phys. 12, 278 (2016)",
    params: &[
        amplitude(
            Range::closed(0.0, 50.0),
            Range::closed(0.0, 5.0),
            "moving grains in units of the displaced bed",
        ),
        ParamSpec::number(
            "recruitment",
            "share r of the momentum of new grains that the body gives: 1 from rest, 0.5 without loss",
        )
        .or(1.0)
        .allowed(Range::closed(0.0, 1.0))
        .plausible(Range::closed(0.0, 1.0)),
        ParamSpec::number(
            "shape_exponent",
            "power s of twice the added mass of a spheroid: 0 for the displaced volume alone, 1 for blunt and sharp bodies in a fluid",
        )
        .or(0.0)
        .allowed(Range::closed(0.0, 2.0))
        .plausible(Range::closed(0.0, 1.0)),
    ],
    forms: &[
        OtherForm { values: &[("recruitment", 0.5)], needs: &[] },
        OtherForm { values: &[("recruitment", 0.0)], needs: &[] },
        OtherForm {
            values: &[("recruitment", 0.5), ("shape_exponent", 1.0)],
            needs: &[Needs::Shapes],
        },
    ],
    variables: &[],
    accounts: ACCOUNTS,
    build: |given| {
        Box::new(AddedMass {
            q: given.get("q"),
            recruitment: given.get("recruitment"),
            shape_exponent: given.get("shape_exponent"),
        })
    },
};

impl AddedMass {
    fn shape_factor(&self, at: &Immersion) -> f64 {
        if self.shape_exponent <= 0.0 {
            return 1.0;
        }
        // In space this is the ratio of the axes of the spheroid; in a plane it is a measure of the shape.
        let slenderness = 1.5 * at.body_volume / (at.frontal_area * at.diameter);
        libm::pow(2.0 * added_mass_of_spheroid(slenderness), self.shape_exponent)
    }
}

impl ResistanceLaw for AddedMass {
    fn accounts(&self) -> &'static [Account] {
        ACCOUNTS
    }

    fn act(&self, at: &Immersion, _: &Motion, bed: &Surroundings, load: &mut Load) {
        let density = self.q * bed.bulk_density * self.shape_factor(at);
        load.added_mass += density * at.volume;
        load.growth += density * at.volume_rate;
        load.recruitment += self.recruitment * density * at.volume_rate;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{SPHERE, sinking, surroundings};
    use super::*;

    #[test]
    fn mass_is_recruited_as_fast_as_the_volume_grows() {
        let bed = surroundings();
        let (mut here, mut deeper) = (Load::default(), Load::default());
        let law = AddedMass { q: 2.0, recruitment: 1.0, shape_exponent: 0.0 };
        let at = SPHERE.at(0.01);
        let at = Immersion { volume_rate: 3.0 * at.section, ..at };
        law.act(&at, &sinking(3.0), &bed, &mut here);
        law.act(&SPHERE.at(0.01 + 3e-7), &sinking(3.0), &bed, &mut deeper);
        let rate = (deeper.added_mass - here.added_mass) / 1e-7;
        assert!((here.recruitment / rate - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_blunt_body_moves_more_than_a_sphere_of_its_volume_would_and_a_sphere_the_same() {
        let bed = surroundings();
        let mass = |body_volume: f64, shape_exponent: f64| {
            let mut load = Load::default();
            let at = Immersion { body_volume, ..SPHERE.at(0.01) };
            let law = AddedMass { q: 2.0, recruitment: 0.5, shape_exponent };
            law.act(&at, &sinking(3.0), &bed, &mut load);
            load.added_mass
        };
        let sphere = SPHERE.at(0.01).body_volume;
        assert!((mass(sphere, 1.0) / mass(sphere, 0.0) - 1.0).abs() < 1e-9);
        // Half as long as wide: α₀ by the eccentricity e (Lamb, Hydrodynamics, 1932, §373), k = α₀/(2 − α₀).
        let e = 0.75_f64.sqrt();
        let alpha = 2.0 / (e * e * e) * (e - 0.5 * libm::asin(e));
        let blunt = mass(0.5 * sphere, 1.0) / mass(0.5 * sphere, 0.0);
        assert!((blunt - 2.0 * alpha / (2.0 - alpha)).abs() < 1e-9, "{blunt}");
    }

    #[test]
    fn of_the_momentum_of_new_grains_the_body_gives_its_share() {
        let bed = surroundings();
        let at = SPHERE.at(0.01);
        let at = Immersion { volume_rate: 3.0 * at.section, ..at };
        let load = |recruitment| {
            let mut load = Load::default();
            AddedMass { q: 2.0, recruitment, shape_exponent: 0.0 }.act(
                &at,
                &sinking(3.0),
                &bed,
                &mut load,
            );
            load
        };
        let [all, half, none] = [1.0, 0.5, 0.0].map(load);
        assert!((half.recruitment / all.recruitment - 0.5).abs() < 1e-12);
        assert!(none.recruitment.abs() < 1e-300);
        assert!((all.growth / all.recruitment - 1.0).abs() < 1e-12);
        assert!((none.growth / all.growth - 1.0).abs() < 1e-12);
    }
}
