//! Forces on single grains, each in a file of its own and one line of [`GRAIN_FORCES`].

mod pore_air;
mod side_wall;

use engine::grain_force::GrainForce;
use engine::params::{ParamSpec, ParamTable};

/// One force on single grains.
pub struct GrainForceEntry {
    /// The name in TOML, kebab-case; the ledger has a channel of this name.
    pub name: &'static str,
    /// Whether it acts on discs alone.
    pub planar: bool,
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
    /// Makes it from SI values that fill `params`.
    pub build: fn(&ParamTable) -> Box<dyn GrainForce>,
}

/// Every force on single grains, in the order of the docs.
pub static GRAIN_FORCES: &[&GrainForceEntry] = &[&pore_air::ENTRY, &side_wall::ENTRY];

/// The force called `name`.
#[must_use]
pub fn find_grain_force(name: &str) -> Option<&'static GrainForceEntry> {
    GRAIN_FORCES.iter().find(|entry| entry.name == name).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::grain_force::Motion;
    use engine::math::Vec3;
    use engine::params::Default;

    #[test]
    fn no_force_gives_energy_to_a_grain_and_none_acts_on_one_at_rest() {
        for entry in GRAIN_FORCES {
            let mut params = ParamTable::new();
            for spec in entry.params {
                let value = if let Default::Value(value) = spec.default {
                    value
                } else {
                    spec.plausible.max
                };
                params.set(spec.key, value);
            }
            let force = (entry.build)(&params);
            assert_eq!(force.name(), entry.name);
            let still = Motion {
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                radius: 2e-3,
                mass: 5e-5,
                gravity: 9.81,
            };
            let none = force.on(&still);
            assert!(none.force.norm() + none.torque.norm() < 1e-300, "{}", entry.name);
            for k in 0..50 {
                let angle = 0.1 * f64::from(k);
                let velocity = Vec3::new(libm::cos(angle), 0.0, libm::sin(3.0 * angle));
                let moving = Motion { velocity, spin: Vec3::y() * (angle - 2.0), ..still };
                let load = force.on(&moving);
                let power = load.force.dot(&moving.velocity) + load.torque.dot(&moving.spin);
                assert!(power < 0.0, "{}: {power}", entry.name);
            }
        }
    }
}
