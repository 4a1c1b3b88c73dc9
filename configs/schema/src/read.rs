//! From tables to a [`Model`]: one function per table, in the order of the resolved text.

use contact_laws::{ActsOn, LawEntry};
use engine::params::{Default as ParamDefault, ParamSpec};

use crate::diagnostics::{Diagnostic, Span, nearest, shorten};
use crate::document::{Node, Value};
use crate::limits;
use crate::model::{
    Bed, BedSource, ConditionLists, Container, EnergySettings, GrainKind, Impact, Intruder,
    LawChoice, LogSettings, Medium, Model, RunSettings, Settle, TimeStep,
};
use crate::read_bed_file::{DataFolder, csv_bed};
use crate::reader::{Found, TableReader};
use crate::specs;

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

/// Where the size and the mass (or density) of a body stand.
#[derive(Clone, Copy, Default)]
pub(crate) struct BodyPlaces {
    pub(crate) diameter: Option<Span>,
    pub(crate) mass: Option<Span>,
}

/// Reads everything. `None` when something required could not be read; that is reported then.
pub(crate) fn model(root: TableReader<'_>, folder: &DataFolder<'_>) -> Option<(Model, Places)> {
    let mut places = Places::default();
    let run = run(root.table("run", Some(RUN_EXAMPLE)), &mut places);
    let log = log(root.table("log", None));
    let energy = energy(root.table("energy", None));
    let medium_table = root.table("medium", Some(MEDIUM_EXAMPLE));
    if is_resistive(&medium_table) {
        medium_table.choice(
            "kind",
            &["grains"],
            &["resistive-force"],
            "the kind of medium",
        );
        return None;
    }
    let medium = medium(medium_table, &mut places);
    let container = container(
        root.table("container", Some(CONTAINER_EXAMPLE)),
        &mut places,
    );
    let contact_law = contact_law(root.table("contact_law", Some(LAW_EXAMPLE)), &mut places);
    let bed = bed(
        root.table("bed", Some(BED_EXAMPLE)),
        contact_law.as_ref(),
        container.as_ref(),
        folder,
        &mut places,
    );
    let effects = effects(root.tables("effect", limits::EFFECTS));
    let intruder = intruder(root.table("intruder", Some(INTRUDER_EXAMPLE)), &mut places);
    let impact = impact(
        root.table("impact", Some(IMPACT_EXAMPLE)),
        container.as_ref(),
        &mut places,
    );
    let conditions = conditions(root.table("conditions", None), &mut places);
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
    Some(EnergySettings {
        abort_above: abort_above?.value,
    })
}

fn medium(table: TableReader<'_>, places: &mut Places) -> Option<Medium> {
    let kind = table.choice(
        "kind",
        &["grains"],
        &["resistive-force"],
        "the kind of medium",
    );
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
    let shape = table.choice(
        "shape",
        &["box"],
        &["cylinder"],
        "the shape of the container",
    );
    let width = table.number(&specs::WIDTH);
    let sides = table.choice(
        "sides",
        &["wall"],
        &["periodic", "absorbing"],
        "what the sides are",
    );
    let bottom = table.choice("bottom", &["wall"], &["absorbing"], "what the bottom is");
    places.width = table.span_of("width");
    // The keys of a shape that is yet to come are not worth a second message.
    if shape.is_some() {
        table.finish();
    }
    shape.and(sides).and(bottom)?;
    Some(Container {
        width: width?.value,
    })
}

fn contact_law(table: TableReader<'_>, places: &mut Places) -> Option<LawChoice> {
    let law = law(&table, ActsOn::ContactBase);
    places.normal_stiffness = table.span_of("normal_stiffness");
    finish_law(table, ActsOn::ContactBase);
    law
}

/// Refuses unknown keys, unless the law itself is unknown: then they cannot be judged.
fn finish_law(table: TableReader<'_>, slot: ActsOn) {
    let name = table.peek_text("name").and_then(contact_laws::find);
    if name.is_some_and(|law| law.acts_on == slot) {
        table.finish();
    }
}

