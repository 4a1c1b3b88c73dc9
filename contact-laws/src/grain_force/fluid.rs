//! A fluid at rest that fills the bed and the space above it.

use std::f64::consts::PI;

use engine::fluid::Fluid;
use engine::grain_force::{ForceOnGrain, GrainForce, MovingGrain, Surrounding};
use engine::grains::Space;
use engine::math::Vec3;
use engine::params::{ParamSpec, ParamTable, Range};
use engine::units::Dimension;

use super::GrainForceEntry;
use crate::candidate::Candidacy;

/// Buoyancy, drag and added mass of a fluid at rest, on every grain and on the intruder, a sphere of the same volume.
///
/// A sphere of volume V and diameter d meets ρ_f V g upward, −½ ρ_f V dv/dt, and
///
/// F = −¾ ρ_f V/d (0.63 √|v| + 4.8 √(η/(ρ_f d)))² v   (N)
///
/// ([`Fluid::resistance`]). Neighbours raise the drag on a grain, by the factor
/// `hindrance`: at a porosity ε it is ε^(1 − χ) with χ from 3.05 to 3.7 (Di Felice), which is 7 to 12 at ε = 0.4.
///
/// The fluid does not flow: it takes no momentum from grain to grain, and no pressure builds up in the pores of a bed that
/// shears. Lubrication and the torque on a sphere that turns are left out. On the bed as it settles nothing of it acts.
///
/// Source: Dallavalle, Micromeritics (1948), for C_D; Di Felice, Int. J. Multiphase Flow 20, 153 (1994); Lamb,
/// Hydrodynamics, §92 (1932), for the added mass of a sphere.
struct Surrounds {
    fluid: Fluid,
    hindrance: f64,
}

impl Surrounds {
    /// Force over velocity (kg/s) on a sphere of `radius` (m) at `speed` (m/s), far from others.
    fn resistance(&self, radius: f64, speed: f64) -> f64 {
        self.fluid.resistance(2.0 * radius, PI * radius * radius, speed)
    }

    /// The same on a grain among others.
    fn resistance_on(&self, grain: &MovingGrain) -> f64 {
        self.hindrance * self.resistance(grain.radius, grain.velocity.norm())
    }
}

fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

impl GrainForce for Surrounds {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn on(&self, grain: &MovingGrain) -> ForceOnGrain {
        ForceOnGrain { force: grain.velocity * -self.resistance_on(grain), torque: Vec3::zeros() }
    }

    fn relaxation_time(&self, grain: &MovingGrain) -> f64 {
        (grain.mass + self.surrounding(grain.radius).added_mass) / self.resistance_on(grain)
    }

    fn surrounding(&self, radius: f64) -> Surrounding {
        let volume = sphere_volume(radius);
        Surrounding {
            displaced_mass: self.fluid.density * volume,
            added_mass: self.fluid.added_mass(2.0 * radius, volume),
        }
    }

    fn on_intruder(&self, part: &MovingGrain) -> Option<Vec3> {
        Some(part.velocity * -self.resistance(part.radius, part.velocity.norm()))
    }
}

const PARAMS: &[ParamSpec] = &[
    ParamSpec::required("density", Dimension::DENSITY, "ρ_f, density of the fluid")
        .allowed(Range::POSITIVE)
        .usual(0.1, 2e3),
    ParamSpec::required("viscosity", Dimension::VISCOSITY, "η, viscosity of the fluid")
        .usual(1e-6, 10.0),
    ParamSpec::number("hindrance", "factor on the drag on grains, for their neighbours")
        .or(1.0)
        .usual(1.0, 100.0),
];

/// The registry's line.
pub(super) const ENTRY: GrainForceEntry = GrainForceEntry {
    name: "fluid",
    only_in: Some((Space::Spatial, "the density of a fluid is that of a volume")),
    summary: "A fluid at rest in the bed and above it: buoyancy, drag and added mass of grains and intruder.",
    formula: "F = ρ_f V g − ½ ρ_f V dv/dt − ¾ ρ_f V/d (0.63 √|v| + 4.8 √(η/(ρ_f d)))² v",
    signature: "Grains weigh less, so that friction grows less with depth; fast impacts are braked before contact too.",
    source: "Dallavalle, Micromeritics (1948); Di Felice, Int. J. Multiphase Flow 20, 153 (1994); Lamb, Hydrodynamics (1932)",
    params: PARAMS,
    candidacy: Candidacy::None("the model states its fluid, which an experimenter knows"),
    build: |params: &ParamTable| {
        Box::new(Surrounds {
            fluid: Fluid { density: params.get("density"), viscosity: params.get("viscosity") },
            hindrance: params.get("hindrance"),
        })
    },
};

#[cfg(test)]
mod tests {
    use super::*;

    const WATER: Surrounds =
        Surrounds { fluid: Fluid { density: 998.0, viscosity: 1.002e-3 }, hindrance: 1.0 };

    /// A sphere with this speed (m/s) along x.
    fn moving(radius: f64, speed: f64) -> MovingGrain {
        let velocity = Vec3::x() * speed;
        MovingGrain { velocity, spin: Vec3::zeros(), radius, mass: 1e-3, weight: 9.81e-3 }
    }

    #[test]
    fn the_drag_is_that_of_the_standard_curve_within_its_fit() {
        // Re and C_D of a sphere: Clift, Grace & Weber, Bubbles, Drops, and Particles (1978), chapter 5.
        for (reynolds, standard, within) in [
            (0.1, 244.0, 0.15),
            (1.0, 27.2, 0.15),
            (10.0, 4.26, 0.15),
            (100.0, 1.09, 0.15),
            (1000.0, 0.471, 0.3),
            (10_000.0, 0.405, 0.15),
        ] {
            let radius = 2e-3;
            let speed = reynolds * WATER.fluid.viscosity / (WATER.fluid.density * 2.0 * radius);
            let force = -WATER.on(&moving(radius, speed)).force.x;
            let area = PI * radius * radius;
            let coefficient = force / (0.5 * WATER.fluid.density * area * speed * speed);
            assert!((coefficient / standard - 1.0).abs() < within, "{reynolds}: {coefficient}");
        }
    }

    #[test]
    fn a_slow_sphere_meets_a_force_in_proportion_to_its_speed_close_to_that_of_stokes() {
        let (radius, speed) = (1e-4, 1e-8);
        let force = WATER.on_intruder(&moving(radius, speed)).expect("it acts there").x;
        let stokes = -6.0 * PI * WATER.fluid.viscosity * radius * speed;
        // 4.8² for 24.
        assert!((force / stokes - 0.96).abs() < 1e-3, "{}", force / stokes);
    }

    #[test]
    fn neighbours_raise_the_drag_on_grains_alone_and_it_displaces_its_volume() {
        let crowded = Surrounds { hindrance: 10.0, ..WATER };
        let grain = moving(1e-3, 0.1);
        let ratio = crowded.on(&grain).force.x / WATER.on(&grain).force.x;
        assert!((ratio - 10.0).abs() < 1e-12);
        assert_eq!(crowded.on_intruder(&grain), WATER.on_intruder(&grain));
        let Surrounding { displaced_mass, added_mass } = WATER.surrounding(1e-3);
        assert!((displaced_mass / 4.1804e-6 - 1.0).abs() < 1e-4, "{displaced_mass}");
        assert!((added_mass - 0.5 * displaced_mass).abs() < 1e-18);
    }
}
