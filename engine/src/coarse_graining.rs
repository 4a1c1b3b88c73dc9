//! Continuous fields of a bed by coarse graining: packing fraction, velocity and how much grains
//! differ from it, in the vertical plane of the impact.
//!
//! Every grain is spread over a kernel W of width c (m), and mass and momentum are added up:
//!
//! ν(r) = Σ V_i W(r − r_i),  v(r) = Σ m_i v_i W / Σ m_i W,  T(r) = Σ m_i |v_i − v|² W / (D Σ m_i W)
//!
//! in D dimensions. The velocity is that of the momentum, so that mass is conserved exactly (Goldhirsch,
//! Granul. Matter 12, 239 (2010)). W is Lucy's polynomial, which ends at c: what lies farther away
//! changes nothing.

use std::f64::consts::PI;
use std::ops::Range;

use crate::grains::Grains;
use crate::math::Vec3;
use crate::space::Space;

/// A grid of points in the plane y = const.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// (m); 0 in a planar bed.
    pub y: f64,
    /// Horizontal extent (m).
    pub x: Range<f64>,
    /// Vertical extent (m).
    pub z: Range<f64>,
    /// Distance of the points (m).
    pub spacing: f64,
    /// c, where the kernel ends (m).
    pub kernel_width: f64,
}

/// The fields at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldPoint {
    /// (m).
    pub position: Vec3,
    /// ν (–).
    pub packing_fraction: f64,
    /// v (m/s).
    pub velocity: Vec3,
    /// T, the granular temperature (m²/s²).
    pub temperature: f64,
}

/// What a point has gathered so far.
#[derive(Clone, Copy, Default)]
struct Gathered {
    volume: f64,
    mass: f64,
    momentum: Vec3,
    /// Σ m v² W.
    square: f64,
}

/// The fields of `grains` at the points of `plane` that any grain reaches, row by row from below.
///
/// # Panics
/// If spacing or kernel width is not above zero.
pub fn fields(grains: &Grains, plane: &Plane) -> Vec<FieldPoint> {
    let Plane { spacing, kernel_width: c, .. } = *plane;
    assert!(spacing > 0.0 && c > 0.0, "a grid has a spacing and a kernel a width");
    let n_points = |range: &Range<f64>| ((range.end - range.start) / spacing) as usize + 1;
    let (n_x, n_z) = (n_points(&plane.x), n_points(&plane.z));
    let mut gathered = vec![Gathered::default(); n_x * n_z];
    for i in 0..grains.len() {
        let position = grains.position(i);
        let off_plane = position.y - plane.y;
        if off_plane.abs() >= c {
            continue;
        }
        let reach = (c * c - off_plane * off_plane).sqrt();
        let (mass, velocity) = (grains.mass[i], grains.velocity(i));
        let volume = grains.space.grain_content(2.0 * grains.radius(i));
        for row in near(position.z - plane.z.start, reach, spacing, n_z) {
            for column in near(position.x - plane.x.start, reach, spacing, n_x) {
                let weight =
                    kernel((plane.point(column, row) - position).norm() / c, c, grains.space);
                let at = &mut gathered[row * n_x + column];
                at.volume += volume * weight;
                at.mass += mass * weight;
                at.momentum += velocity * (mass * weight);
                at.square += mass * weight * velocity.norm_squared();
            }
        }
    }
    let dimensions = match grains.space {
        Space::Planar => 2.0,
        Space::Spatial => 3.0,
    };
    let points = (0..n_z).flat_map(|row| (0..n_x).map(move |column| (column, row)));
    points
        .zip(gathered)
        .filter(|(_, at)| at.mass > 0.0)
        .map(|((column, row), at)| {
            let velocity = at.momentum / at.mass;
            // Rounding may leave a little less than nothing where all grains move alike.
            let fluctuation = (at.square / at.mass - velocity.norm_squared()).max(0.0);
            FieldPoint {
                position: plane.point(column, row),
                packing_fraction: at.volume,
                velocity,
                temperature: fluctuation / dimensions,
            }
        })
        .collect()
}

impl Plane {
    fn point(&self, column: usize, row: usize) -> Vec3 {
        let along = |range: &Range<f64>, k: usize| range.start + k as f64 * self.spacing;
        Vec3::new(along(&self.x, column), self.y, along(&self.z, row))
    }
}

/// The points of a line, `spacing` apart from 0 and `n` in number, nearer to `at` than `reach`.
fn near(at: f64, reach: f64, spacing: f64, n: usize) -> Range<usize> {
    // A cast of a negative number is 0.
    let first = ((at - reach) / spacing).ceil() as usize;
    let end = (((at + reach) / spacing).floor() + 1.0) as usize;
    first.min(n)..end.min(n)
}

