//! `[container]`.

use engine::grains::Space;

use super::Places;
use crate::diagnostics::Diagnostic;
use crate::model::{BottomKind, Container, ContainerShape, SidesKind};
use crate::reader::TableReader;
use crate::specs;

/// Reads `[container]` of a bed in `space`.
pub(super) fn container(
    table: TableReader<'_>,
    space: Space,
    places: &mut Places,
) -> Option<Container> {
    let shape = shape(&table, space);
    let extents = shape.and_then(|shape| match shape {
        ContainerShape::Box => {
            let width = table.number(&specs::WIDTH).map(|found| found.value);
            let depth = depth(&table, space);
            Some([width?, depth?])
        }
        ContainerShape::Cylinder => {
            table.number(&specs::CONTAINER_DIAMETER).map(|found| [found.value; 2])
        }
    });
    let sides = sides(&table, shape);
    let bottom = table.choice("bottom", &["wall", "absorbing"], &[], "what the bottom is");
    let bottom = bottom.map(|bottom| match bottom {
        "absorbing" => BottomKind::Absorbing,
        _ => BottomKind::Wall,
    });
    let absorbs = sides == Some(SidesKind::Absorbing) || bottom == Some(BottomKind::Absorbing);
    let thickness = table.optional_number(&specs::ABSORBING_THICKNESS);
    let rate = table.optional_number(&specs::ABSORBING_RATE);
    for key in ["absorbing_thickness", "absorbing_rate"] {
        if table.has(key) && !absorbs && sides.is_some() && bottom.is_some() {
            table.reader.report(
                Diagnostic::error(format!("`{key}` without anything that absorbs"))
                    .at(table.span_of(key), "of which layer?")
                    .help("remove it, or write sides = \"absorbing\" or bottom = \"absorbing\""),
            );
        }
    }
    places.width = table.span_of("width").or_else(|| table.span_of("diameter"));
    places.depth = table.span_of("depth").or(places.width);
    // Without the shape nobody knows which keys belong.
    if shape.is_some() {
        table.finish();
    }
    let value = |found: Option<crate::reader::Found<f64>>| found.map(|found| found.value);
    let [width, depth] = extents?;
    Some(Container {
        shape: shape?,
        width,
        depth,
        sides: sides?,
        bottom: bottom?,
        absorbing_thickness: value(thickness?),
        absorbing_rate: value(rate?),
    })
}

fn shape(table: &TableReader<'_>, space: Space) -> Option<ContainerShape> {
    let shape = table.choice("shape", &["box", "cylinder"], &[], "the shape of the container")?;
    if shape == "box" {
        return Some(ContainerShape::Box);
    }
    if space == Space::Planar {
        table.reader.report(
            Diagnostic::error("a planar bed has no cylinder")
                .at(table.span_of("shape"), "is for dimension = 3")
                .help("write shape = \"box\", or dimension = 3 in [medium]"),
        );
        return None;
    }
    Some(ContainerShape::Cylinder)
}

fn sides(table: &TableReader<'_>, shape: Option<ContainerShape>) -> Option<SidesKind> {
    let sides =
        table.choice("sides", &["wall", "periodic", "absorbing"], &[], "what the sides are")?;
    if sides == "periodic" && shape == Some(ContainerShape::Cylinder) {
        table.reader.report(
            Diagnostic::error("the side of a cylinder cannot be periodic")
                .at(table.span_of("sides"), "has no opposite")
                .with(table.span_of("shape"), "the shape")
                .help("write sides = \"wall\", or shape = \"box\""),
        );
        return None;
    }
    Some(match sides {
        "periodic" => SidesKind::Periodic,
        "absorbing" => SidesKind::Absorbing,
        _ => SidesKind::Wall,
    })
}

/// The depth of a box in space (m); 0 in a plane, which has none.
fn depth(table: &TableReader<'_>, space: Space) -> Option<f64> {
    match space {
        Space::Spatial => table.number(&specs::DEPTH).map(|found| found.value),
        Space::Planar if table.has("depth") => {
            table.reader.report(
                Diagnostic::error("a planar bed has no depth")
                    .at(table.span_of("depth"), "is for dimension = 3")
                    .help("remove it, or write dimension = 3 in [medium]"),
            );
            None
        }
        Space::Planar => Some(0.0),
    }
}
