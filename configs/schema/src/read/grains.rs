//! What only a model of grains has.

use engine::grains::Space;

use super::bed::bed;
use super::container::container;
use super::foreign::Foreign;
use super::impact::Pushed::IntoGrains;
use super::step::time_step;
use super::{CommonTables, DataFolder, KINDS, Places, energy, impact, intruder_example, laws};
use crate::limits;
use crate::model::{GrainLog, GrainMedium, LogSettings, Medium, Model, RunSettings, Stepping};
use crate::reader::{Answer, TableReader};
use crate::resolved::Resolved;
use crate::specs;

const CONTAINER_EXAMPLE: &str =
    "shape = \"box\"\nwidth = \"1 m\"\nsides = \"wall\"\nbottom = \"wall\"";
const BED_EXAMPLE: &str = "source = \"settle\"\n[[bed.grains]]\ncount = 1000\n\
                           diameter = \"5 mm\"\nmass = \"0.05 g\"";
const LAW_EXAMPLE: &str = "name = \"linear-spring-dashpot\"\nnormal_stiffness = \"3200 N/m\"\n\
                           normal_damping_rate = \"1e4 1/s\"\nfriction = 0.3";

/// A model of grains. `None` when something required could not be read.
pub(super) fn model(
    root: &TableReader<'_>,
    tables: CommonTables<'_>,
    folder: &DataFolder<'_>,
    places: &mut Places,
) -> Option<Model> {
    let foreign = Foreign { home: "resistive-force", here: ("grains", places.kind) };
    foreign.keys(&tables.log, "log", &["interval"]);
    foreign.keys(&tables.medium, "medium", &["bulk_density", "packing", "bed_depth"]);
    foreign.tables(root, &["resistance", "fit", "candidate"]);
    let run = run(tables.run, places);
    let log = log(tables.log);
    let energy = energy(tables.energy);
    let medium = medium(tables.medium, places);
    // What follows is read as for a plane where the dimension is missing, which has been said.
    let space = medium.map_or(Space::Planar, |(space, ..)| space);
    let container = container(root.table("container", Some(CONTAINER_EXAMPLE)), space, places);
    let contact_law = laws::contact_law(root.table("contact_law", Some(LAW_EXAMPLE)), places);
    let bed = bed(
        root.table("bed", Some(BED_EXAMPLE)),
        contact_law.as_ref(),
        (space, container.as_ref()),
        folder,
        places,
    );
    let tables = root.tables("effect", limits::EFFECTS);
    let effects = laws::effects_of_run(tables, space, contact_law.as_ref());
    let intruder =
        impact::in_grains(root.table("intruder", Some(intruder_example(space))), space, places);
    let impact_table = impact::start_table(root);
    let impact = match impact::is_pushed(root) {
        true => impact::intrusion(&impact_table, intruder.as_ref(), (IntoGrains, places)),
        false => impact::impact_on_grains(&impact_table, space, places),
    };
    let start = impact::start_positions(&impact_table, (space, container.as_ref()), places);
    impact_table.finish();
    let conditions = impact::conditions_on_grains(root.table("conditions", None), places);
    let (run, stepping) = run?;
    let (log, grain_log) = log?;
    let (effects, grain_forces) = effects?;
    Some(Model {
        run,
        log,
        energy: energy?,
        medium: Medium::Grains(Box::new(GrainMedium {
            space: medium?.0,
            gravity: medium?.1,
            grain_inertia: medium?.2,
            container: container?,
            bed: bed?,
            contact_law: contact_law?,
            effects,
            grain_forces,
            start: start?,
            stepping,
            log: grain_log,
        })),
        intruder: intruder?,
        impact: impact?,
        conditions: conditions?,
        lines: Resolved::default(),
        resolved: String::new(),
        bed_key: String::new(),
        hash: String::new(),
    })
}

fn run(table: TableReader<'_>, places: &mut Places) -> Option<(RunSettings, Stepping)> {
    let name = table.slug("name", None, "the name of the run and of its folder");
    let duration = table.number(&specs::DURATION);
    let time_step = time_step(&table, &specs::TIME_STEP, None);
    let factor = table.number(&specs::TIME_STEP_FACTOR);
    let seed = table.integer("seed", None, 0..=i64::MAX as u64, "the seed of everything random");
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
    let settings = RunSettings { name: name?.value, duration: duration?.value, seed: seed?.value };
    let stepping = Stepping {
        time_step: time_step?,
        time_step_factor: factor?.value,
        checkpoint_every: every?.value,
    };
    Some((settings, stepping))
}

fn log(table: TableReader<'_>) -> Option<(LogSettings, GrainLog)> {
    let flush_every = table.integer(
        "flush_every",
        Some(1000),
        1..=1_000_000_000,
        "the number of steps between flushes of the log",
    );
    let frames_per_s = table.number(&specs::FRAMES_PER_S);
    table.asks("grains", "whether frames of all grains are logged", || Answer::Boolean);
    let grains = table.boolean("grains", true);
    let fields_at = table.numbers(&specs::FIELDS_AT);
    table.finish();
    let settings = LogSettings { frames_per_s: frames_per_s?.value };
    let fields_at = fields_at?.unwrap_or_default().into_iter().map(|found| found.value).collect();
    Some((settings, GrainLog { flush_every: flush_every?.value, grains: grains?, fields_at }))
}

/// `[medium]`: discs or spheres, the magnitude of gravity (m/s²), and what grains resist turning with, over
/// m r², if the file says so.
fn medium(table: TableReader<'_>, places: &mut Places) -> Option<(Space, f64, Option<f64>)> {
    let kind = table.choice("kind", KINDS, &[], "the kind of medium");
    let dimension = table.integer("dimension", None, 2..=3, "the number of space dimensions");
    let gravity = table.number(&specs::GRAVITY);
    places.gravity = table.span_of("gravity");
    let inertia = table.optional_number(&specs::GRAIN_INERTIA);
    table.finish();
    kind?;
    let space = match dimension?.value {
        2 => Space::Planar,
        _ => Space::Spatial,
    };
    Some((space, gravity?.value, inertia?.map(|found| found.value)))
}
