//! Pieces of an outline, and what lies between them.

use std::f64::consts::FRAC_PI_2;

use engine::grains::Space;

/// Share of the size of a body within which the direction from a corner to a point is round-off.
const TOO_NEAR: f64 = 1e-9;

/// A point or a direction of the half-plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// Across the axis, from it (m or 1).
    pub(super) r: f64,
    /// Along the axis (m or 1).
    pub(super) z: f64,
}

/// A piece of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) enum Facet {
    /// A face or a side.
    Straight {
        from: Point,
        /// Unit vector, with the body on its left.
        along: Point,
        /// (m).
        length: f64,
        /// Whether the body feels what touches it.
        felt: bool,
    },
    /// Half a ball about the height `centre` of the axis (m).
    Dome { centre: f64, radius: f64, is_upper: bool },
}

/// An edge or a tip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: Point,
    /// In the middle of those of both sides.
    normal: Point,
    pub(super) felt: bool,
}

/// The nearest point of an outline, and how far it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) normal: Point,
    /// (m), negative inside.
    pub(super) gap: f64,
    /// (1/m).
    pub(super) curvature: f64,
    pub(super) felt: bool,
}

impl Point {
    pub(super) fn dot(self, other: Self) -> f64 {
        self.r * other.r + self.z * other.z
    }

    /// Whether the two are the same but for round-off.
    pub(super) fn is_near(self, other: Self) -> bool {
        self.minus(other).norm() < TOO_NEAR
    }

    fn minus(self, other: Self) -> Self {
        Self { r: self.r - other.r, z: self.z - other.z }
    }

    fn over(self, divisor: f64) -> Self {
        Self { r: self.r / divisor, z: self.z / divisor }
    }

    fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }
}

impl Facet {
    pub(super) fn straight(from: Point, to: Point, felt: bool) -> Self {
        let across = to.minus(from);
        let length = across.norm();
        Self::Straight { from, along: across.over(length), length, felt }
    }

    /// Where it begins, on the way from the lowest point of the axis to the highest.
    pub(super) fn start(&self) -> Point {
        match *self {
            Self::Straight { from, .. } => from,
            Self::Dome { centre, radius, is_upper: true } => Point { r: radius, z: centre },
            Self::Dome { centre, radius, .. } => Point { r: 0.0, z: centre - radius },
        }
    }

    /// Where it ends.
    pub(super) fn end(&self) -> Point {
        match *self {
            Self::Straight { from, along, length, .. } => {
                Point { r: from.r + along.r * length, z: from.z + along.z * length }
            }
            Self::Dome { centre, radius, is_upper: true } => Point { r: 0.0, z: centre + radius },
            Self::Dome { centre, radius, .. } => Point { r: radius, z: centre },
        }
    }

    pub(super) fn is_felt(&self) -> bool {
        match *self {
            Self::Straight { felt, .. } => felt,
            Self::Dome { .. } => true,
        }
    }

    /// Farthest distance from the origin (m).
    pub(super) fn reach(&self) -> f64 {
        let ends = self.start().norm().max(self.end().norm());
        match *self {
            Self::Straight { .. } => ends,
            // With its centre above the origin, a lower dome is farthest at an end.
            Self::Dome { centre, radius, is_upper } if (centre >= 0.0) == is_upper => {
                centre.abs() + radius
            }
            Self::Dome { .. } => ends,
        }
    }

    /// Outward normal at the point `at` of it.
    pub(super) fn normal_at(&self, at: Point) -> Point {
        match *self {
            Self::Straight { along, .. } => Point { r: along.z, z: -along.r },
            Self::Dome { centre, radius, .. } => at.minus(Point { r: 0.0, z: centre }).over(radius),
        }
    }

    /// How far a dome reaches along `direction` from the origin (m), if that is on it.
    pub(super) fn dome_support(&self, direction: Point) -> Option<f64> {
        match *self {
            Self::Dome { centre, radius, is_upper } if (direction.z >= 0.0) == is_upper => {
                Some(centre * direction.z + radius * direction.norm())
            }
            _ => None,
        }
    }

