//! `[contact_law]`, `[[effect]]` and `[[bed.effect]]`, driven by the registry.

use contact_laws::{ActsOn, GRAIN_FORCES, LawEntry, find_grain_force};
use engine::grains::Space;
use engine::params::{ParamDefault, ParamTable};

use super::Places;
use crate::diagnostics::{Diagnostic, Span, nearest, shorten};
use crate::model::{GrainForceChoice, LawChoice};
use crate::reader::TableReader;

pub(super) fn contact_law(table: TableReader<'_>, places: &mut Places) -> Option<LawChoice> {
    let law = law(&table, ActsOn::ContactBase, None);
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

/// The effects on the contact law `base`; `None` if that could not be read.
pub(super) fn effects(
    tables: Vec<TableReader<'_>>,
    base: Option<&LawChoice>,
) -> Option<Vec<LawChoice>> {
    let wanted = tables.len();
    let mut effects: Vec<LawChoice> = Vec::new();
    for table in tables {
        let Some(effect) = law(&table, ActsOn::ContactEffect, base) else {
            finish_law(table, ActsOn::ContactEffect);
            continue;
        };
        if let Some(first) = effects.iter().find(|other| other.entry.name == effect.entry.name) {
            table.reader.report(given_twice(effect.entry.name, effect.span, first.span));
        }
        effects.push(effect);
        table.finish();
    }
    (effects.len() == wanted).then_some(effects)
}

/// The effects of a run: on contacts under the law `base`, and on single grains; `None` if something of
/// them could not be read.
pub(super) fn effects_of_run(
    tables: Vec<TableReader<'_>>,
    space: Space,
    base: Option<&LawChoice>,
) -> Option<(Vec<LawChoice>, Vec<GrainForceChoice>)> {
    let is_force = |table: &TableReader<'_>| {
        table.peek_text("name").is_some_and(|name| find_grain_force(name).is_some())
    };
    let (forces, contacts) = tables.into_iter().partition(is_force);
    let (effects, forces) = (effects(contacts, base), grain_forces(forces, space));
    Some((effects?, forces?))
}

fn grain_forces(tables: Vec<TableReader<'_>>, space: Space) -> Option<Vec<GrainForceChoice>> {
    let wanted = tables.len();
    let mut forces: Vec<GrainForceChoice> = Vec::new();
    for table in tables {
        let Some(force) = grain_force(&table, space) else { continue };
        if let Some(first) = forces.iter().find(|other| other.entry.name == force.entry.name) {
            table.reader.report(given_twice(force.entry.name, force.span, first.span));
        }
        forces.push(force);
        table.finish();
    }
    (forces.len() == wanted).then_some(forces)
}

fn grain_force(table: &TableReader<'_>, space: Space) -> Option<GrainForceChoice> {
    let known: Vec<&'static str> = GRAIN_FORCES.iter().map(|force| force.name).collect();
    let name = table.name("name", &known, "the effect")?;
    let (entry, span) = (find_grain_force(&name.value)?, name.span?);
    if let Some((only, why)) = entry.only_in.filter(|(only, _)| *only != space) {
        let (kind, dimension) = match only {
            Space::Planar => ("discs", 2),
            Space::Spatial => ("spheres", 3),
        };
        table.reader.report(
            Diagnostic::error(format!("`{}` acts on {kind} alone", entry.name)).at(span, why).help(
                format!("leave it out, or make the bed one of {kind}: dimension = {dimension}"),
            ),
        );
        return None;
    }
    let params = table.params_on(entry.params, &ParamTable::new())?;
    Some(GrainForceChoice { entry, params, span })
}

/// What to say about an effect that is there already.
pub(super) fn given_twice(name: &str, again: Span, first: Span) -> Diagnostic {
    Diagnostic::error(format!("the effect `{name}` is given twice"))
        .at(again, "again here")
        .with(first, "first here")
        .help("keep one of the two tables")
}

/// The law that `name` says, with its parameters; an effect takes some from `base`.
fn law(table: &TableReader<'_>, slot: ActsOn, base: Option<&LawChoice>) -> Option<LawChoice> {
    let known: Vec<&'static LawEntry> =
        contact_laws::LAWS.iter().filter(|law| law.acts_on == slot).copied().collect();
    let names: Vec<&'static str> = known.iter().map(|law| law.name).collect();
    let meaning = match slot {
        ActsOn::ContactBase => "the contact law",
        ActsOn::ContactEffect => "the effect",
    };
    let name = table.name("name", &names, meaning)?;
    let span = name.span?;
    let Some(entry) = known.iter().find(|law| law.name == name.value).copied() else {
        table.reader.report(explain_law(&name.value, span, slot, &known));
        return None;
    };
    let Some(lent) = lent_to(table, entry, span, base) else {
        // Its keys are known; they are just not read.
        entry.params.iter().for_each(|spec| _ = table.has(spec.key));
        return None;
    };
    let params = table.params_on(entry.params, lent)?;
    Some(LawChoice { entry, params, span })
}

/// The parameters of `base`, if it has those that `effect` takes from it.
fn lent_to<'b>(
    table: &TableReader<'_>,
    effect: &LawEntry,
    span: Span,
    base: Option<&'b LawChoice>,
) -> Option<&'b ParamTable> {
    const NOTHING: &ParamTable = &ParamTable::new();
    let wanted: Vec<&str> = effect
        .params
        .iter()
        .filter_map(|spec| match spec.default {
            ParamDefault::FromBase(key) => Some(key),
            _ => None,
        })
        .collect();
    let Some(first) = wanted.first() else { return Some(NOTHING) };
    let base = base?;
    let has =
        |law: &LawEntry| wanted.iter().all(|key| law.params.iter().any(|own| own.key == *key));
    if has(base.entry) {
        return Some(&base.params);
    }
    let fit =
        contact_laws::LAWS.iter().filter(|law| law.acts_on == ActsOn::ContactBase && has(law));
    let fit: Vec<&str> = fit.map(|law| law.name).collect();
    let (effect, law) = (effect.name, base.entry.name);
    table.reader.report(
        Diagnostic::error(format!("`{effect}` needs a Hertz law, and `{law}` has no `{first}`"))
            .at(span, "it acts on elastic constants")
            .with(base.span, "the contact law")
            .help(format!("contact laws with them: {}", fit.join(", "))),
    );
    None
}

fn explain_law(name: &str, span: Span, slot: ActsOn, known: &[&LawEntry]) -> Diagnostic {
    let shown = shorten(name);
    let forces = GRAIN_FORCES.iter().map(|force| force.name);
    let forces = forces.filter(|_| slot == ActsOn::ContactEffect);
    let names: Vec<&str> = known.iter().map(|law| law.name).chain(forces).collect();
    let list = names.join(", ");
    if find_grain_force(name).is_some() {
        return Diagnostic::error(format!("`{shown}` acts on the grains of a run"))
            .at(span, "this is neither a contact law nor an effect on a bed that settles")
            .help("write it below [[effect]]");
    }
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
            if resistive::find_resistance(name).is_some() {
                return Diagnostic::error(format!("`{shown}` acts in a resistive-force medium"))
                    .at(span, "this medium is a bed of grains")
                    .help(format!("{kind}s: {list}; `plunge effects` describes them"));
            }
            let label = match nearest(name, names.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => "not known".to_owned(),
            };
            Diagnostic::error(format!("there is no {kind} `{shown}`"))
                .at(span, label)
                .help(format!("{kind}s: {list}; `plunge effects` describes them"))
        }
    }
}
