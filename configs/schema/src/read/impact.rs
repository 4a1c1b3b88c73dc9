//! `[intruder]`, `[impact]` and `[conditions]`.

use engine::params::ParamSpec;

use super::{BodyPlaces, Places, disc_area, mass};
use crate::diagnostics::Diagnostic;
use crate::document::{Node, Value};
use crate::limits;
use crate::model::{ConditionLists, Container, Impact, Intruder};
use crate::reader::{Found, TableReader};
use crate::specs;

pub(super) fn intruder(table: TableReader<'_>, places: &mut Places) -> Option<Intruder> {
    let name = table.slug("name", Some("intruder"), "the intruder's name in logs and reports");
    let for_grains = intruders::SHAPES.iter().filter(|shape| shape.build.is_some());
    let names: Vec<&'static str> = for_grains.map(|shape| shape.name).collect();
    let later = ["cylinder", "hemisphere", "cone", "link", "two-link-chain"];
    let later: Vec<&str> = later.into_iter().filter(|name| !names.contains(name)).collect();
    let shape = table.choice("shape", &names, &later, "the shape of the intruder")?;
    let shape = intruders::find(shape)?;
    if !shape.planar {
        table.reader.report(
            Diagnostic::error(format!("the shape `{}` cannot act in a planar bed", shape.name))
                .at(table.span_of("shape"), "a shape of three dimensions"),
        );
        return None;
    }
    let params = table.params(shape.params);
    let diameter = params.as_ref().and_then(|params| {
        params.iter().find(|(key, _)| *key == "diameter").map(|(_, value)| value)
    });
    let mass = mass(&table, &specs::INTRUDER_MASS, diameter.map(disc_area));
    places.intruder = BodyPlaces {
        count: None,
        diameter: table.span_of("diameter"),
        mass: table.span_of("mass").or_else(|| table.span_of("density")),
    };
    table.finish();
    Some(Intruder { name: name?.value, shape, params: params?, mass: mass? })
}

pub(super) fn impact(
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

pub(super) fn conditions(
    table: TableReader<'_>,
    places: &mut Places,
) -> Option<Option<ConditionLists>> {
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
        list.iter().flatten().map(|found| found.span).collect::<Vec<_>>()
    };
    places.condition_x = spans(&x);
    places.condition_speed = spans(&speed);
    let values = |list: Option<Vec<Found<f64>>>| {
        list.map(|list| list.into_iter().map(|found| found.value).collect::<Vec<f64>>())
    };
    Some(given.then(|| ConditionLists {
        speed: values(speed),
        angle_rad: values(angle),
        x: values(x),
        positions: positions.map(|found| found.value),
    }))
}
