//! The surface of a bed around an impact: crater, rim, and what has not moved.
//!
//! The surface is the upper envelope of the grains that touch something; a grain that touches nothing is
//! in the air. It is sampled on a square grid of columns a tenth of a mean diameter apart and averaged
//! over rings about the axis of the impact (planar: over intervals to either side of it).

use crate::grains::Grains;
use crate::math::Vec3;
use crate::space::Space;

/// Columns per mean grain diameter.
const COLUMNS_PER_DIAMETER: f64 = 10.0;

/// A point of the mean surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CraterPoint {
    /// In the plane y = const through the axis, on the side of larger x (planar: on both sides) (m).
    pub position: Vec3,
    /// Distance from the axis (m); planar, negative to its left.
    pub distance: f64,
}

/// The mean surface of `grains` around the vertical axis through `x`, `y` (m), in rings as wide as a mean
/// diameter; `lies` says of each grain whether it belongs to the bed. Rings that reach beyond the bed's
/// own extent are left out.
pub fn crater(grains: &Grains, lies: &[bool], (x, y): (f64, f64)) -> Vec<CraterPoint> {
    let mean_diameter = grains.mean_diameter();
    let columns = Columns::of(grains, lies, mean_diameter / COLUMNS_PER_DIAMETER);
    let is_planar = grains.space == Space::Planar;
    let extent = columns.room_around(x, y, is_planar);
    let n_rings = (extent / mean_diameter).floor() as usize;
    let n_bins = if is_planar { 2 * n_rings } else { n_rings };
    let mut sums = vec![(0.0, 0_u32); n_bins];
    for (at_x, at_y, height) in columns.heights() {
        let distance = match grains.space {
            Space::Planar => at_x - x + n_rings as f64 * mean_diameter,
            Space::Spatial => length(at_x - x, at_y - y),
        };
        if distance < 0.0 {
            continue;
        }
        if let Some((sum, n)) = sums.get_mut((distance / mean_diameter) as usize) {
            *sum += height;
            *n += 1;
        }
    }
    let first = if is_planar { n_rings as f64 } else { 0.0 };
    sums.iter()
        .enumerate()
        .filter(|(_, (_, n))| *n > 0)
        .map(|(bin, (sum, n))| {
            let distance = (bin as f64 + 0.5 - first) * mean_diameter;
            let height = sum / f64::from(*n);
            CraterPoint { position: Vec3::new(x + distance, y, height), distance }
        })
        .collect()
}

/// How large a crater is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CraterSize {
    /// Depth of its lowest point below the undisturbed surface (m); negative where all of it lies above.
    pub depth: f64,
    /// Distance between the highest points of its rim (m), across the axis.
    pub rim_diameter: f64,
}

/// Depth and width of the crater with this `profile`, in a bed whose undisturbed surface is at the height `surface` (m);
/// `None` of a profile without a rim on every side of its lowest point.
pub fn crater_size(profile: &[CraterPoint], surface: f64, space: Space) -> Option<CraterSize> {
    let height = |at: &CraterPoint| at.position.z;
    let lowest = profile.iter().min_by(|a, b| height(a).total_cmp(&height(b)))?;
    let highest = |side: &mut dyn Iterator<Item = &CraterPoint>| {
        side.max_by(|a, b| height(a).total_cmp(&height(b))).map(|at| at.distance)
    };
    let right = highest(&mut profile.iter().filter(|at| at.distance > lowest.distance))?;
    let rim_diameter = match space {
        // Rings: the rim is as far on every side.
        Space::Spatial => 2.0 * right,
        Space::Planar => {
            right - highest(&mut profile.iter().filter(|at| at.distance < lowest.distance))?
        }
    };
    Some(CraterSize { depth: surface - height(lowest), rim_diameter })
}

/// The highest point of every column that a grain covers.
struct Columns {
    low: [f64; 2],
    high: [f64; 2],
    spacing: f64,
    n: [usize; 2],
    top: Vec<f64>,
}

impl Columns {
    fn of(grains: &Grains, lies: &[bool], spacing: f64) -> Self {
        let here = || (0..grains.len()).filter(|&i| lies[i]);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for i in here() {
            for axis in 0..2 {
                low[axis] = low[axis].min(grains.position(i)[axis] - grains.radius(i));
                high[axis] = high[axis].max(grains.position(i)[axis] + grains.radius(i));
            }
        }
        if grains.space == Space::Planar {
            (low[1], high[1]) = (-0.5 * spacing, 0.5 * spacing);
        }
        let n = [0, 1].map(|axis| ((high[axis] - low[axis]) / spacing).round().max(0.0) as usize);
        let mut columns = Self { low, high, spacing, n, top: vec![f64::NEG_INFINITY; n[0] * n[1]] };
        for i in here() {
            columns.cover(grains.position(i), grains.radius(i));
        }
        columns
    }

    fn centre(&self, axis: usize, k: usize) -> f64 {
        self.low[axis] + (k as f64 + 0.5) * self.spacing
    }

    /// Raises the columns under a grain to its surface.
    fn cover(&mut self, centre: Vec3, radius: f64) {
        let span = |axis: usize| {
            let from = (centre[axis] - radius - self.low[axis]) / self.spacing - 0.5;
            let to = (centre[axis] + radius - self.low[axis]) / self.spacing - 0.5;
            // A cast of a negative number is 0.
            (from.ceil() as usize).min(self.n[axis])
                ..((to.floor() + 1.0) as usize).min(self.n[axis])
        };
        for row in span(1) {
            for column in span(0) {
                let across =
                    length(self.centre(0, column) - centre.x, self.centre(1, row) - centre.y);
                if across < radius {
                    let top = centre.z + (radius * radius - across * across).sqrt();
                    let column = &mut self.top[row * self.n[0] + column];
                    *column = column.max(top);
                }
            }
        }
    }

