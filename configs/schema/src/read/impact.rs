//! `[intruder]`, `[impact]` and `[conditions]`.

use engine::grains::Space;
use engine::params::ParamSpec;
use intruders::ShapeEntry;

use super::{BodyPlaces, Places, mass};
use crate::diagnostics::{Diagnostic, Span};
use crate::document::{Node, Value};
use crate::limits;
use crate::model::{ConditionLists, Container, Impact, Intruder, StartPositions};
use crate::reader::{Found, TableReader};
use crate::specs;

/// The intruder of a bed of grains.
pub(super) fn in_grains(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Intruder> {
    intruder(table, space, places, |table| {
        let fits = |shape: &&&ShapeEntry| {
            let has_dimension = match space {
                Space::Planar => shape.planar,
                Space::Spatial => shape.spatial,
            };
            has_dimension && shape.build.is_some()
        };
        let (here, later): (Vec<&ShapeEntry>, Vec<_>) = intruders::SHAPES.iter().partition(fits);
        let [here, later] = [here, later].map(|shapes| names(&shapes));
        intruders::find(table.choice("shape", &here, &later, "the shape of the intruder")?)
    })
}

/// The intruder of a resistive medium.
pub(super) fn in_resistance(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Intruder> {
    intruder(table, space, places, |table| {
        let medium = match space {
            Space::Planar => "a planar medium",
            Space::Spatial => "a medium of dimension 3",
        };
        let fits = |shape: &ShapeEntry| shape.is_of_resistance(space);
        let fitting = intruders::SHAPES.iter().filter(|shape| fits(shape));
        let here = names(&fitting.copied().collect::<Vec<_>>());
        let named = table.peek_text("shape").and_then(intruders::find);
        if let Some(shape) = named.filter(|shape| !fits(shape)) {
            table.reader.report(
                Diagnostic::error(format!("the shape `{}` cannot act in {medium}", shape.name))
                    .at(table.span_of("shape"), "a shape of another dimension")
                    .help(format!("shapes here: {}", here.join(", "))),
            );
            return None;
        }
        intruders::find(table.choice("shape", &here, &[], "the shape of the intruder")?)
    })
}

fn names(shapes: &[&ShapeEntry]) -> Vec<&'static str> {
    shapes.iter().map(|shape| shape.name).collect()
}

/// The intruder of a medium whose shapes `choose` knows.
fn intruder(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
    choose: impl Fn(&TableReader<'_>) -> Option<&'static ShapeEntry>,
) -> Option<Intruder> {
    let name = table.slug("name", Some("intruder"), "the intruder's name in logs and reports");
    let shape = choose(&table)?;
    let params = table.params(shape.params);
    places.intruder = BodyPlaces {
        count: None,
        diameter: table.span_of("diameter"),
        mass: table.span_of("mass").or_else(|| table.span_of("density")),
    };
    let density = match space {
        Space::Planar => &specs::AREA_DENSITY,
        Space::Spatial => &specs::DENSITY,
    };
    let size = params.as_ref().map(|params| (shape.volume)(params, space));
    let mass = mass(&table, &specs::INTRUDER_MASS, density, size);
    table.finish();
    Some(Intruder { name: name?.value, shape, params: params?, mass: mass? })
}

/// How the intruder comes in; the table is not finished.
pub(super) fn impact(table: &TableReader<'_>, places: &mut Places) -> Option<Impact> {
    let speed = table.number(&specs::SPEED);
    let angle = table.number(&specs::ANGLE);
    let spin = table.number(&specs::SPIN);
    places.speed = table.span_of("speed");
    places.angle = table.span_of("angle");
    places.spin = table.span_of("spin");
    Some(Impact { speed: speed?.value, angle_rad: angle?.value, spin: spin?.value })
}

/// Where impacts on a bed of grains start.
pub(super) fn start_positions(
    table: &TableReader<'_>,
    container: Option<&Container>,
    places: &mut Places,
) -> Option<StartPositions> {
    let x = start_x(table);
    let x_range = x_range(table, container);
    places.x = table.span_of("x").or_else(|| table.span_of("position"));
    places.x_range = table.span_of("x_range");
    Some(StartPositions { x: x?, x_range: x_range? })
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
        return table.optional_number(&specs::X).map(|found| found.map(|found| found.value));
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

/// `[conditions]` of a model of grains.
pub(super) fn conditions_on_grains(
    table: TableReader<'_>,
    places: &mut Places,
) -> Option<Option<ConditionLists>> {
    let lists = conditions(&table, places);
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
    places.positions = table.span_of("positions");
    if table.has("x") && table.has("positions") {
        table.reader.report(
            Diagnostic::error("both `x` and `positions` are given")
                .at(table.span_of("positions"), "draws start positions")
                .with(table.span_of("x"), "gives them")
                .help("keep one of the two"),
        );
    }
    table.finish();
    let (lists, x, positions) = (lists?, x?, positions?);
    places.condition_x = spans(&x);
    Some(lists.map(|lists| ConditionLists {
        x: values(x),
        positions: positions.map(|found| found.value),
        ..lists
    }))
}

/// The lists of `[conditions]` that every medium knows; the table is not finished.
pub(super) fn conditions(
    table: &TableReader<'_>,
    places: &mut Places,
) -> Option<Option<ConditionLists>> {
    let speed = table.numbers(&specs::SPEED);
    let angle = table.numbers(&specs::ANGLE);
    places.conditions = table.header();
    let (speed, angle) = (speed?, angle?);
    places.condition_speed = spans(&speed);
    places.condition_angle = spans(&angle);
    Some(table.header().map(|_| ConditionLists {
        speed: values(speed),
        angle_rad: values(angle),
        x: None,
        positions: None,
    }))
}

fn spans(list: &Option<Vec<Found<f64>>>) -> Vec<Option<Span>> {
    list.iter().flatten().map(|found| found.span).collect()
}

fn values(list: Option<Vec<Found<f64>>>) -> Option<Vec<f64>> {
    list.map(|list| list.into_iter().map(|found| found.value).collect())
}
