//! From tables to a [`Model`]: one function per table, in the order of the resolved text.

use engine::params::ParamSpec;

use crate::diagnostics::{Diagnostic, Span};
use crate::limits;
use crate::model::{Container, EnergySettings, LogSettings, Medium, Model, RunSettings, TimeStep};
use crate::reader::{Found, TableReader};
use crate::specs;

mod bed;
mod bed_file;
mod impact;
mod laws;

pub(crate) use bed_file::DataFolder;

/// Where the values stand that semantic checks compare.
#[derive(Default)]
pub(crate) struct Places {
    pub(crate) duration: Option<Span>,
    pub(crate) time_step: Option<Span>,
    pub(crate) time_step_factor: Option<Span>,
    pub(crate) preparation_time_step: Option<Span>,
    pub(crate) gravity: Option<Span>,
    pub(crate) width: Option<Span>,
    pub(crate) target_packing_fraction: Option<Span>,
    pub(crate) target_height: Option<Span>,
    pub(crate) grains: Vec<BodyPlaces>,
    pub(crate) normal_stiffness: Option<Span>,
    pub(crate) intruder: BodyPlaces,
    pub(crate) speed: Option<Span>,
    pub(crate) spin: Option<Span>,
    pub(crate) x: Option<Span>,
    pub(crate) x_range: Option<Span>,
    pub(crate) condition_x: Vec<Option<Span>>,
    pub(crate) condition_speed: Vec<Option<Span>>,
    pub(crate) conditions: Option<Span>,
    pub(crate) positions: Option<Span>,
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
    let run = run(root.table("run", Some(RUN_EXAMPLE)), &mut places);
    let log = log(root.table("log", None));
    let energy = energy(root.table("energy", None));
    let medium_table = root.table("medium", Some(MEDIUM_EXAMPLE));
    if is_resistive(&medium_table) {
        medium_table.choice("kind", &["grains"], &["resistive-force"], "the kind of medium");
        return None;
    }
    let medium = medium(medium_table, &mut places);
    let container = container(root.table("container", Some(CONTAINER_EXAMPLE)), &mut places);
    let contact_law = laws::contact_law(root.table("contact_law", Some(LAW_EXAMPLE)), &mut places);
    let bed = bed::bed(
        root.table("bed", Some(BED_EXAMPLE)),
        contact_law.as_ref(),
        container.as_ref(),
        folder,
        &mut places,
    );
    let effects = laws::effects(root.tables("effect", limits::EFFECTS));
    let intruder = impact::intruder(root.table("intruder", Some(INTRUDER_EXAMPLE)), &mut places);
    let impact =
        impact::impact(root.table("impact", Some(IMPACT_EXAMPLE)), container.as_ref(), &mut places);
    let conditions = impact::conditions(root.table("conditions", None), &mut places);
    root.finish();
    let model = Model {
        run: run?,
        log: log?,
        energy: energy?,
        medium: medium?,
        container: container?,
        bed: bed?,
        contact_law: contact_law?,
        effects: effects?,
        intruder: intruder?,
        impact: impact?,
        conditions: conditions?,
        resolved: String::new(),
        bed_key: String::new(),
        hash: String::new(),
    };
    Some((model, places))
}

const RUN_EXAMPLE: &str =
    "name = \"my-run\"\nduration = \"0.6 s\"\ntime_step = \"10 us\"\nseed = 1";
const MEDIUM_EXAMPLE: &str = "kind = \"grains\"\ndimension = 2\ngravity = \"9.81 m/s^2\"";
const CONTAINER_EXAMPLE: &str =
    "shape = \"box\"\nwidth = \"1 m\"\nsides = \"wall\"\nbottom = \"wall\"";
const BED_EXAMPLE: &str = "source = \"settle\"\n[[bed.grains]]\ncount = 1000\n\
                           diameter = \"5 mm\"\nmass = \"0.05 g\"";
const LAW_EXAMPLE: &str = "name = \"linear-spring-dashpot\"\nnormal_stiffness = \"3200 N/m\"\n\
                           normal_damping_rate = \"1e4 1/s\"\nfriction = 0.3";
const INTRUDER_EXAMPLE: &str = "shape = \"disc\"\ndiameter = \"4 cm\"\nmass = \"30 g\"";
const IMPACT_EXAMPLE: &str = "speed = \"2 m/s\"\nangle = \"90 deg\"";

