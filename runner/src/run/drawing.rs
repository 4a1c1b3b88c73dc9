//! Intruders as they are drawn.

use std::f64::consts::TAU;

use engine::grains::Space;
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::record::LoggedShape;
use intruders::{Drawing, ShapeEntry};

/// Corners of a drawn round section.
const CORNERS: usize = 32;

/// Thickness of a drawn planar body, in its diameter.
const THICKNESS: f64 = 0.1;

/// An intruder of this `shape`, or of a chain each of its links, as it is drawn about its centre of
/// mass; `params` are SI values that fill those of the shape.
pub fn shape_of(shape: &ShapeEntry, params: &ParamTable, space: Space) -> LoggedShape {
    match ((shape.build)(params, space).drawing, space) {
        (Drawing::Ball(radius), Space::Spatial) => LoggedShape::Sphere { radius },
        (Drawing::Ball(radius), Space::Planar) => {
            LoggedShape::Disc { radius, thickness: THICKNESS * 2.0 * radius }
        }
        (Drawing::Revolved(sections), _) => body(&sections, space),
    }
}

/// A closed surface around sections (height (m), half width (m)) in rising order.
fn body(sections: &[(f64, f64)], space: Space) -> LoggedShape {
    let corners: Vec<(f64, f64)> = match space {
        Space::Planar => vec![(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)],
        Space::Spatial => (0..CORNERS)
            .map(|corner| {
                let angle = TAU * corner as f64 / CORNERS as f64;
                (libm::cos(angle), libm::sin(angle))
            })
            .collect(),
    };
    let widest = sections.iter().map(|(_, half_width)| *half_width).fold(0.0, f64::max);
    let n = corners.len() as u32;
    let mut vertices = Vec::new();
    for &(height, half_width) in sections {
        let across = match space {
            Space::Planar => THICKNESS * widest,
            Space::Spatial => half_width,
        };
        vertices.extend(corners.iter().map(|(x, y)| Vec3::new(half_width * x, across * y, height)));
    }
    let last = n * (sections.len() as u32 - 1);
    let mut triangles = Vec::new();
    for ring in (0..last).step_by(n as usize) {
        for corner in 0..n {
            let next = (corner + 1) % n;
            let [a, b, c, d] = [ring + corner, ring + next, ring + n + corner, ring + n + next];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    for corner in 1..n - 1 {
        triangles.push([0, corner + 1, corner]);
        triangles.push([last, last + corner, last + corner + 1]);
    }
    LoggedShape::Mesh { vertices, triangles }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_of_a_drawn_body_is_walked_once_in_each_direction() {
        for space in [Space::Planar, Space::Spatial] {
            let shape = body(&[(-1.0, 0.5), (0.0, 1.0), (2.0, 0.25)], space);
            let LoggedShape::Mesh { vertices, triangles } = shape else { panic!("a mesh") };
            let mut edges: Vec<(u32, u32)> =
                triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
            edges.sort_unstable();
            let count = edges.len();
            edges.dedup();
            assert_eq!(edges.len(), count, "{space:?}");
            assert!(edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok()), "{space:?}");
            let volume: f64 = triangles
                .iter()
                .map(|&[a, b, c]| {
                    let [a, b, c] = [a, b, c].map(|corner| vertices[corner as usize]);
                    a.dot(&b.cross(&c)) / 6.0
                })
                .sum();
            assert!(volume > 0.0, "outside is outside");
        }
    }
}