    /// The nearest point of the line or circle that it is part of, and whether it is of this part.
    /// None if only another piece can be the nearest.
    pub(super) fn foot(&self, point: Point, space: Space) -> Option<(Foot, bool)> {
        match *self {
            Self::Straight { from, along, length, felt } => {
                let normal = Point { r: along.z, z: -along.r };
                let apart = point.minus(from);
                let (gap, way) = (apart.dot(normal), apart.dot(along));
                let curvature = match space {
                    Space::Planar => 0.0,
                    Space::Spatial => side_curvature(normal.r, from.r + along.r * way, gap),
                };
                let is_within = (0.0..=length).contains(&way);
                Some((Foot { normal, gap, curvature, felt }, is_within))
            }
            Self::Dome { centre, radius, is_upper } => {
                let apart = point.minus(Point { r: 0.0, z: centre });
                if (apart.z > 0.0) != is_upper {
                    return None;
                }
                let distance = apart.norm();
                let pole = Point { r: 0.0, z: if is_upper { 1.0 } else { -1.0 } };
                let normal = if distance > 0.0 { apart.over(distance) } else { pole };
                let gap = distance - radius;
                Some((Foot { normal, gap, curvature: 1.0 / radius, felt: true }, true))
            }
        }
    }

    /// Points of it, from start to end.
    pub(super) fn drawn(&self, pieces: u32) -> Vec<Point> {
        let Self::Dome { centre, radius, is_upper } = *self else {
            return vec![self.start(), self.end()];
        };
        let round = (0..=pieces).map(|piece| {
            let latitude = FRAC_PI_2 * f64::from(piece) / f64::from(pieces);
            if is_upper { latitude } else { latitude - FRAC_PI_2 }
        });
        let mut points: Vec<Point> = round
            .map(|latitude| {
                let (sin, cos) = libm::sincos(latitude);
                Point { r: radius * cos, z: centre + radius * sin }
            })
            .collect();
        let ends = [self.start(), self.end()];
        points[0] = ends[0];
        points[pieces as usize] = ends[1];
        points
    }
}

/// Curvature (1/m) that stands for a side which is curved around the axis only, at the distance `r`
/// (m) from it, where the normal leans away from it by `across`.
///
/// Hertz's theory for two curvatures has to a good approximation the effective radius
/// R* = 1/√((1/R)(1/R + k)) of the geometric mean, R the radius of the grain and k = `across`/r. What
/// gives that R* when it is added to 1/R is (√(1 + k R) − 1)/R; the centre of a grain that touches is
/// R away. A side that is curved more than the grain, near the tip of a cone, counts as the grain.
fn side_curvature(across: f64, r: f64, gap: f64) -> f64 {
    let gap = gap.abs();
    let radius = r.max(across * gap);
    if across <= 0.0 || radius <= 0.0 {
        return 0.0;
    }
    let curvature = across / radius;
    curvature / (1.0 + (1.0 + curvature * gap).sqrt())
}

impl Corner {
    /// Between sides of these normals.
    pub(super) fn new(at: Point, normals: [Point; 2], felt: bool) -> Self {
        let [a, b] = normals;
        let sum = Point { r: a.r + b.r, z: a.z + b.z };
        // On the axis both halves of the body meet, and what lies across it cancels.
        let sum = if at.r == 0.0 { Point { r: 0.0, z: sum.z } } else { sum };
        Self { at, normal: sum.over(sum.norm()), felt }
    }

    /// Of a point outside of a body of this `size` (m). Without curvature: on an edge the grain's own
    /// radius rules.
    pub(super) fn foot(&self, point: Point, size: f64) -> Foot {
        let apart = point.minus(self.at);
        let gap = apart.norm();
        let normal = if gap > TOO_NEAR * size { apart.over(gap) } else { self.normal };
        Foot { normal, gap, curvature: 0.0, felt: self.felt }
    }
}
