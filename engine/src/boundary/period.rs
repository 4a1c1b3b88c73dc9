//! Sides that are no sides: what leaves on one comes in on the other.

use crate::lanes::Lanes;
use crate::math::Vec3;

/// Half the lengths (m) along x and y after which everything repeats; infinite where nothing does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    half: [f64; 2],
}

impl Default for Period {
    fn default() -> Self {
        Self::NONE
    }
}

impl Period {
    /// Nothing repeats.
    pub const NONE: Self = Self { half: [f64::INFINITY; 2] };

    /// Repeats after `width` (m) along x and `depth` (m) along y.
    pub fn new(width: f64, depth: f64) -> Self {
        Self { half: [0.5 * width, 0.5 * depth] }
    }

    /// The length (m) after which it repeats along x (0) or y (1), if it does.
    pub(crate) fn length(&self, axis: usize) -> Option<f64> {
        self.half.get(axis).map(|half| 2.0 * half).filter(|length| length.is_finite())
    }

    /// Whether nothing repeats.
    #[inline(always)]
    pub(crate) fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The coordinate along `axis` of the shortest of the vectors that lead from one point to the images of
    /// another, given that of one between points inside of the container.
    #[inline(always)]
    pub(crate) fn nearest<R: Lanes>(&self, axis: usize, at: R) -> R {
        // Without a branch: where nothing repeats, nothing is beyond half of an infinite length.
        let [half, length] = [self.half[axis], 2.0 * self.half[axis]].map(R::splat);
        let below = (at - length).select(at.simd_gt(half), at);
        (at + length).select(at.simd_lt(-half), below)
    }

    /// The shortest of the vectors that lead from one point to the images of another, given one of
    /// them between points inside of the container.
    #[inline(always)]
    pub(crate) fn shortest(&self, apart: Vec3) -> Vec3 {
        Vec3::new(self.nearest(0, apart.x), self.nearest(1, apart.y), apart.z)
    }

    /// The image of `point` that is nearest to `reference`, which may lie anywhere.
    #[inline]
    pub(crate) fn image_near(&self, point: Vec3, reference: Vec3) -> Vec3 {
        let along = |at: f64, to: f64, half: f64| {
            if (at - to).abs() <= half {
                return at;
            }
            at - 2.0 * half * ((at - to) / (2.0 * half) + 0.5).floor()
        };
        Vec3::new(
            along(point.x, reference.x, self.half[0]),
            along(point.y, reference.y, self.half[1]),
            point.z,
        )
    }

    /// The image of `point` inside of the container, from 0 to the length of the period.
    #[inline]
    pub(crate) fn inside(&self, point: Vec3) -> Vec3 {
        Vec3::new(self.coordinate_inside(0, point.x), self.coordinate_inside(1, point.y), point.z)
    }

    /// The same for one coordinate, along x (0) or y (1). Where an axis does not repeat a point may lie
    /// behind the wall.
    #[inline(always)]
    pub(crate) fn coordinate_inside(&self, axis: usize, at: f64) -> f64 {
        let half = self.half[axis];
        let length = 2.0 * half;
        if at < 0.0 && half.is_finite() {
            at + length
        } else if at >= length {
            at - length
        } else {
            at
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NARROW: Period = Period { half: [0.5, f64::INFINITY] };

    #[test]
    fn the_shortest_way_leads_across_the_side_where_that_is_nearer() {
        let apart = NARROW.shortest(Vec3::new(0.75, 3.0, -2.0));
        assert_eq!(apart, Vec3::new(-0.25, 3.0, -2.0));
        assert_eq!(NARROW.shortest(-apart), Vec3::new(0.25, -3.0, 2.0));
        let image = NARROW.image_near(Vec3::x() * 0.125, Vec3::x() * 7.75);
        assert_eq!(image, Vec3::x() * 8.125);
        assert_eq!(NARROW.inside(Vec3::new(-0.25, -1.0, 0.0)), Vec3::new(0.75, -1.0, 0.0));
        assert_eq!(NARROW.inside(Vec3::x()), Vec3::zeros());
    }

    #[test]
    fn where_nothing_repeats_every_vector_stays_as_it_is() {
        let vector = Vec3::new(1e3, -1e3, 0.1);
        assert_eq!(Period::NONE.shortest(vector), vector);
        assert_eq!(Period::NONE.image_near(vector, -vector), vector);
        assert_eq!(Period::NONE.inside(vector), vector);
    }
}
