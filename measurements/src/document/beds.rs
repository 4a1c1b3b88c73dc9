//! `[bed]`, or a `[[bed]]` for each of several.

use configs::document::Value;
use configs::reader::TableReader;
use configs::{Diagnostic, limits, shorten};

use crate::document::optional::{optional, optional_choice};
use crate::document::unstated::Unstated;
use crate::keys;
use crate::{Bed, Geometry, NamedBed, StatedBed};

/// The tables of beds, before their numbers are read.
pub(crate) struct Beds<'a> {
    tables: Vec<TableReader<'a>>,
    /// The names of several; `None` of the one bed of a set that has no list.
    names: Option<Vec<String>>,
}

impl<'a> Beds<'a> {
    /// Below `root`, with their names.
    pub(crate) fn of(root: &TableReader<'a>) -> Self {
        let is_list = root.node("bed").is_some_and(|node| matches!(node.value, Value::Array(_)));
        let tables = root.table_or_tables("bed", limits::BEDS);
        if !is_list {
            return Self { tables, names: None };
        }
        if tables.is_empty() {
            root.reader.report(
                Diagnostic::error("`bed` is an empty list")
                    .at(root.span_of("bed"), "a bed at least")
                    .help("write one [bed], or a [[bed]] with a name for each of several"),
            );
        }
        let mut names: Vec<String> = Vec::new();
        for table in &tables {
            let name = table.text("name", None, "dry sand", "the name of the bed");
            let span = name.as_ref().and_then(|name| name.span);
            let name = name.map(|name| name.value.trim().to_owned()).unwrap_or_default();
            if span.is_some() && name.is_empty() {
                let message = "the name of a bed is empty";
                let help = "conditions and reports name a bed by it, as in name = \"dry sand\"";
                let error = Diagnostic::error(message).at(span, "a word at least").help(help);
                root.reader.report(error);
            } else if !name.is_empty() && names.contains(&name) {
                let message = format!("the bed `{}` is listed twice", shorten(&name));
                root.reader.report(Diagnostic::error(message).at(span, "again here"));
            }
            names.push(name);
        }
        Self { tables, names: Some(names) }
    }

    /// The place of the bed that the condition `table` names, among several; an unknown one is reported.
    pub(crate) fn named_by(&self, table: &TableReader<'_>) -> Option<usize> {
        let names = self.names.as_ref()?;
        if names.len() < 2 && !table.has("bed") {
            return None;
        }
        let example = names.first().map_or("dry sand", String::as_str);
        let found = table.text("bed", None, example, "the name of its bed")?;
        let place = names.iter().position(|name| name == found.value.trim());
        if place.is_none() {
            let message = format!("no [[bed]] is called `{}`", shorten(&found.value));
            let known = names.iter().map(|name| shorten(name)).collect::<Vec<_>>().join(", ");
            let help = format!("the beds of this set: {known}");
            table.reader.report(
                Diagnostic::error(message).at(found.span, "the bed of this condition").help(help),
            );
        }
        place
    }

    /// The first bed, and all of several; of a plane by default if `planar`.
    pub(crate) fn read(self, planar: bool, unstated: &mut Unstated) -> (Bed, Vec<NamedBed>) {
        let Self { tables, names } = self;
        let mut beds: Vec<Bed> = Vec::with_capacity(tables.len());
        for (at, table) in tables.into_iter().enumerate() {
            let name = names.as_ref().map(|names| format!("bed `{}`", shorten(&names[at])));
            let (reader, span) = (table.reader, table.span_of("geometry"));
            let own = bed(table, (name.as_deref().unwrap_or("bed"), planar), unstated);
            if beds.first().is_some_and(|first| first.geometry != own.geometry) {
                reader.report(
                    Diagnostic::error("one bed is of grains in space and another of discs")
                        .at(span, "not that of the first")
                        .help("split the set: a model has one kind of bed"),
                );
            }
            beds.push(own);
        }
        // A list without a bed was reported.
        let first = beds.first().copied().unwrap_or(Bed::new(Geometry::Spatial, None, 9.81));
        let named = |(name, bed)| NamedBed { name, bed };
        (first, names.into_iter().flatten().zip(beds).map(named).collect())
    }
}

fn bed(table: TableReader<'_>, (path, planar): (&str, bool), unstated: &mut Unstated) -> Bed {
    let geometry =
        match optional_choice(&table, "geometry", &["3d", "2d"], "grains of space or of a plane") {
            Some("2d") => Geometry::Planar,
            Some(_) => Geometry::Spatial,
            None => {
                let word = if planar { "2d" } else { "3d" };
                unstated.assume(format!("{path}.geometry = \"{word}\""));
                if planar { Geometry::Planar } else { Geometry::Spatial }
            }
        };
    let density = match geometry {
        Geometry::Planar => optional(&table, &keys::AREA_DENSITY),
        Geometry::Spatial => optional(&table, &keys::BULK_DENSITY),
    };
    let gravity = table.number(&keys::GRAVITY).map_or(9.81, |found| {
        if found.span.is_none() {
            unstated.assume(format!("{path}.gravity = {:?}", found.value));
        }
        found.value
    });
    let grain_diameter = optional(&table, &keys::GRAIN_DIAMETER);
    unstated.absent_if(density.is_none(), &format!("{path}.bulk_density"));
    unstated.absent_if(grain_diameter.is_none(), &format!("{path}.grain_diameter"));
    let density_sigma = match geometry {
        Geometry::Planar => optional(&table, &keys::AREA_DENSITY_SIGMA),
        Geometry::Spatial => optional(&table, &keys::BULK_DENSITY_SIGMA),
    };
    let fluid = configs::fluid(&table).flatten();
    if let (Some(_), Geometry::Planar) = (fluid, geometry) {
        table.reader.report(
            Diagnostic::error("a planar bed has no fluid")
                .at(table.span_of("fluid_density"), "the density of a fluid is that of a volume")
                .help("leave the fluid out, or write geometry = \"3d\""),
        );
    }
    let stated = StatedBed {
        fluid,
        packing_fraction: optional(&table, &keys::PACKING_FRACTION),
        packing_fraction_sigma: optional(&table, &keys::PACKING_FRACTION_SIGMA),
        surface_height: optional(&table, &keys::SURFACE_HEIGHT),
        surface_height_sigma: optional(&table, &keys::SURFACE_HEIGHT_SIGMA),
        bulk_density_sigma: density_sigma,
        grain_diameter_sigma: optional(&table, &keys::GRAIN_DIAMETER_SIGMA),
        coordination: optional(&table, &keys::COORDINATION),
        coordination_sigma: optional(&table, &keys::COORDINATION_SIGMA),
    };
    table.finish();
    Bed { geometry, bulk_density: density, gravity, grain_diameter, stated }
}
