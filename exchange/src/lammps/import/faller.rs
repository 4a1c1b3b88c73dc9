//! The intruder of a run of LAMMPS: what it looks like, how it is turned, how deep its lowest point
//! is.

use std::path::Path;
use std::sync::Arc;

use engine::body::Followed;
use engine::math::{Quat, Vec3, cayley, turned_about_y};
use engine::params::ParamTable;
use engine::record::{BodySample, LoggedShape};
use engine::surface::Surface;
use intruders::find;
use runner::run::shape_of;

use super::super::facts::{Facts, Intruder};
use super::super::samples::Sample;
use super::error::ImportError;

/// The energies that are known of a run of LAMMPS, as plunge calls them.
pub(super) const ENERGIES: [&str; 6] = [
    "kinetic_intruder_translation_J",
    "kinetic_intruder_rotation_J",
    "kinetic_grains_translation_J",
    "kinetic_grains_rotation_J",
    "potential_intruder_J",
    "potential_grains_J",
];

/// The intruder that falls.
pub(super) struct Faller<'a> {
    facts: &'a Facts,
    surface: Arc<dyn Surface>,
    /// As it is drawn.
    pub(super) drawn: LoggedShape,
}

/// The intruder at a sample.
#[derive(Clone, Copy)]
pub(super) struct Turned<'a> {
    pub(super) sample: &'a Sample,
    /// Body frame to world.
    pub(super) orientation: Quat,
}

impl<'a> Faller<'a> {
    /// What `facts`, read from `path`, say of it.
    pub(super) fn of(facts: &'a Facts, path: &Path) -> Result<Self, ImportError> {
        let Intruder { shape, parameters, .. } = &facts.intruder;
        let refused = |why| ImportError::Misread { path: path.to_owned(), why };
        let entry = find(shape)
            .ok_or_else(|| refused(format!("intruder.shape: there is no shape \"{shape}\"")))?;
        let mut params = ParamTable::new();
        for spec in entry.params {
            let value = parameters.get(spec.key).ok_or_else(|| {
                refused(format!("intruder.parameters: a {shape} has a `{}`", spec.key))
            })?;
            params.set(spec.key, *value);
        }
        let surface = (entry.build)(&params, facts.space()).surface;
        Ok(Self { facts, surface, drawn: shape_of(entry, &params, facts.space()) })
    }

    /// It at each of `samples`, turned on from one to the next by their spins.
    pub(super) fn turned<'s>(&self, samples: &'s [Sample]) -> Vec<Turned<'s>> {
        let mut orientation = turned_about_y(self.facts.intruder.attitude_rad);
        let mut before = &samples[0];
        let turned = samples.iter().map(|sample| {
            let turn = 0.5 * (before.spin + sample.spin) * (sample.time - before.time);
            orientation = cayley(turn) * orientation;
            before = sample;
            Turned { sample, orientation }
        });
        turned.collect()
    }

    /// Radius of the smallest sphere about its centre of mass that holds it (m).
    pub(super) fn radius(&self) -> f64 {
        self.surface.bounding_radius()
    }

    /// How far its lowest point lies below its centre of mass (m).
    fn reach(&self, orientation: Quat) -> f64 {
        self.surface.support(orientation.inverse_transform_vector(&-Vec3::z()).normalize())
    }

    pub(super) fn state(&self, at: Turned<'_>) -> BodySample {
        let Sample { position, velocity, spin, .. } = *at.sample;
        let depth_m = self.facts.surface_m - (position.z - self.reach(at.orientation));
        BodySample { position, velocity, spin, depth_m }
    }

    pub(super) fn followed(&self, at: Turned<'_>) -> Followed {
        let Sample { position, velocity, .. } = *at.sample;
        Followed { position, velocity, reach: self.reach(at.orientation) }
    }

    /// What is known of the energies, in the order of [`ENERGIES`] (J).
    pub(super) fn energies(&self, at: Turned<'_>) -> [f64; 6] {
        let Turned { sample, orientation } = at;
        let [translation, rotation, height] = sample.energies;
        let Intruder { mass_kg: mass, inertia_kg_m2: inertia, .. } = self.facts.intruder;
        let spin = orientation.inverse_transform_vector(&sample.spin);
        [
            0.5 * mass * sample.velocity.norm_squared(),
            0.5 * spin.dot(&Vec3::from(inertia).component_mul(&spin)),
            translation,
            rotation,
            mass * self.facts.gravity_m_per_s2 * sample.position.z,
            height,
        ]
    }
}