/// Lucy's kernel at the distance q c (1/m² in the plane, 1/m³ in space).
fn kernel(q: f64, c: f64, space: Space) -> f64 {
    if q >= 1.0 {
        return 0.0;
    }
    let norm = match space {
        Space::Planar => 5.0 / (PI * c * c),
        Space::Spatial => 105.0 / (16.0 * PI * c * c * c),
    };
    let left = 1.0 - q;
    norm * (1.0 + 3.0 * q) * left * left * left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::Grain;

    const RADIUS: f64 = 1e-3;

    /// A cubic (square) lattice of touching grains, `n` a side, each moving as `velocity` says.
    fn lattice(space: Space, n: usize, velocity: impl Fn(Vec3) -> Vec3) -> Grains {
        let deep = if space == Space::Planar { 1 } else { n };
        let places = (0..n).flat_map(move |i| (0..deep).map(move |j| (i, j)));
        let grains: Vec<Grain> = places
            .flat_map(|(i, j)| (0..n).map(move |k| [i, j, k].map(|k| 2.0 * RADIUS * k as f64)))
            .map(|[x, y, z]| Grain {
                position: Vec3::new(x, y, z),
                velocity: velocity(Vec3::new(x, y, z)),
                spin: Vec3::zeros(),
                radius: RADIUS,
                mass: 1e-5,
                id: 0,
            })
            .collect();
        Grains::new(space, &grains)
    }

    /// The plane through the middle of a lattice of `n`, all points `margin` from its sides.
    fn inside(space: Space, n: usize, spacing: f64) -> Plane {
        let width = 2.0 * RADIUS * (n - 1) as f64;
        let range = 8.0 * RADIUS..width - 8.0 * RADIUS;
        Plane {
            y: if space == Space::Planar { 0.0 } else { 0.5 * width },
            x: range.clone(),
            z: range,
            spacing,
            kernel_width: 6.0 * RADIUS,
        }
    }

    #[test]
    fn the_kernel_spreads_a_grain_without_losing_any_of_it() {
        for (space, shell) in [(Space::Planar, 2.0), (Space::Spatial, 4.0)] {
            let n = 10_000;
            let c = 0.7;
            let sum: f64 = (0..n)
                .map(|k| {
                    let q = (f64::from(k) + 0.5) / f64::from(n);
                    let r = q * c;
                    let around = if space == Space::Planar { r } else { r * r };
                    shell * PI * around * kernel(q, c, space) * c / f64::from(n)
                })
                .sum();
            // Midpoint rule: second order in 1e-4.
            assert!((sum - 1.0).abs() < 1e-7, "{sum}");
        }
    }

    #[test]
    fn a_lattice_has_its_own_packing_fraction() {
        for (space, exact) in [(Space::Planar, PI / 4.0), (Space::Spatial, PI / 6.0)] {
            let grains = lattice(space, 16, |_| Vec3::zeros());
            // Three points to a grain: on average over the cell of the lattice the ripples of the
            // kernel vanish.
            let points = fields(&grains, &inside(space, 16, 2.0 * RADIUS / 3.0));
            let mean =
                points.iter().map(|at| at.packing_fraction).sum::<f64>() / points.len() as f64;
            // The kernel is three grains wide; what is left of the lattice is below 1 %.
            assert!((mean / exact - 1.0).abs() < 0.01, "{mean} against {exact}");
        }
    }

    #[test]
    fn a_shear_flow_is_read_back_and_has_the_temperature_of_its_kernel() {
        let rate = 7.0;
        for space in [Space::Planar, Space::Spatial] {
            let grains = lattice(space, 16, |at| Vec3::new(rate * at.z, 0.0, 0.0));
            let points = fields(&grains, &inside(space, 16, 2.0 * RADIUS));
            assert!(points.len() > 40);
            for at in points {
                // Points of the lattice see it symmetrically: a linear flow comes back exactly.
                let exact = Vec3::new(rate * at.position.z, 0.0, 0.0);
                assert!((at.velocity - exact).norm() < 1e-12 * rate, "{at:?}");
                // Grains within the kernel differ by what the shear makes of its width.
                assert!(at.temperature > 0.0 && at.temperature.sqrt() < rate * 6.0 * RADIUS);
            }
        }
    }

    #[test]
    fn where_no_grain_reaches_there_is_no_field() {
        let grains = lattice(Space::Planar, 2, |_| Vec3::zeros());
        let plane =
            Plane { y: 0.0, x: 1.0..1.1, z: 0.0..0.1, spacing: 0.01, kernel_width: 6.0 * RADIUS };
        assert!(fields(&grains, &plane).is_empty());
    }
}
