//! Forces on single grains, each in a file of its own and one line of [`GRAIN_FORCES`].

mod fluid;
mod pore_air;
mod side_wall;

use engine::grain_force::GrainForce;
use engine::grains::Space;
use engine::params::{ParamSpec, ParamTable};

use crate::candidate::Candidacy;

/// One force on single grains.
pub struct GrainForceEntry {
    /// The name in TOML, kebab-case; the ledger has a dissipated channel of this name.
    pub name: &'static str,
    /// The only space in which it acts, and why; `None` if it acts in both.
    pub only_in: Option<(Space, &'static str)>,
    /// What it is, in one sentence.
    pub summary: &'static str,
    /// The law as a formula, in plain text.
    pub formula: &'static str,
    /// What it does to depth, stopping time and forces.
    pub signature: &'static str,
    /// Paper and equation.
    pub source: &'static str,
    /// The parameters it takes.
    pub params: &'static [ParamSpec],
    /// Whether the diagnosis of a bed looks for it.
    pub candidacy: Candidacy,
    /// Makes it from SI values that fill `params`.
    pub build: fn(&ParamTable) -> Box<dyn GrainForce>,
}

/// Every force on single grains, in the order of the docs.
pub static GRAIN_FORCES: &[&GrainForceEntry] =
    &[&pore_air::ENTRY, &fluid::ENTRY, &side_wall::ENTRY];

/// The force called `name`.
pub fn find_grain_force(name: &str) -> Option<&'static GrainForceEntry> {
    GRAIN_FORCES.iter().find(|entry| entry.name == name).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::grain_force::{ForceOnGrain, MOST_FORCES, MovingGrain};
    use engine::math::Vec3;

    /// A disc of glass that moves and turns as given (m/s, rad/s).
    fn disc(velocity: Vec3, spin: Vec3) -> MovingGrain {
        MovingGrain { velocity, spin, radius: 2e-3, mass: 5e-5, weight: 5e-5 * 9.81 }
    }

    #[test]
    fn no_force_gives_energy_to_a_grain_and_none_acts_on_one_at_rest() {
        for entry in GRAIN_FORCES {
            let mut params = ParamTable::new();
            entry.params.iter().for_each(|spec| params.set(spec.key, spec.plausible.max));
            let force = (entry.build)(&params);
            assert_eq!(force.name(), entry.name);
            let none = force.on(&disc(Vec3::zeros(), Vec3::zeros()));
            assert!(none.force.norm() + none.torque.norm() < 1e-300, "{}", entry.name);
            // No motion is braked faster than it says: this one creeps and turns slowly.
            let creeping = disc(Vec3::x() * 1e-9, Vec3::y() * 1e-6);
            let ForceOnGrain { force: drag, torque } = force.on(&creeping);
            let moving_mass = creeping.mass + force.surrounding(creeping.radius).added_mass;
            let rate = drag.norm() / (moving_mass * 1e-9);
            let inertia = 0.5 * creeping.mass * creeping.radius * creeping.radius;
            let fastest = rate.max(torque.norm() / (inertia * 1e-6));
            // The square root of the smoothed speed costs a few roundings.
            assert!((fastest * force.relaxation_time(&creeping) - 1.0).abs() < 1e-9, "{fastest}");
            for k in 0..50 {
                let angle = 0.1 * f64::from(k);
                let velocity = Vec3::new(libm::cos(angle), 0.0, libm::sin(3.0 * angle));
                let moving = disc(velocity, Vec3::y() * (angle - 2.0));
                let power = force.on(&moving).power(&moving);
                assert!(power < 0.0, "{}: {power}", entry.name);
            }
        }
    }

    #[test]
    fn a_bed_has_room_for_all_of_them_at_once() {
        assert!(GRAIN_FORCES.len() <= MOST_FORCES);
    }
}
