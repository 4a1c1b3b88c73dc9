//! The log of a run that another program made.

use std::path::Path;

use super::schema::{Fields, Layouts};
use super::values::{encode_loads, finite};
use super::{LogSetup, RecordError, RunLog, Stamp};
use crate::math::Vec3;

impl RunLog {
    /// Starts the log of a run of another program in `dir`. It has the channels of any other, less the
    /// fields that only the engine knows: `unaccounted_J` and `closure` of the energy budget, whose terms
    /// are then not all there are, and `contacts` and `area_m2` of the load. Energies and loads go
    /// through [`known_energies`](Self::known_energies) and [`body_forces`](Self::body_forces).
    ///
    /// # Errors
    /// A setup that cannot be logged, or the file system's refusal.
    pub fn import(dir: &Path, setup: &LogSetup) -> Result<Self, RecordError> {
        Self::open(
            dir,
            setup,
            Layouts::imported(&setup.energy_terms, &setup.force_origins),
            |[_, partial, _]| partial,
        )
    }

    /// Writes what is known of the energies (J) of a step, in the order of [`LogSetup::energy_terms`].
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If there is not one value per term.
    pub fn known_energies(&mut self, at: Stamp, values: &[f64]) -> Result<(), RecordError> {
        assert_eq!(values.len(), self.energy_terms.len(), "one value per energy term");
        let mut fields = Fields::begin(&mut self.buffer, at.step, at.time_s);
        for (value, term) in values.iter().zip(&self.energy_terms) {
            finite(at, || term.clone(), &[*value])?;
            fields.number(*value);
        }
        self.run.write(self.ids.energy, at.encode()?, &self.buffer)
    }

    /// Writes the forces (N) and torques (N m) on a body in a step, a pair for each of
    /// [`LogSetup::force_origins`].
    ///
    /// # Errors
    /// A value that is not finite, or the file system's refusal.
    ///
    /// # Panics
    /// If there is not one pair per origin.
    pub fn body_forces(
        &mut self,
        at: Stamp,
        body: usize,
        loads: &[(Vec3, Vec3)],
    ) -> Result<(), RecordError> {
        assert_eq!(loads.len(), self.n_origins, "one force and one torque per origin");
        let mut fields = Fields::begin(&mut self.buffer, at.step, at.time_s);
        let pairs = loads.iter().map(|(force, torque)| (force, torque));
        encode_loads(at, &self.bodies[body], &mut fields, pairs)?;
        self.run.write(self.ids.loads[body], at.encode()?, &self.buffer)
    }
}