fn effects(tables: Vec<TableReader<'_>>) -> Option<Vec<LawChoice>> {
    let wanted = tables.len();
    let mut effects: Vec<LawChoice> = Vec::new();
    for table in tables {
        let Some(effect) = law(&table, ActsOn::ContactEffect) else {
            finish_law(table, ActsOn::ContactEffect);
            continue;
        };
        if let Some(first) = effects
            .iter()
            .find(|other| other.entry.name == effect.entry.name)
        {
            table.reader.report(
                Diagnostic::error(format!("the effect `{}` is given twice", effect.entry.name))
                    .at(effect.span, "again here")
                    .with(first.span, "first here")
                    .help("keep one of the two tables"),
            );
        }
        effects.push(effect);
        table.finish();
    }
    (effects.len() == wanted).then_some(effects)
}

/// The law that `name` says, with its parameters.
fn law(table: &TableReader<'_>, slot: ActsOn) -> Option<LawChoice> {
    let known: Vec<&'static LawEntry> = contact_laws::LAWS
        .iter()
        .filter(|law| law.acts_on == slot)
        .copied()
        .collect();
    let example = known.first().map_or("", |law| law.name);
    let meaning = match slot {
        ActsOn::ContactBase => "the contact law",
        ActsOn::ContactEffect => "the effect",
    };
    let name = table.text("name", None, example, meaning)?;
    let span = name.span?;
    let Some(entry) = known.iter().find(|law| law.name == name.value).copied() else {
        table
            .reader
            .report(explain_law(&name.value, span, slot, &known));
        return None;
    };
    let params = table.params(entry.params)?;
    Some(LawChoice {
        entry,
        params,
        span,
    })
}

fn explain_law(name: &str, span: Span, slot: ActsOn, known: &[&LawEntry]) -> Diagnostic {
    let shown = shorten(name);
    let list: Vec<&str> = known.iter().map(|law| law.name).collect();
    let list = list.join(", ");
    match (contact_laws::find(name), slot) {
        (Some(_), ActsOn::ContactBase) => {
            Diagnostic::error(format!("`{shown}` is an effect, not a contact law"))
                .at(span, "effects are added to a contact law")
                .help(format!("write it below [[effect]]; contact laws: {list}"))
        }
        (Some(_), ActsOn::ContactEffect) => {
            Diagnostic::error(format!("`{shown}` is a contact law, not an effect"))
                .at(span, "a model has one contact law, in [contact_law]")
                .help(format!("effects: {list}"))
        }
        (None, _) => {
            let kind = match slot {
                ActsOn::ContactBase => "contact law",
                ActsOn::ContactEffect => "effect",
            };
            let label = match nearest(name, known.iter().map(|law| law.name)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "not known".to_owned(),
            };
            Diagnostic::error(format!("there is no {kind} `{shown}`"))
                .at(span, label)
                .help(format!("{kind}s: {list}; `plunge effects` describes them"))
        }
    }
}

fn bed(
    table: TableReader<'_>,
    law: Option<&LawChoice>,
    container: Option<&Container>,
    folder: &DataFolder<'_>,
    places: &mut Places,
) -> Option<Bed> {
    let source_name = table.choice(
        "source",
        &["settle", "csv"],
        &[],
        "where the grains come from",
    );
    let fraction = table.optional_number(&specs::TARGET_PACKING_FRACTION);
    let height = table.optional_number(&specs::TARGET_HEIGHT);
    places.target_packing_fraction = table.span_of("target_packing_fraction");
    places.target_height = table.span_of("target_height");
    let source = match source_name {
        Some("csv") => csv_bed(&table, container, folder).map(BedSource::Csv),
        Some(_) => settle(&table, law, places).map(BedSource::Settle),
        None => return None,
    };
    table.finish();
    Some(Bed {
        source: source?,
        target_packing_fraction: fraction?.map(|found| found.value),
        target_height: height?.map(|found| found.value),
    })
}

fn settle(table: &TableReader<'_>, law: Option<&LawChoice>, places: &mut Places) -> Option<Settle> {
    let friction = preparation_friction(table, law);
    let step = time_step(table, &specs::PREPARATION_TIME_STEP, Some("auto"));
    places.preparation_time_step = table.span_of("preparation_time_step");
    let kinds = table.tables("grains", limits::GRAIN_KINDS);
    if kinds.is_empty() {
        table.reader.report(
            Diagnostic::error("the bed has no grains")
                .at(table.header(), "a settled bed is made of [[bed.grains]]")
                .help(
                    "write\n[[bed.grains]]\ncount = 1000\ndiameter = \"5 mm\"\nmass = \"0.05 g\"",
                ),
        );
    }
    let wanted = kinds.len().max(1);
    let grains: Vec<GrainKind> = kinds
        .into_iter()
        .filter_map(|kind| grain_kind(kind, places))
        .collect();
    let effects = effects(table.tables("effect", limits::EFFECTS));
    let grains = (grains.len() == wanted).then_some(grains)?;
    if grains.iter().all(|kind| kind.count == 0) {
        table.reader.report(
            Diagnostic::error("the bed has no grains: every `count` is 0")
                .at(table.header(), "at least one grain is wanted"),
        );
        return None;
    }
    Some(Settle {
        grains,
        preparation_friction: friction?,
        preparation_time_step: step?,
        effects: effects?,
    })
}

