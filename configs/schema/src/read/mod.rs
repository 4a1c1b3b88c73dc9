//! From tables to a [`Model`]: one function per table, in the order of the resolved text.

use engine::grains::Space;
use engine::params::ParamSpec;

use crate::diagnostics::{Diagnostic, Span};
use crate::model::{EnergySettings, Model};
use crate::reader::{Answer, TableReader};
use crate::specs;

mod bed;
mod bed_file;
mod container;
mod fit;
mod fluid;
mod foreign;
mod grains;
mod impact;
mod laws;
mod own_effect;
mod resistive;
mod sizes;
mod step;

pub(crate) use bed_file::DataFolder;
pub use fluid::fluid;
pub(crate) use own_effect::{KEYS_OF_PARAMETER, PARAMETERS, formula_fault};

/// Where the values stand that semantic checks compare.
#[derive(Default)]
pub(crate) struct Places {
    pub(crate) kind: Option<Span>,
    pub(crate) duration: Option<Span>,
    pub(crate) time_step: Option<Span>,
    pub(crate) time_step_factor: Option<Span>,
    pub(crate) preparation_time_step: Option<Span>,
    pub(crate) gravity: Option<Span>,
    pub(crate) fluid: Option<Span>,
    pub(crate) width: Option<Span>,
    pub(crate) depth: Option<Span>,
    pub(crate) target_packing_fraction: Option<Span>,
    pub(crate) target_height: Option<Span>,
    pub(crate) grains: Vec<BodyPlaces>,
    pub(crate) normal_stiffness: Option<Span>,
    pub(crate) intruder: BodyPlaces,
    pub(crate) speed: Option<Span>,
    pub(crate) angle: Option<Span>,
    pub(crate) spin: Option<Span>,
    pub(crate) x: Option<Span>,
    pub(crate) x_range: Option<Span>,
    pub(crate) condition_x: Vec<Option<Span>>,
    pub(crate) condition_speed: Vec<Option<Span>>,
    pub(crate) condition_angle: Vec<Option<Span>>,
    pub(crate) conditions: Option<Span>,
    pub(crate) positions: Option<Span>,
    pub(crate) interval: Option<Span>,
    pub(crate) coefficients: Vec<Option<Span>>,
    /// The formulas of user-defined effects, by their names.
    pub(crate) own_forces: Vec<(String, Option<Span>)>,
}

/// Where the size, the mass (or density) and the count of a body stand.
#[derive(Clone, Copy, Default)]
pub(crate) struct BodyPlaces {
    pub(crate) diameter: Option<Span>,
    pub(crate) mass: Option<Span>,
    pub(crate) count: Option<Span>,
}

/// Reads everything. `None` when something required could not be read; that is reported then.
pub(crate) fn model(root: TableReader<'_>, folder: &DataFolder<'_>) -> Option<(Model, Places)> {
    let mut places = Places::default();
    let tables = CommonTables {
        run: root.table("run", Some(RUN_EXAMPLE)),
        log: root.table("log", None),
        energy: root.table("energy", None),
        medium: root.table("medium", Some(MEDIUM_EXAMPLE)),
    };
    places.kind = tables.medium.span_of("kind");
    let model = match is_resistive(&tables.medium) {
        true => resistive::model(&root, tables, &mut places),
        false => grains::model(&root, tables, folder, &mut places),
    };
    root.finish();
    Some((model?, places))
}

/// The tables that every model may have and that stand first, so that they are resolved first.
struct CommonTables<'a> {
    run: TableReader<'a>,
    log: TableReader<'a>,
    energy: TableReader<'a>,
    medium: TableReader<'a>,
}

const RUN_EXAMPLE: &str =
    "name = \"my-run\"\nduration = \"0.6 s\"\ntime_step = \"10 us\"\nseed = 1";
const MEDIUM_EXAMPLE: &str = "kind = \"grains\"\ndimension = 2\ngravity = \"9.81 m/s^2\"";

/// An intruder for a bed of this space.
fn intruder_example(space: Space) -> &'static str {
    match space {
        Space::Planar => "shape = \"disc\"\ndiameter = \"4 cm\"\nmass = \"30 g\"",
        Space::Spatial => "shape = \"sphere\"\ndiameter = \"25.4 mm\"\nmass = \"67 g\"",
    }
}

const IMPACT_EXAMPLE: &str = "speed = \"2 m/s\"\nangle = \"90 deg\"";

fn is_resistive(table: &TableReader<'_>) -> bool {
    let kind = table.has("kind").then(|| table.peek_text("kind")).flatten();
    kind.is_some_and(|kind| kind == "resistive-force")
}

/// The kinds of medium, by `[medium] kind`.
const KINDS: &[&str] = &["grains", "resistive-force"];

fn energy(table: TableReader<'_>) -> Option<EnergySettings> {
    let abort_above = table.number(&specs::ABORT_ABOVE);
    table.finish();
    Some(EnergySettings { abort_above: abort_above?.value })
}

/// (m²) from a diameter (m).
fn disc_area(diameter: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter * diameter
}

/// (m³) from a diameter (m).
fn sphere_volume(diameter: f64) -> f64 {
    std::f64::consts::PI / 6.0 * diameter * diameter * diameter
}

/// `mass`, or `density` times `size`, an area or a volume.
fn mass(
    table: &TableReader<'_>,
    spec: &ParamSpec,
    density: &ParamSpec,
    size: Option<f64>,
) -> Option<f64> {
    table.can_do_without("mass");
    table.asks(density.key, density.meaning, || Answer::Number(*density));
    let (has_mass, has_density) = (table.has("mass"), table.has("density"));
    match (has_mass, has_density) {
        (true, true) => {
            table.reader.report(
                Diagnostic::error("both `mass` and `density` are given")
                    .at(table.span_of("density"), "one follows from the other")
                    .with(table.span_of("mass"), "the mass")
                    .help("keep one of the two"),
            );
            None
        }
        (false, true) => {
            let density = table.quiet_number(density)?;
            let mass = density.value * size?;
            table.note(spec, mass);
            Some(mass)
        }
        _ => table.number(spec).map(|found| found.value),
    }
}
