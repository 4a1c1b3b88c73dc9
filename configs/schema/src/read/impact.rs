//! `[intruder]`, `[impact]` and `[conditions]`.

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamSpec;
use intruders::ShapeEntry;

use super::{BodyPlaces, IMPACT_EXAMPLE, Places, mass};
use crate::diagnostics::{Diagnostic, Span};
use crate::document::{Node, Value};
use crate::limits;
use crate::model::{
    ConditionLists, Container, IMPACT, INTRUSION, Impact, Intruder, StartPositions,
};
use crate::reader::{Answer, Found, TableReader};
use crate::specs;

/// The intruder of a bed of grains.
pub(super) fn in_grains(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Intruder> {
    let wall = "whether a wall as wide as the top stands behind it, which is not felt";
    table.asks("recessive_wall", wall, || Answer::Boolean);
    let recessive_wall = match table.has("recessive_wall") {
        true => table.boolean("recessive_wall", false),
        false => Some(false),
    };
    let wall_span = table.span_of("recessive_wall");
    let shaft_span = table.span_of("shaft_diameter");
    let reader = table.reader;
    let intruder = intruder(table, space, places, |shape| shape.is_of(space))?;
    let has_shaft = |&(key, value): &(&str, f64)| key == "shaft_diameter" && value > 0.0;
    if intruder.params.iter().any(|one| has_shaft(&one)) {
        reader.report(
            Diagnostic::error("a bed of grains knows no `shaft_diameter`")
                .at(shaft_span, "a shaft that follows the body into the bed")
                .help(
                    "write recessive_wall = true for a shaft as wide as the top, which is not felt",
                ),
        );
        return None;
    }
    let recessive_wall = recessive_wall?;
    if recessive_wall && intruder.shape.under_shaft.is_none() {
        let with_top = intruders::SHAPES.iter().filter(|shape| shape.under_shaft.is_some());
        let with_top = names(&with_top.copied().collect::<Vec<_>>());
        reader.report(
            Diagnostic::error(format!("the shape `{}` has no top plane", intruder.shape.name))
                .at(wall_span, "a recessive wall needs a flat top of the intruder")
                .help(format!("shapes with one: {}", with_top.join(", "))),
        );
        return None;
    }
    Some(Intruder { recessive_wall, ..intruder })
}

/// The intruder of a resistive medium.
pub(super) fn in_resistance(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Intruder> {
    intruder(table, space, places, |shape| shape.is_of_resistance(space))
}

/// The shape, of those that `fits` says the medium knows.
fn shape(
    table: &TableReader<'_>,
    space: Space,
    fits: impl Fn(&ShapeEntry) -> bool,
) -> Option<&'static ShapeEntry> {
    let medium = match space {
        Space::Planar => "a planar medium",
        Space::Spatial => "a medium of dimension 3",
    };
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
}

fn names(shapes: &[&ShapeEntry]) -> Vec<&'static str> {
    shapes.iter().map(|shape| shape.name).collect()
}

/// The intruder of a medium that knows the shapes that `fits` says.
fn intruder(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
    fits: impl Fn(&ShapeEntry) -> bool,
) -> Option<Intruder> {
    let name = table.slug("name", Some("intruder"), "the intruder's name in logs and reports");
    let shape = shape(&table, space, fits)?;
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
    let (name, params, mass) = (name?.value, params?, mass?);
    Some(Intruder { name, shape, params, mass, recessive_wall: false })
}

/// How the intruder comes into a resistive medium; the table is not finished.
pub(super) fn impact(table: &TableReader<'_>, places: &mut Places) -> Option<Impact> {
    let velocity = velocity(table, places);
    let spin = turning(table);
    let (speed, angle_rad) = velocity?;
    Some(Impact { speed, angle_rad, spin: spin?, attitude_rad: 0.0, pushed_to: None })
}

/// How the intruder comes into a bed of grains; the table is not finished.
pub(super) fn impact_on_grains(
    table: &TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Impact> {
    let velocity = velocity(table, places);
    let is_vector = table.node("spin").is_some_and(|node| matches!(node.value, Value::Array(_)));
    let spin = match space {
        Space::Spatial if is_vector => several(table, &specs::SPIN_VECTOR)
            .map(|[x, y, z]| Vec3::new(x.value, y.value, z.value)),
        _ => turning(table),
    };
    if let Some(spin) = spin.filter(|_| is_vector) {
        table.note_list(&specs::SPIN_VECTOR, spin.as_slice());
    }
    let attitude = table.optional_number(&specs::ATTITUDE);
    let (speed, angle_rad) = velocity?;
    let attitude_rad = attitude?.map_or(0.0, |found| found.value);
    Some(Impact { speed, angle_rad, spin: spin?, attitude_rad, pushed_to: None })
}

/// The table that says how the intruder moves: `[impact]`, or `[intrusion]` where a drive pushes it. Both are
/// reported.
pub(super) fn start_table<'a>(root: &TableReader<'a>) -> TableReader<'a> {
    let pushed = root.has(INTRUSION);
    if pushed && root.has(IMPACT) {
        root.reader.report(
            Diagnostic::error("both [impact] and [intrusion] are given")
                .at(root.span_of(INTRUSION), "moves the intruder at a set speed")
                .with(root.span_of(IMPACT), "lets it go at first contact")
                .help("keep one of the two"),
        );
    }
    root.table(if pushed { INTRUSION } else { IMPACT }, Some(IMPACT_EXAMPLE))
}

/// Whether `table` is that of an intruder which a drive pushes.
pub(super) fn is_pushed(root: &TableReader<'_>) -> bool {
    root.span_of(INTRUSION).is_some()
}