/// The given one, else the law's; the outer `None` is an error that was reported.
fn preparation_friction(table: &TableReader<'_>, law: Option<&LawChoice>) -> Option<Option<f64>> {
    let spec = specs::PREPARATION_FRICTION;
    let Some(law) = law else {
        return table.optional_number(&spec).map(|_| None);
    };
    let own = law
        .params
        .iter()
        .find(|(key, _)| *key == "friction")
        .map(|(_, value)| value);
    match own {
        Some(friction) => {
            let spec = ParamSpec {
                default: ParamDefault::Value(friction),
                ..spec
            };
            table.number(&spec).map(|found| Some(found.value))
        }
        None if table.has(spec.key) => {
            table.reader.report(
                Diagnostic::error(format!("the law `{}` has no friction", law.entry.name))
                    .at(
                        table.span_of(spec.key),
                        "so there is none to replace while settling",
                    )
                    .with(law.span, "the law"),
            );
            None
        }
        None => Some(None),
    }
}

fn grain_kind(table: TableReader<'_>, places: &mut Places) -> Option<GrainKind> {
    let count = table.integer(
        "count",
        None,
        0..=limits::GRAINS_OF_A_KIND,
        "the number of grains of this kind",
    );
    let diameter = table.number(&specs::GRAIN_DIAMETER);
    let area = diameter.map(|found| disc_area(found.value));
    let mass = mass(&table, &specs::GRAIN_MASS, area);
    places.grains.push(BodyPlaces {
        diameter: table.span_of("diameter"),
        mass: table.span_of("mass").or_else(|| table.span_of("density")),
    });
    table.finish();
    Some(GrainKind {
        count: count?.value,
        diameter: diameter?.value,
        mass: mass?,
    })
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

fn intruder(table: TableReader<'_>, places: &mut Places) -> Option<Intruder> {
    let name = table.slug(
        "name",
        Some("intruder"),
        "the intruder's name in logs and reports",
    );
    let names: Vec<&'static str> = intruders::SHAPES.iter().map(|shape| shape.name).collect();
    let later = ["cylinder", "hemisphere", "cone", "link", "two-link-chain"];
    let later: Vec<&str> = later
        .into_iter()
        .filter(|name| !names.contains(name))
        .collect();
    let shape = table.choice("shape", &names, &later, "the shape of the intruder")?;
    let shape = intruders::find(shape)?;
    if !shape.planar {
        table.reader.report(
            Diagnostic::error(format!(
                "the shape `{}` cannot act in a planar bed",
                shape.name
            ))
            .at(table.span_of("shape"), "a shape of three dimensions"),
        );
        return None;
    }
    let params = table.params(shape.params);
    let diameter = params.as_ref().and_then(|params| {
        params
            .iter()
            .find(|(key, _)| *key == "diameter")
            .map(|(_, value)| value)
    });
    let mass = mass(&table, &specs::INTRUDER_MASS, diameter.map(disc_area));
    places.intruder = BodyPlaces {
        diameter: table.span_of("diameter"),
        mass: table.span_of("mass").or_else(|| table.span_of("density")),
    };
    table.finish();
    Some(Intruder {
        name: name?.value,
        shape,
        params: params?,
        mass: mass?,
    })
}

fn impact(
    table: TableReader<'_>,
    container: Option<&Container>,
    places: &mut Places,
) -> Option<Impact> {
    let speed = table.number(&specs::SPEED);
    let angle = table.number(&specs::ANGLE);
    let spin = table.number(&specs::SPIN);
    let x = start_x(&table);
    let x_range = x_range(&table, container);
    places.speed = table.span_of("speed");
    places.spin = table.span_of("spin");
    places.x = table.span_of("x").or_else(|| table.span_of("position"));
    places.x_range = table.span_of("x_range");
    table.finish();
    Some(Impact {
        speed: speed?.value,
        angle_rad: angle?.value,
        spin: spin?.value,
        x: x?,
        x_range: x_range?,
    })
}

/// `x`, or the first of `position = [x, y]`.
fn start_x(table: &TableReader<'_>) -> Option<Option<f64>> {
    let (has_x, has_position) = (table.has("x"), table.has("position"));
    if has_x && has_position {
        table.reader.report(
            Diagnostic::error("both `x` and `position` are given")
                .at(table.span_of("position"), "says where the intruder starts")
                .with(table.span_of("x"), "says it too")
                .help("keep one of the two"),
        );
        return None;
    }
    if !has_position {
        return table
            .optional_number(&specs::X)
            .map(|found| found.map(|found| found.value));
    }
    let (x, y) = pair(table, &specs::POSITION)?;
    if y.value != 0.0 {
        table.reader.report(
            Diagnostic::error(
                "the second number of `position` is horizontal, for three dimensions",
            )
            .at(y.span, "must be \"0 m\" in a planar bed")
            .help("the intruder starts where it touches the surface; write x = \"…\" instead"),
        );
        return None;
    }
    table.note(&specs::X, x.value);
    Some(Some(x.value))
}

/// `x_range`, or the middle third of the container.
fn x_range(table: &TableReader<'_>, container: Option<&Container>) -> Option<(f64, f64)> {
    let range = match table.has("x_range") {
        true => {
            let (from, to) = pair(table, &specs::X_RANGE)?;
            if from.value > to.value {
                table.reader.report(
                    Diagnostic::error("`x_range` runs backwards")
                        .at(to.span, "the end")
                        .with(from.span, "the beginning is larger"),
                );
                return None;
            }
            (from.value, to.value)
        }
        false => {
            let width = container?.width;
            (width / 3.0, width / 1.5)
        }
    };
    table.note_pair(&specs::X_RANGE, range);
    Some(range)
}

/// A list of exactly two quantities.
fn pair(table: &TableReader<'_>, spec: &ParamSpec) -> Option<(Found<f64>, Found<f64>)> {
    let Node { span, value } = table.node(spec.key)?;
    if let Value::Array(nodes) = value
        && let [first, second] = nodes.as_slice()
    {
        let (first, second) = (table.number_at(first, spec), table.number_at(second, spec));
        return first.zip(second);
    }
    table.reader.report(
        Diagnostic::error(format!("`{}` is not a list of two lengths", spec.key))
            .at(*span, "two lengths are wanted")
            .help(format!("write {} = [\"0.3 m\", \"0.7 m\"]", spec.key)),
    );
    None
}

fn conditions(table: TableReader<'_>, places: &mut Places) -> Option<Option<ConditionLists>> {
    let speed = table.numbers(&specs::SPEED);
    let angle = table.numbers(&specs::ANGLE);
    let x = table.numbers(&specs::X);
    let positions = match table.has("positions") {
        true => table
            .integer(
                "positions",
                None,
                1..=limits::CONDITIONS as u64,
                "the number of drawn positions",
            )
            .map(Some),
        false => Some(None),
    };
    places.conditions = table.header();
    places.positions = table.span_of("positions");
    let given = table.header().is_some();
    if table.has("x") && table.has("positions") {
        table.reader.report(
            Diagnostic::error("both `x` and `positions` are given")
                .at(table.span_of("positions"), "draws start positions")
                .with(table.span_of("x"), "gives them")
                .help("keep one of the two"),
        );
    }
    table.finish();
    let (speed, angle, x, positions) = (speed?, angle?, x?, positions?);
    let spans = |list: &Option<Vec<Found<f64>>>| {
        list.iter()
            .flatten()
            .map(|found| found.span)
            .collect::<Vec<_>>()
    };
    places.condition_x = spans(&x);
    places.condition_speed = spans(&speed);
    let values = |list: Option<Vec<Found<f64>>>| {
        list.map(|list| {
            list.into_iter()
                .map(|found| found.value)
                .collect::<Vec<f64>>()
        })
    };
    Some(given.then(|| ConditionLists {
        speed: values(speed),
        angle_rad: values(angle),
        x: values(x),
        positions: positions.map(|found| found.value),
    }))
}
