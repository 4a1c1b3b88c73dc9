//! The elastic constants of a pair of materials.

use std::f64::consts::PI;

use engine::contact::{Encounter, Partner};
use engine::lanes::Lanes;
use engine::params::ParamTable;

/// The elastic constants for contacts of grains with one kind of partner.
///
/// 1/E* = Σ (1 − ν²)/E, 1/G* = Σ (2 − ν)/G, G = E/(2 (1 + ν)), summed over both bodies; a = √(R* δ) is
/// the contact radius (m).
///
/// Source: Johnson, Contact Mechanics (1985), eqs 4.22–4.24; Mindlin, J. Appl. Mech. 16, 259 (1949).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Elastic {
    /// E* (Pa).
    pub(crate) modulus: f64,
    /// G* (Pa).
    pub(crate) shear_modulus: f64,
    /// Time of a surface wave through a grain, over its radius and the root of its density.
    wave_slowness: f64,
}

/// One body's material.
#[derive(Clone, Copy)]
struct Material {
    young_modulus: f64,
    poisson_ratio: f64,
}

impl Material {
    fn compliance(self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.young_modulus
    }

    fn shear_modulus(self) -> f64 {
        0.5 * self.young_modulus / (1.0 + self.poisson_ratio)
    }

    fn shear_compliance(self) -> f64 {
        (2.0 - self.poisson_ratio) / self.shear_modulus()
    }
}

impl Elastic {
    /// From the parameters of [`super::params`].
    pub(crate) fn of(params: &ParamTable, partner: Partner) -> Self {
        let [young_modulus, poisson_ratio] = match partner {
            Partner::Grain => ["young_modulus", "poisson_ratio"],
            Partner::Wall => ["wall_young_modulus", "wall_poisson_ratio"],
            Partner::Intruder => ["intruder_young_modulus", "intruder_poisson_ratio"],
        };
        let material = |young_modulus, poisson_ratio| Material {
            young_modulus: params.get(young_modulus),
            poisson_ratio: params.get(poisson_ratio),
        };
        let grain = material("young_modulus", "poisson_ratio");
        let other = material(young_modulus, poisson_ratio);
        Self {
            modulus: 1.0 / (grain.compliance() + other.compliance()),
            shear_modulus: 1.0 / (grain.shear_compliance() + other.shear_compliance()),
            wave_slowness: PI
                / (grain.shear_modulus().sqrt() * (0.1631 * grain.poisson_ratio + 0.8766)),
        }
    }

    /// 4/3 E* a δ (N).
    #[inline(always)]
    pub(crate) fn normal_force<R: Lanes>(&self, a: R, overlap: R) -> R {
        R::splat(4.0 / 3.0 * self.modulus) * a * overlap
    }

    /// 8/15 E* a δ² (J), what an overlap holds where 1/R* is `curvature` (1/m).
    #[inline(always)]
    pub(crate) fn energy<R: Lanes>(&self, curvature: R, overlap: R) -> R {
        R::splat(0.4) * self.normal_force((overlap / curvature).simd_sqrt(), overlap) * overlap
    }

    /// S_n = 2 E* a (N/m), the slope of the force.
    #[inline(always)]
    pub(crate) fn normal_stiffness<R: Lanes>(&self, a: R) -> R {
        R::splat(2.0 * self.modulus) * a
    }

    /// k_t = 8 G* a (N/m).
    #[inline(always)]
    pub(crate) fn tangential_stiffness<R: Lanes>(&self, a: R) -> R {
        R::splat(8.0 * self.shear_modulus) * a
    }

    /// Duration (s) of a head-on collision without damping: 2.87 (m*²/(R* E*² v))^{1/5}, Johnson (1985),
    /// eq. 11.24.
    pub(crate) fn collision_time(&self, encounter: &Encounter) -> f64 {
        let Encounter { mass_eff, radius_eff, speed } = *encounter;
        let stiffness = mass_eff / self.modulus;
        2.868_265_7 * libm::pow(stiffness * stiffness / (radius_eff * speed), 0.2)
    }

    /// The contact radius (m) at the largest overlap of a head-on collision without damping.
    pub(crate) fn largest_contact_radius(&self, encounter: &Encounter) -> f64 {
        let Encounter { mass_eff, radius_eff, speed } = *encounter;
        let swing = 15.0 / 16.0 * mass_eff * speed * speed / (self.modulus * radius_eff.sqrt());
        (radius_eff * libm::pow(swing, 0.4)).sqrt()
    }

    /// Time (s) of a Rayleigh wave through a grain, π R √(ρ/G)/(0.1631 ν + 0.8766).
    ///
    /// Source: Ning & Ghadiri, Chem. Eng. Sci. 61, 5991 (2006).
    pub(crate) fn wave_time(&self, radius: f64, density: f64) -> f64 {
        self.wave_slowness * radius * density.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_bodies_and_a_rigid_wall_have_the_moduli_of_the_books() {
        let params = ParamTable::from_iter([
            ("young_modulus", 70e9),
            ("poisson_ratio", 0.3),
            ("wall_young_modulus", 1e300),
            ("wall_poisson_ratio", 0.3),
        ]);
        let (pair, wall) =
            (Elastic::of(&params, Partner::Grain), Elastic::of(&params, Partner::Wall));
        let (modulus, shear) = (70e9 / (1.0 - 0.09), 70e9 / (2.0 * 1.3));
        // Round-off of a handful of operations.
        let close = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-15 * 4.0;
        assert!(close(pair.modulus, 0.5 * modulus) && close(wall.modulus, modulus));
        assert!(close(pair.shear_modulus, 0.5 * shear / 1.7), "{pair:?}");
        assert!(close(wall.shear_modulus, shear / 1.7), "{wall:?}");
    }
}
