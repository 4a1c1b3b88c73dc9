//! A fluid in a bed and above it, of models of a resistive force and of measurements.

use engine::fluid::Fluid;

use crate::diagnostics::Diagnostic;
use crate::reader::TableReader;
use crate::specs::{FLUID_DENSITY, FLUID_VISCOSITY};

/// The fluid that `fluid_density` and `fluid_viscosity` of `table` state; the inner `None` means that neither key is there,
/// the outer one that an error was reported.
pub fn fluid(table: &TableReader<'_>) -> Option<Option<Fluid>> {
    let density = table.optional_number(&FLUID_DENSITY);
    let viscosity = table.optional_number(&FLUID_VISCOSITY);
    let (given, missing) = match (density?, viscosity?) {
        (Some(density), Some(viscosity)) => {
            return Some(Some(Fluid { density: density.value, viscosity: viscosity.value }));
        }
        (None, None) => return Some(None),
        (Some(density), None) => (density, FLUID_VISCOSITY.key),
        (None, Some(viscosity)) => (viscosity, FLUID_DENSITY.key),
    };
    table.reader.report(
        Diagnostic::error(format!("a fluid has a density and a viscosity: `{missing}` is missing"))
            .at(given.span, "a fluid is stated here")
            .help("water at 20 degrees: fluid_density = \"998 kg/m^3\", fluid_viscosity = \"1.0 mPa s\""),
    );
    None
}
