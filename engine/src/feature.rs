//! By what a body meets a wall: domes, rims and tips.
//!
//! A grain is round and meets a surface in one point. A body with faces and edges may lie on a wall, and
//! one point would let it rock. So a rim meets a wall in three points that are evenly spaced around it, the
//! foremost one first: as long as all three touch, springs of equal stiffness push and turn the body as if they were spread evenly,
//! wherever the first one is; as soon as the body tilts, the foremost point alone is left, as it must be.

use arrayvec::ArrayVec;

use crate::math::Vec3;

/// Points in which one feature meets a wall, at most.
const MOST_POINTS: usize = 3;

/// Half of √3.
const SIN_120: f64 = 0.866_025_403_784_438_6;

/// A piece of a body of revolution about z, in the frame of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// Its centre on the axis (m).
    height: f64,
    /// Around the axis or around the centre (m).
    radius: f64,
    kind: Kind,
    /// 1/m, as a contact law adds it to that of the wall.
    curvature: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Ball,
    /// Half a ball up or down, with its edge.
    Dome {
        is_upper: bool,
    },
    /// A circle, met in so many points; without the foremost of them where a dome ends there.
    Rim {
        n: usize,
        after_foremost: bool,
    },
}

impl Feature {
    /// A ball of `radius` (m) about the origin.
    pub const fn ball(radius: f64) -> Self {
        Self { height: 0.0, radius, kind: Kind::Ball, curvature: 1.0 / radius }
    }

    /// The lower or upper half of a ball about `height` (m) of the axis, its edge included.
    pub const fn dome(height: f64, radius: f64, is_upper: bool) -> Self {
        Self { height, radius, kind: Kind::Dome { is_upper }, curvature: 1.0 / radius }
    }

    /// A sharp rim of `radius` (m) at `height` (m): three points of it, in a plane both. Of one that ends a
    /// dome the foremost point is the dome's. It counts as curved like a ball of `edge_radius` (m).
    pub const fn rim(
        (height, radius): (f64, f64),
        is_planar: bool,
        ends_dome: bool,
        edge_radius: f64,
    ) -> Self {
        let n = if is_planar { 2 } else { 3 };
        let kind = Kind::Rim { n, after_foremost: ends_dome };
        Self { height, radius, kind, curvature: 1.0 / edge_radius }
    }

    /// A tip at `height` (m) of the axis, which counts as curved like a ball of `edge_radius` (m).
    pub const fn tip(height: f64, edge_radius: f64) -> Self {
        let kind = Kind::Rim { n: 1, after_foremost: false };
        Self { height, radius: 0.0, kind, curvature: 1.0 / edge_radius }
    }

    /// Curvature (1/m) of a ball that would be as stiff at a wall.
    pub fn curvature(&self) -> f64 {
        self.curvature
    }

    /// In how many points it meets a wall.
    pub fn n_points(&self) -> usize {
        match self.kind {
            Kind::Ball | Kind::Dome { .. } => 1,
            Kind::Rim { n, after_foremost } => n - usize::from(after_foremost),
        }
    }

    /// The middle of it (m, body frame).
    pub(crate) fn middle(&self) -> Vec3 {
        Vec3::z() * self.height
    }

    /// Its foremost point (m, body frame) in the direction of the unit vector `towards`.
    pub(crate) fn foremost(&self, towards: Vec3) -> Vec3 {
        match self.kind {
            Kind::Ball => self.middle() + towards * self.radius,
            Kind::Dome { is_upper } if (towards.z >= 0.0) == is_upper || towards.z == 0.0 => {
                self.middle() + towards * self.radius
            }
            Kind::Dome { .. } | Kind::Rim { .. } => self.around(towards, [1.0, 0.0]),
        }
    }

    /// The points (m, body frame) in which it meets a wall that lies `towards` (unit vector) it, the
    /// foremost first.
    pub fn points(&self, towards: Vec3) -> ArrayVec<Vec3, MOST_POINTS> {
        let Kind::Rim { n, after_foremost } = self.kind else {
            return ArrayVec::from_iter([self.foremost(towards)]);
        };
        let turns = match n {
            1 => &[[1.0, 0.0]][..],
            2 => &[[1.0, 0.0], [-1.0, 0.0]],
            _ => &[[1.0, 0.0], [-0.5, SIN_120], [-0.5, -SIN_120]],
        };
        let turns = turns.iter().skip(usize::from(after_foremost));
        turns.map(|turn| self.around(towards, *turn)).collect()
    }

    /// The point of the circle that lies `towards` there, turned about the axis by an angle of this cosine
    /// and sine.
    fn around(&self, towards: Vec3, [cos, sin]: [f64; 2]) -> Vec3 {
        let across = (towards.x * towards.x + towards.y * towards.y).sqrt();
        // Flat on a wall every point is as near as any other.
        let (x, y) =
            if across > 0.0 { (towards.x / across, towards.y / across) } else { (1.0, 0.0) };
        Vec3::new(self.radius * (cos * x - sin * y), self.radius * (sin * x + cos * y), self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIM: Feature = Feature::rim((-0.5, 2.0), false, false, 2.0);

    #[test]
    fn three_points_of_a_rim_stand_evenly_around_it_with_the_foremost_first() {
        let towards = Vec3::new(0.3, -0.4, -0.8).normalize();
        let points = RIM.points(towards);
        assert_eq!(points.len(), RIM.n_points());
        assert!(points[1..].iter().all(|point| point.dot(&towards) < points[0].dot(&towards)));
        // Sums of three numbers of order one.
        let middle: Vec3 = points.iter().sum::<Vec3>() / 3.0;
        assert!((middle - Vec3::new(0.0, 0.0, -0.5)).norm() < 1e-15);
        for point in &points {
            assert!(((point - middle).norm() - 2.0).abs() < 1e-15);
        }
        // Second moments across the axis: equal in all directions, so they turn a tilted face alike.
        let moment = |a: usize, b: usize| points.iter().map(|p| p[a] * p[b]).sum::<f64>();
        assert!((moment(0, 0) - 6.0).abs() < 1e-14 && (moment(1, 1) - 6.0).abs() < 1e-14);
        assert!(moment(0, 1).abs() < 1e-14);
    }

    #[test]
    fn a_dome_is_met_at_its_cap_or_at_its_edge_without_a_jump() {
        let dome = Feature::dome(0.0, 1.0, false);
        for (z, expected) in [(-1e-9, -1e-9), (0.0, 0.0), (1e-9, 0.0)] {
            let point = dome.foremost(Vec3::new(1.0, 0.0, z));
            assert!((point - Vec3::new(1.0, 0.0, expected)).norm() < 1e-15, "{z:e}");
        }
        assert_eq!(dome.foremost(Vec3::z()), Vec3::x());
    }

    #[test]
    fn a_rim_in_a_plane_is_two_corners_and_one_that_ends_a_dome_lacks_the_foremost() {
        let towards = Vec3::new(0.6, 0.0, -0.8);
        let corners = Feature::rim((0.0, 1.0), true, false, 1.0).points(towards);
        assert_eq!(corners[..], [Vec3::x(), -Vec3::x()]);
        let other = Feature::rim((0.0, 1.0), true, true, 1.0);
        assert_eq!(other.points(towards)[..], [-Vec3::x()]);
        assert_eq!(other.n_points(), 1);
        assert_eq!(Feature::tip(0.25, 1.0).points(towards)[..], [Vec3::z() * 0.25]);
    }
}