/// `[intrusion]`: how a drive pushes `intruder`; the table is not finished.
pub(super) fn intrusion(
    table: &TableReader<'_>,
    intruder: Option<&Intruder>,
    (medium, places): (Pushed, &mut Places),
) -> Option<Impact> {
    let speed = table.number(&specs::INTRUSION_SPEED);
    let angle = table.number(&specs::INTRUSION_ANGLE);
    let depth = table.number(&specs::INTRUSION_DEPTH);
    places.speed = table.span_of("speed");
    places.angle = table.span_of("angle");
    let attitude = match medium {
        Pushed::IntoGrains => table.optional_number(&specs::ATTITUDE)?,
        Pushed::IntoResistance => None,
    };
    if let Some(chain) = intruder.filter(|intruder| intruder.shape.links.is_some()) {
        table.reader.report(
            Diagnostic::error(format!("a drive cannot push a {}", chain.shape.name))
                .at(table.header(), "moves one rigid body")
                .help("write [impact] for a chain, or another shape below [intruder]"),
        );
        return None;
    }
    Some(Impact {
        speed: speed?.value,
        angle_rad: angle?.value,
        spin: Vec3::zeros(),
        attitude_rad: attitude.map_or(0.0, |found| found.value),
        pushed_to: Some(depth?.value),
    })
}

/// What a drive pushes an intruder into.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pushed {
    IntoGrains,
    IntoResistance,
}

/// Speed (m/s) and angle below the horizontal (rad).
fn velocity(table: &TableReader<'_>, places: &mut Places) -> Option<(f64, f64)> {
    let speed = table.number(&specs::SPEED);
    let angle = table.number(&specs::ANGLE);
    places.speed = table.span_of("speed");
    places.angle = table.span_of("angle");
    places.spin = table.span_of("spin");
    Some((speed?.value, angle?.value))
}

/// The angular velocity (rad/s) of a spin in the x–z plane: counter-clockwise is about −y.
fn turning(table: &TableReader<'_>) -> Option<Vec3> {
    table.number(&specs::SPIN).map(|spin| Vec3::new(0.0, -spin.value, 0.0))
}

/// Where impacts on a bed of grains start.
pub(super) fn start_positions(
    table: &TableReader<'_>,
    (space, container): (Space, Option<&Container>),
    places: &mut Places,
) -> Option<StartPositions> {
    let start = start(table, space);
    let x_range = x_range(table, container);
    places.x = table.span_of("x").or_else(|| table.span_of("position"));
    places.x_range = table.span_of("x_range");
    let (x, y) = start?;
    Some(StartPositions { x, y, x_range: x_range? })
}

/// `x`, and in space `y`, or both as `position = [x, y]`.
fn start(table: &TableReader<'_>, space: Space) -> Option<(Option<f64>, Option<f64>)> {
    let place = "where the intruder's centre starts, from the left and the front side";
    table.asks("position", place, || Answer::Numbers(specs::POSITION, Some(2)));
    let has_y = space == Space::Spatial && table.has("y");
    if !table.has("position") {
        let x = table.optional_number(&specs::X);
        let y = if has_y { table.optional_number(&specs::Y) } else { Some(None) };
        let value = |found: Option<Found<f64>>| found.map(|found| found.value);
        return Some((value(x?), value(y?)));
    }
    if table.has("x") || has_y {
        let other = if table.has("x") { "x" } else { "y" };
        table.reader.report(
            Diagnostic::error(format!("both `{other}` and `position` are given"))
                .at(table.span_of("position"), "says where the intruder starts")
                .with(table.span_of(other), "says it too")
                .help("keep one of the two"),
        );
        return None;
    }
    let [x, y] = several(table, &specs::POSITION)?;
    table.note(&specs::X, x.value);
    if space == Space::Spatial {
        table.note(&specs::Y, y.value);
        return Some((Some(x.value), Some(y.value)));
    }
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
    Some((Some(x.value), None))
}

/// `x_range`, or the middle third of the container.
fn x_range(table: &TableReader<'_>, container: Option<&Container>) -> Option<(f64, f64)> {
    table.asks("x_range", specs::X_RANGE.meaning, || Answer::Numbers(specs::X_RANGE, Some(2)));
    let range = match table.has("x_range") {
        true => {
            let [from, to] = several(table, &specs::X_RANGE)?;
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
    table.note_list(&specs::X_RANGE, &[range.0, range.1]);
    Some(range)
}

/// A list of exactly so many quantities.
fn several<const N: usize>(table: &TableReader<'_>, spec: &ParamSpec) -> Option<[Found<f64>; N]> {
    table.asks(spec.key, spec.meaning, || Answer::Numbers(*spec, Some(N)));
    let Node { span, value } = table.node(spec.key)?;
    if let Value::Array(nodes) = value
        && nodes.len() == N
    {
        let found: Vec<_> = nodes.iter().map(|node| table.number_at(node, spec)).collect();
        let found: Option<Vec<Found<f64>>> = found.into_iter().collect();
        return found?.try_into().ok();
    }
    let (count, kind, example) = match N {
        2 => ("two", "lengths", "\"0.3 m\", \"0.7 m\""),
        _ => ("three", "spins", "\"0 rad/s\", \"-10 rad/s\", \"2 rad/s\""),
    };
    table.reader.report(
        Diagnostic::error(format!("`{}` is not a list of {count} {kind}", spec.key))
            .at(*span, format!("expected {count} {kind}"))
            .help(format!("write {} = [{example}]", spec.key)),
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
