//! What only a model of a resistive force has.

use std::sync::Arc;

use engine::fluid::Fluid;
use engine::grains::Space;
use resistive::{Effect, OwnEffect, RESISTANCE_LAWS, ResistanceEntry, Role};

use super::fit::free;
use super::fluid::fluid;
use super::foreign::Foreign;
use super::impact::Pushed::IntoResistance;
use super::laws::given_twice;
use super::own_effect::{EXPRESSION, Purpose, own_effect};
use super::{CommonTables, KINDS, Places, energy, impact, intruder_example};
use crate::diagnostics::{Diagnostic, Span, nearest, shorten};
use crate::limits;
use crate::model::{
    Coefficient, EffectChoice, IMPACT, INTRUSION, LogSettings, Medium, Model, ResistanceChoice,
    ResistiveMedium, RunSettings,
};
use crate::reader::TableReader;
use crate::resolved::Resolved;
use crate::specs;

const RESISTANCE_EXAMPLE: &str = "name = \"two-term-vector\"\ndrag = 1.0\nfriction = 15.0";

/// A model of a resistive force. `None` when something required could not be read.
pub(super) fn model(
    root: &TableReader<'_>,
    tables: CommonTables<'_>,
    places: &mut Places,
) -> Option<Model> {
    let foreign = Foreign { home: "grains", here: ("resistive-force", places.kind) };
    foreign.keys(&tables.run, "run", &["time_step", "time_step_factor", "checkpoint_every"]);
    foreign.keys(&tables.log, "log", &["flush_every", "grains"]);
    foreign.tables(root, &["container", "bed", "contact_law"]);
    let run = run(tables.run, places);
    let log = log(tables.log, places);
    let energy = energy(tables.energy);
    let bed = bed(tables.medium, places);
    let resistance = resistance(root.table("resistance", Some(RESISTANCE_EXAMPLE)), places);
    let space = bed.as_ref().map(|bed| bed.space);
    let effects =
        space.and_then(|space| effects(root.tables("effect", limits::EFFECTS), space, places));
    let candidates = root.tables("candidate", limits::CANDIDATES);
    let candidates =
        space.and_then(|space| own_candidates(candidates, space, effects.as_deref(), places));
    let free = free(root.table("fit", None), resistance.as_ref(), effects.as_deref());
    let example = intruder_example(space.unwrap_or(Space::Spatial));
    let intruder_table = root.table("intruder", Some(example));
    let intruder = space.and_then(|space| impact::in_resistance(intruder_table, space, places));
    let impact_table = impact::start_table(root);
    let is_pushed = impact::is_pushed(root);
    let table_name = if is_pushed { INTRUSION } else { IMPACT };
    foreign.keys(&impact_table, table_name, &["x", "y", "position", "x_range", "attitude"]);
    let impact = match is_pushed {
        true => impact::intrusion(&impact_table, intruder.as_ref(), (IntoResistance, places)),
        false => impact::impact(&impact_table, places),
    };
    impact_table.finish();
    let conditions_table = root.table("conditions", None);
    foreign.keys(&conditions_table, "conditions", &["x", "positions"]);
    let conditions = impact::conditions(&conditions_table, places);
    conditions_table.finish();
    let (log, log_interval) = log?;
    let Bed { space, bulk_density, gravity, packing, bed_depth, fluid } = bed?;
    Some(Model {
        run: run?,
        log,
        energy: energy?,
        medium: Medium::Resistive(Box::new(ResistiveMedium {
            space,
            bulk_density,
            gravity,
            packing,
            bed_depth,
            fluid,
            resistance: resistance?,
            effects: effects?,
            candidates: candidates?,
            free: free?,
            log_interval,
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

fn run(table: TableReader<'_>, places: &mut Places) -> Option<RunSettings> {
    let name = table.slug("name", None, "the name of the run and of its folder");
    let duration = table.number(&specs::DURATION);
    let seed = table.integer("seed", Some(1), 0..=i64::MAX as u64, "the seed of everything random");
    places.duration = table.span_of("duration");
    table.finish();
    Some(RunSettings { name: name?.value, duration: duration?.value, seed: seed?.value })
}

fn log(table: TableReader<'_>, places: &mut Places) -> Option<(LogSettings, f64)> {
    let interval = table.number(&specs::LOG_INTERVAL);
    let frames_per_s = table.number(&specs::FRAMES_PER_S);
    places.interval = table.span_of("interval");
    table.finish();
    Some((LogSettings { frames_per_s: frames_per_s?.value }, interval?.value))
}

/// What `[medium]` says.
struct Bed {
    space: Space,
    bulk_density: f64,
    gravity: f64,
    packing: Option<f64>,
    bed_depth: Option<f64>,
    fluid: Option<Fluid>,
}

fn bed(table: TableReader<'_>, places: &mut Places) -> Option<Bed> {
    table.choice("kind", KINDS, &[], "the kind of medium");
    let dimension = table.integer("dimension", Some(3), 2..=3, "the number of space dimensions");
    let space = dimension.map(|found| match found.value {
        2 => Space::Planar,
        _ => Space::Spatial,
    });
    let bulk_density = table.number(match space {
        Some(Space::Planar) => &specs::BULK_AREA_DENSITY,
        _ => &specs::BULK_DENSITY,
    });
    let gravity = table.number(&specs::GRAVITY);
    let packing = table.optional_number(&specs::PACKING);
    let bed_depth = table.optional_number(&specs::BED_DEPTH);
    let fluid = fluid(&table);
    places.gravity = table.span_of("gravity");
    places.fluid = table.span_of(specs::FLUID_DENSITY.key);
    table.finish();
    Some(Bed {
        space: space?,
        bulk_density: bulk_density?.value,
        gravity: gravity?.value,
        packing: packing?.map(|found| found.value),
        bed_depth: bed_depth?.map(|found| found.value),
        fluid: fluid?,
    })
}

/// What a law is to a model, without the facts of an effect.
#[derive(Clone, Copy, PartialEq)]
enum Slot {
    Baseline,
    Effect,
}

impl Slot {
    fn of(entry: &ResistanceEntry) -> Self {
        match entry.role {
            Role::Baseline => Self::Baseline,
            Role::Effect(_) => Self::Effect,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Baseline => "resistance law",
            Self::Effect => "effect",
        }
    }
}

fn resistance(table: TableReader<'_>, places: &mut Places) -> Option<ResistanceChoice> {
    let (entry, span) = entry(&table, Slot::Baseline)?;
    let read: Vec<Option<Coefficient>> =
        entry.params.iter().map(|spec| table.coefficient(spec, entry.variables)).collect();
    places.coefficients = entry.params.iter().map(|spec| table.span_of(spec.key)).collect();
    table.finish();
    let coefficients = read.into_iter().collect::<Option<Vec<_>>>()?;
    Some(ResistanceChoice { entry, coefficients, span })
}

fn effects(
    tables: Vec<TableReader<'_>>,
    space: Space,
    places: &mut Places,
) -> Option<Vec<EffectChoice>> {
    let wanted = tables.len();
    let mut effects: Vec<EffectChoice> = Vec::new();
    for table in tables {
        let Some(choice) = effect(&table, space, places) else { continue };
        let name = choice.effect.name();
        if let Some(first) = effects.iter().find(|other| other.effect.name() == name) {
            table.reader.report(given_twice(name, choice.span, first.span));
        }
        table.finish();
        effects.push(choice);
    }
    (effects.len() == wanted).then_some(effects)
}

fn effect(table: &TableReader<'_>, space: Space, places: &mut Places) -> Option<EffectChoice> {
    if table.peek_text("name") == Some(EXPRESSION) {
        let name = table.name("name", &[EXPRESSION], "the effect")?;
        let (own, span) = own_effect(table, space, Purpose::Part, places)?;
        let values = own.draft().parameters.iter().find(|one| one.name == "q");
        let q = values.and_then(|q| q.value)?;
        return Some(EffectChoice {
            effect: Effect::Own(own.into()),
            q,
            span: span.or(name.span)?,
        });
    }
    let (entry, span) = entry(table, Slot::Effect)?;
    let params = table.params(entry.params)?;
    Some(EffectChoice { q: params.get("q"), effect: Effect::Listed(entry, params), span })
}

/// The effects that a diagnosis tries beside those of the table.
fn own_candidates(
    tables: Vec<TableReader<'_>>,
    space: Space,
    effects: Option<&[EffectChoice]>,
    places: &mut Places,
) -> Option<Vec<Arc<OwnEffect>>> {
    let wanted = tables.len();
    let mut candidates: Vec<(Arc<OwnEffect>, Span)> = Vec::new();
    for table in tables {
        let name = table.name("name", &[EXPRESSION], "the effect");
        let Some(name) = name else { continue };
        if name.value != EXPRESSION {
            table.reader.report(
                Diagnostic::error("a candidate of a model file is an expression")
                    .at(name.span, "effects that come with the program are candidates anyway")
                    .help("write name = \"expression\", with id, force and parameters"),
            );
            continue;
        }
        let read = own_effect(&table, space, Purpose::Candidate, places);
        let Some((own, Some(span))) = read else { continue };
        let among = effects.into_iter().flatten().map(|one| (one.effect.name(), one.span));
        let earlier = candidates.iter().map(|(other, span)| (other.id(), *span));
        if let Some((_, first)) = among.chain(earlier).find(|(name, _)| *name == own.id()) {
            table.reader.report(given_twice(own.id(), span, first));
        }
        table.finish();
        candidates.push((own.into(), span));
    }
    let complete = candidates.len() == wanted;
    complete.then(|| candidates.into_iter().map(|(own, _)| own).collect())
}

/// The law that `name` says.
fn entry(table: &TableReader<'_>, slot: Slot) -> Option<(&'static ResistanceEntry, Span)> {
    let known = || RESISTANCE_LAWS.iter().filter(|law| Slot::of(law) == slot);
    let names: Vec<&'static str> = known().map(|law| law.name).collect();
    let name = table.name("name", &names, &format!("the {}", slot.name()))?;
    let span = name.span?;
    let found = known().find(|law| law.name == name.value).copied();
    if found.is_none() {
        table.reader.report(explain(&name.value, span, slot, &names));
    }
    Some((found?, span))
}

fn explain(name: &str, span: Span, slot: Slot, known: &[&str]) -> Diagnostic {
    let shown = shorten(name);
    let kind = slot.name();
    let own = if slot == Slot::Effect { ", expression" } else { "" };
    let list = format!("{kind}s: {}{own}; `plunge effects` describes them", known.join(", "));
    match (resistive::find_resistance(name), slot) {
        (None, _) => {}
        (Some(_), Slot::Baseline) => {
            return Diagnostic::error(format!("`{shown}` is an effect, not a resistance law"))
                .at(span, "effects are added to a resistance law, below [[effect]]")
                .help(list);
        }
        (Some(_), Slot::Effect) => {
            return Diagnostic::error(format!("`{shown}` is a resistance law, not an effect"))
                .at(span, "a model has one resistance law, in [resistance]")
                .help(list);
        }
    }
    let on_grains = contact_laws::find(name).map(|_| "acts on contacts of grains");
    let on_grains =
        on_grains.or(contact_laws::find_grain_force(name).map(|_| "acts on single grains"));
    if let Some(acts) = on_grains {
        return Diagnostic::error(format!("`{shown}` {acts}"))
            .at(span, "this medium has no grains")
            .help(list);
    }
    let label = match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => "not known".to_owned(),
    };
    Diagnostic::error(format!("there is no {kind} `{shown}`")).at(span, label).help(list)
}