fn is_resistive(table: &TableReader<'_>) -> bool {
    let kind = table.has("kind").then(|| table.peek_text("kind")).flatten();
    kind.is_some_and(|kind| kind == "resistive-force")
}

fn run(table: TableReader<'_>, places: &mut Places) -> Option<RunSettings> {
    let name = table.slug("name", None, "the name of the run and of its folder");
    let duration = table.number(&specs::DURATION);
    let time_step = time_step(&table, &specs::TIME_STEP, None);
    let factor = table.number(&specs::TIME_STEP_FACTOR);
    let largest = i64::MAX as u64;
    let seed = table.integer("seed", None, 0..=largest, "the seed of everything random");
    let every = table.integer(
        "checkpoint_every",
        Some(20_000),
        1..=1_000_000_000_000,
        "the number of steps between checkpoints",
    );
    places.duration = table.span_of("duration");
    places.time_step = table.span_of("time_step");
    places.time_step_factor = table.span_of("time_step_factor");
    table.finish();
    Some(RunSettings {
        name: name?.value,
        duration: duration?.value,
        time_step: time_step?,
        time_step_factor: factor?.value,
        seed: seed?.value,
        checkpoint_every: every?.value,
    })
}

fn log(table: TableReader<'_>) -> Option<LogSettings> {
    let flush_every = table.integer(
        "flush_every",
        Some(1000),
        1..=1_000_000_000,
        "the number of steps between flushes of the log",
    );
    let frames_per_s = table.number(&specs::FRAMES_PER_S);
    let grains = table.boolean("grains", true);
    table.finish();
    Some(LogSettings {
        flush_every: flush_every?.value,
        frames_per_s: frames_per_s?.value,
        grains: grains?,
    })
}

fn energy(table: TableReader<'_>) -> Option<EnergySettings> {
    let abort_above = table.number(&specs::ABORT_ABOVE);
    table.finish();
    Some(EnergySettings { abort_above: abort_above?.value })
}

fn medium(table: TableReader<'_>, places: &mut Places) -> Option<Medium> {
    let kind = table.choice("kind", &["grains"], &["resistive-force"], "the kind of medium");
    let dimension = table.integer("dimension", None, 2..=3, "the number of space dimensions");
    if let Some(Found { value: 3, span }) = dimension {
        table.reader.report(
            Diagnostic::error("dimension = 3 comes with a later version")
                .at(span, "not available yet")
                .help("available now: 2"),
        );
    }
    let gravity = table.number(&specs::GRAVITY);
    places.gravity = table.span_of("gravity");
    table.finish();
    kind?;
    Some(Medium {
        dimension: dimension.filter(|found| found.value == 2).map(|_| 2)?,
        gravity: gravity?.value,
    })
}

fn container(table: TableReader<'_>, places: &mut Places) -> Option<Container> {
    let shape = table.choice("shape", &["box"], &["cylinder"], "the shape of the container");
    let width = table.number(&specs::WIDTH);
    let sides = table.choice("sides", &["wall"], &["periodic", "absorbing"], "what the sides are");
    let bottom = table.choice("bottom", &["wall"], &["absorbing"], "what the bottom is");
    places.width = table.span_of("width");
    // The keys of a shape that is yet to come are not worth a second message.
    if shape.is_some() {
        table.finish();
    }
    shape.and(sides).and(bottom)?;
    Some(Container { width: width?.value })
}

/// A fixed step or `"auto"`.
fn time_step(table: &TableReader<'_>, spec: &ParamSpec, default: Option<&str>) -> Option<TimeStep> {
    let auto = match table.has(spec.key) {
        true => table.peek_text(spec.key) == Some("auto"),
        false => default == Some("auto"),
    };
    if auto {
        table.note_text(spec.key, "auto");
        return Some(TimeStep::Auto);
    }
    table.number(spec).map(|found| TimeStep::Fixed(found.value))
}

fn disc_area(diameter: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter * diameter
}

/// `mass`, or `density` times `area`.
fn mass(table: &TableReader<'_>, spec: &ParamSpec, area: Option<f64>) -> Option<f64> {
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
            let density = table.quiet_number(&specs::AREA_DENSITY)?;
            let mass = density.value * area?;
            table.note(spec, mass);
            Some(mass)
        }
        _ => table.number(spec).map(|found| found.value),
    }
}
