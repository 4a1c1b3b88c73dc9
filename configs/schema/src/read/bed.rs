//! `[bed]` and its `[[bed.grains]]`.

use engine::grains::Space;

use super::bed_file::{DataFolder, csv_bed};
use super::laws::effects;
use super::sizes::sizes;
use super::step::time_step;
use super::{BodyPlaces, Places};
use crate::diagnostics::Diagnostic;
use crate::limits;
use crate::model::{Bed, BedSource, Container, GrainKind, LawChoice, Settle};
use crate::reader::TableReader;
use crate::specs;

pub(super) fn bed(
    table: TableReader<'_>,
    law: Option<&LawChoice>,
    (space, container): (Space, Option<&Container>),
    folder: &DataFolder<'_>,
    places: &mut Places,
) -> Option<Bed> {
    let source_name = table.choice("source", &["settle", "csv"], &[], "where the grains come from");
    let fraction = table.optional_number(&specs::TARGET_PACKING_FRACTION);
    let height = table.optional_number(&specs::TARGET_HEIGHT);
    places.target_packing_fraction = table.span_of("target_packing_fraction");
    places.target_height = table.span_of("target_height");
    let source = match source_name {
        Some("csv") => csv_bed(&table, (space, container), folder).map(BedSource::Csv),
        Some(_) => settle(&table, (space, law), places).map(BedSource::Settle),
        None => return None,
    };
    table.finish();
    Some(Bed {
        source: source?,
        target_packing_fraction: fraction?.map(|found| found.value),
        target_height: height?.map(|found| found.value),
    })
}

fn settle(
    table: &TableReader<'_>,
    (space, law): (Space, Option<&LawChoice>),
    places: &mut Places,
) -> Option<Settle> {
    let inflated_to = table.optional_number(&specs::inflated_to(space));
    let friction = preparation_friction(table, law);
    let drag = table.optional_number(&specs::SETTLING_DRAG);
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
    let grains: Vec<GrainKind> =
        kinds.into_iter().filter_map(|kind| grain_kind(kind, space, places)).collect();
    let effects = effects(table.tables("effect", limits::EFFECTS), law);
    let grains = (grains.len() == wanted).then_some(grains)?;
    if grains.iter().all(|kind| kind.count == 0) {
        table.reader.report(
            Diagnostic::error("the bed has no grains: every `count` is 0")
                .at(table.header(), "expected at least one grain"),
        );
        return None;
    }
    Some(Settle {
        grains,
        inflated_to: inflated_to?.map(|found| found.value),
        preparation_friction: friction?,
        settling_drag: drag?.map_or(0.0, |found| found.value),
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
    let own = law.params.iter().find(|(key, _)| *key == "friction").map(|(_, value)| value);
    match own {
        Some(friction) => {
            let spec = spec.or(friction);
            table.number(&spec).map(|found| Some(found.value))
        }
        None if table.has(spec.key) => {
            table.reader.report(
                Diagnostic::error(format!("the law `{}` has no friction", law.entry.name))
                    .at(table.span_of(spec.key), "so there is none to replace while settling")
                    .with(law.span, "the law"),
            );
            None
        }
        None => Some(None),
    }
}

fn grain_kind(table: TableReader<'_>, space: Space, places: &mut Places) -> Option<GrainKind> {
    let count = table.integer(
        "count",
        None,
        0..=limits::GRAINS_OF_A_KIND,
        "the number of grains of this kind",
    );
    let sizes = sizes(&table, space);
    places.grains.push(BodyPlaces {
        count: table.span_of("count"),
        diameter: ["diameter", "diameter_max", "diameters", "diameter_median"]
            .into_iter()
            .find_map(|key| table.span_of(key)),
        mass: table.span_of("mass").or_else(|| table.span_of("density")),
    });
    table.finish();
    let (sizes, material) = sizes?;
    Some(GrainKind { count: count?.value, sizes, material })
}