    /// How far rings about `x`, `y` lie within the bed (m).
    fn room_around(&self, x: f64, y: f64, is_planar: bool) -> f64 {
        let along_x = (x - self.low[0]).min(self.high[0] - x);
        let along_y = (y - self.low[1]).min(self.high[1] - y);
        if is_planar { along_x } else { along_x.min(along_y) }.max(0.0)
    }

    /// Place and height of every column with a grain in it.
    fn heights(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let places = (0..self.n[1]).flat_map(move |row| (0..self.n[0]).map(move |k| (k, row)));
        places
            .zip(&self.top)
            .filter(|(_, top)| top.is_finite())
            .map(|((column, row), &top)| (self.centre(0, column), self.centre(1, row), top))
    }
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::Motion;
    use crate::grains::Grain;

    const RADIUS: f64 = 1e-3;

    /// A square floor of grains with a bowl in it: z = slope × distance from the middle up to 0.
    fn bowl(space: Space, slope: f64) -> Grains {
        let n = 41;
        let rows = if space == Space::Planar { 1 } else { n };
        let middle = 0.5 * 2.0 * RADIUS * f64::from(n - 1);
        let grains: Vec<Grain> = (0..n * rows)
            .map(|k| {
                let x = 2.0 * RADIUS * f64::from(k % n);
                let y = if rows == 1 { 0.0 } else { 2.0 * RADIUS * f64::from(k / n) };
                let off_y = if rows == 1 { 0.0 } else { y - middle };
                let z = (slope * length(x - middle, off_y) - 0.01).min(0.0);
                Grain {
                    position: Vec3::new(x, y, z),
                    velocity: Vec3::zeros(),
                    spin: Vec3::zeros(),
                    radius: RADIUS,
                    mass: 1e-5,
                    id: 0,
                }
            })
            .collect();
        Grains::new(space, &grains)
    }

    #[test]
    fn a_bowl_is_read_back_ring_by_ring() {
        let middle = 40.0 * RADIUS;
        for (space, cap) in
            [(Space::Planar, std::f64::consts::FRAC_PI_4), (Space::Spatial, 2.0 / 3.0)]
        {
            let grains = bowl(space, 0.5);
            let y = if space == Space::Planar { 0.0 } else { middle };
            let profile = crater(&grains, &vec![true; grains.len()], (middle, y));
            assert_eq!(profile.len(), if space == Space::Planar { 40 } else { 20 });
            for at in &profile {
                // Over a grain its surface is on average π/4 (disc) or, over the square that it stands in,
                // about ⅔ (sphere: the gaps between are left out) of a radius above its centre.
                let floor = (0.5 * at.distance.abs() - 0.01).min(0.0) + cap * RADIUS;
                // A ring is one grain wide, and the slope 1/2.
                assert!((at.position.z - floor).abs() < 0.6 * RADIUS, "{space:?} {at:?} {floor}");
            }
            let inner = profile.iter().map(|at| at.position.z).fold(f64::INFINITY, f64::min);
            let outer = profile.iter().map(|at| at.position.z).fold(f64::NEG_INFINITY, f64::max);
            assert!((outer - inner - 0.01).abs() < 1.2 * RADIUS, "{inner} {outer}");
        }
    }

    #[test]
    fn a_bowl_with_a_rim_is_as_deep_and_as_wide_as_it_was_made() {
        // A parabola of 2 cm depth below the surface, a ridge 1 cm high at 5 cm, and a fall behind it.
        let height = |r: f64| match r < 0.05 {
            true => -0.02 + 0.03 * (r / 0.05).powi(2),
            false => 0.01 - 0.2 * (r - 0.05),
        };
        let at = |distance: f64| CraterPoint {
            position: Vec3::new(distance, 0.0, 0.3 + height(distance.abs())),
            distance,
        };
        let half: Vec<CraterPoint> = (0..20).map(|k| at(0.005 * f64::from(k))).collect();
        let whole: Vec<CraterPoint> = (-19..20).map(|k| at(0.005 * f64::from(k))).collect();
        for (profile, space) in [(&half, Space::Spatial), (&whole, Space::Planar)] {
            let size = crater_size(profile, 0.3, space).expect("a crater");
            assert!((size.depth - 0.02).abs() < 1e-12, "{size:?}");
            assert!((size.rim_diameter - 0.1).abs() < 1e-12, "{size:?}");
        }
        assert_eq!(crater_size(&whole[19..], 0.3, Space::Planar), None);
    }

    #[test]
    fn a_grain_in_the_air_is_no_surface() {
        let mut grains = bowl(Space::Planar, 0.0);
        let mut lies = vec![true; grains.len()];
        let before = crater(&grains, &lies, (40.0 * RADIUS, 0.0));
        let motion = grains.motion(20);
        let up = Vec3::new(motion.position.x, motion.position.y, 0.5);
        grains.set_motion(20, &Motion { position: up, ..motion });
        lies[20] = false;
        let after = crater(&grains, &lies, (40.0 * RADIUS, 0.0));
        assert!(after.iter().all(|at| at.position.z < 0.0));
        assert!(after.len() <= before.len());
    }
}
