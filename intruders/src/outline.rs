//! Convex bodies of revolution about z, in closed form in the half-plane of radius and height.
//!
//! parry projects points on cylinders, cones and capsules too, and is the oracle of the tests; but it
//! gives a point without a normal, which near the surface cannot be had from the difference of two
//! points, it takes 160 ns for a cone, and it has no hemisphere. Here a query is turned into the
//! half-plane, where every feature (face, side, dome, edge, tip) says its own normal.
//!
//! In a plane the outline and its mirror image are the body, and its sides are not curved.

use engine::feature::Feature;
use engine::grains::Space;
use engine::math::Vec3;
use engine::surface::{Surface, SurfacePoint};

use facet::{Corner, Facet, Foot, Point};

mod facet;

/// Points in which the outline of a dome is drawn.
const DRAWN: u32 = 12;

/// A convex body of revolution, by its outline from the lowest point of its axis to the highest.
pub(crate) struct Revolved {
    facets: Vec<Facet>,
    corners: Vec<Corner>,
    features: Vec<Feature>,
    size: f64,
    space: Space,
    is_recessive: bool,
}

/// An outline on its way from the lowest point of the axis to the highest.
pub(crate) struct Draft {
    facets: Vec<Facet>,
    end: Point,
    felt: bool,
}

impl Draft {
    /// Starts on the axis at height `z` (m).
    pub(crate) fn at(z: f64) -> Self {
        Self { facets: Vec::new(), end: Point { r: 0.0, z }, felt: true }
    }

    /// Goes straight to the point `r` from the axis at height `z` (m).
    pub(crate) fn line_to(mut self, r: f64, z: f64) -> Self {
        let to = Point { r, z };
        if to == self.end {
            return self;
        }
        self.facets.push(Facet::straight(self.end, to, self.felt));
        self.end = to;
        self
    }

    /// Goes around half a ball of `radius` (m): from the axis to its equator, or from there back.
    pub(crate) fn dome(mut self, radius: f64) -> Self {
        let is_upper = self.end.r > 0.0;
        let centre = if is_upper { self.end.z } else { self.end.z + radius };
        let dome = Facet::Dome { centre, radius, is_upper };
        self.facets.push(dome);
        self.end = dome.end();
        self
    }

    /// Goes over the top plane to the axis; with a shaft, up along that before. `shaft` is its length
    /// (m), and the body does not feel what touches it.
    pub(crate) fn close(mut self, shaft: Option<f64>) -> Self {
        let Point { r, z } = self.end;
        let Some(length) = shaft else { return self.line_to(0.0, z) };
        self.felt = false;
        self.line_to(r, z + length).line_to(0.0, z + length)
    }

    /// The body in `space`.
    pub(crate) fn revolve(self, space: Space) -> Revolved {
        let (facets, is_recessive) = (self.facets, !self.felt);
        let axis_ends = [Point { r: 0.0, z: -1.0 }, Point { r: 0.0, z: 1.0 }];
        let corners: Vec<Corner> = (0..=facets.len())
            .map(|place| {
                let (before, after) = (place.checked_sub(1).map(|k| facets[k]), facets.get(place));
                let at = after.map_or(self.end, Facet::start);
                let normals = [
                    before.map_or(axis_ends[0], |facet| facet.normal_at(at)),
                    after.map_or(axis_ends[1], |facet| facet.normal_at(at)),
                ];
                // The edge between the body and its shaft is the body's.
                let felt = before.or(after.copied()).is_none_or(|facet| facet.is_felt());
                Corner::new(at, normals, felt)
            })
            .collect();
        let size = facets.iter().map(Facet::reach).fold(0.0, f64::max);
        let features = features(&facets, space);
        Revolved { facets, corners, features, size, space, is_recessive }
    }
}

/// By what the body with this outline meets a wall: its domes, sharp rims and tips, but not its shaft.
fn features(facets: &[Facet], space: Space) -> Vec<Feature> {
    let felt: Vec<Facet> = facets.iter().copied().filter(Facet::is_felt).collect();
    let ends = || felt.iter().map(Facet::start).chain(felt.last().map(Facet::end));
    // An edge, a tip and a face have no curvature that a law could use: they count as a ball of the width of the body.
    let edge_radius = ends().map(|end| end.r).fold(0.0, f64::max);
    let domes = felt.iter().filter_map(|facet| match *facet {
        Facet::Dome { centre, radius, is_upper } => Some(Feature::dome(centre, radius, is_upper)),
        Facet::Straight { .. } => None,
    });
    let corners = ends().enumerate().filter_map(|(place, at)| {
        let beside = [place.checked_sub(1).map(|k| felt[k]), felt.get(place).copied()];
        let sides = || beside.iter().flatten();
        let ends_dome = sides().any(|facet| matches!(facet, Facet::Dome { .. }));
        if at.r == 0.0 {
            let is_sharp = |facet: &Facet| facet.normal_at(at).r != 0.0;
            return sides().any(is_sharp).then(|| Feature::tip(at.z, edge_radius));
        }
        let is_smooth = match beside {
            [Some(before), Some(after)] => before.normal_at(at).is_near(after.normal_at(at)),
            _ => false,
        };
        let is_planar = space == Space::Planar;
        (!is_smooth).then(|| Feature::rim((at.z, at.r), is_planar, ends_dome, edge_radius))
    });
    domes.chain(corners).collect()
}

impl Revolved {
    fn nearest(&self, point: Point) -> Foot {
        let (mut is_outside, mut least_below): (bool, Option<Foot>) = (false, None);
        for facet in &self.facets {
            let Some((foot, is_within)) = facet.foot(point, self.space) else { continue };
            is_outside |= foot.gap >= 0.0;
            // A point above a facet of a convex body has its nearest point there.
            if is_within && foot.gap >= 0.0 {
                return foot;
            }
            if is_within && least_below.is_none_or(|least| foot.gap > least.gap) {
                least_below = Some(foot);
            }
        }
        // Below every facet it is inside.
        if let Some(foot) = least_below.filter(|_| !is_outside) {
            return foot;
        }
        let corners = self.corners.iter().map(|corner| corner.foot(point, self.size));
        corners.reduce(|a, b| if b.gap < a.gap { b } else { a }).expect("an outline has ends")
    }

    /// Heights above the origin, and half widths there (m), from the lowest to the highest.
    pub(crate) fn sections(&self) -> Vec<(f64, f64)> {
        let felt = self.facets.iter().filter(|facet| facet.is_felt());
        let mut sections: Vec<(f64, f64)> =
            felt.flat_map(|facet| facet.drawn(DRAWN)).map(|point| (point.z, point.r)).collect();
        if self.is_recessive
            && let Some(&(top, _)) = sections.last()
        {
            sections.push((top, 0.0));
        }
        sections.dedup();
        sections
    }
}

impl Surface for Revolved {
    fn closest(&self, point: Vec3) -> SurfacePoint {
        let r = (point.x * point.x + point.y * point.y).sqrt();
        // On the axis every side is as near as any other.
        let (x, y) = if r > 0.0 { (point.x / r, point.y / r) } else { (1.0, 0.0) };
        let Foot { normal, gap, curvature, felt } = self.nearest(Point { r, z: point.z });
        let normal = Vec3::new(normal.r * x, normal.r * y, normal.z);
        SurfacePoint { normal, gap, curvature, felt }
    }

    fn support(&self, direction: Vec3) -> f64 {
        let r = (direction.x * direction.x + direction.y * direction.y).sqrt();
        let direction = Point { r, z: direction.z };
        // How deep and how wide a body is does not count its shaft.
        let own = self.corners.iter().filter(|corner| corner.felt);
        let corners = own.map(|corner| corner.at.dot(direction));
        let domes = self.facets.iter().filter_map(|facet| facet.dome_support(direction));
        corners.chain(domes).fold(f64::NEG_INFINITY, f64::max)
    }

    fn bounding_radius(&self) -> f64 {
        self.size
    }

    fn features(&self) -> &[Feature] {
        &self.features
    }

    fn is_recessive(&self) -> bool {
        self.is_recessive
    }
}
