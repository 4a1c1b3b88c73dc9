//! What can be said of a bed at rest.

use std::f64::consts::PI;

use crate::boundary::{Base, Container, Period, Sides};
use crate::grain_bed::GrainBed;
use crate::grains::Grains;
use crate::space::Space;

/// How far from walls, floor and surface the inside of a bed begins, in mean grain diameters.
const INSIDE: f64 = 5.0;

/// What a bed at rest looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BedReport {
    /// How many grains.
    pub grains: usize,
    /// Area (volume) of the grains over base times mean surface height (–): the packing fraction as
    /// a text that gives grains, width and height can be read.
    pub packing_fraction: f64,
    /// Packing fraction five grain diameters away from walls, floor and surface (–); none in a bed
    /// too small for that.
    pub packing_fraction_inside: Option<f64>,
    /// Mean height of the surface (m).
    pub height: f64,
    /// Mean diameter of a grain (m).
    pub mean_diameter: f64,
    /// Mean number of contacts of a grain, walls counted (–).
    pub coordination: f64,
}

/// Mean height of the surface of `bed` (m), as [`BedReport::height`].
pub fn surface_height(bed: &GrainBed) -> f64 {
    let grains = &bed.grains;
    let spacing = spacing(grains.space) * grains.mean_diameter();
    Columns::over(grains.space, bed.container(), 0.0, spacing).mean_height(grains)
}

impl BedReport {
    /// Measures `bed`.
    pub fn of(bed: &GrainBed) -> Self {
        let grains = &bed.grains;
        let container = bed.container();
        let mean_diameter = grains.mean_diameter();
        let spacing = spacing(grains.space) * mean_diameter;
        let height = surface_height(bed);
        let margin = INSIDE * mean_diameter;
        let has_room = |length: f64| length - 2.0 * margin > margin;
        let has_sides = container.sides != Sides::Periodic;
        let has_inside =
            has_room(height) && (!has_sides || has_room(container.narrowest(grains.space)));
        let inside = has_inside.then(|| {
            Columns::over(grains.space, container, margin, spacing)
                .covered(grains, (margin, height - margin))
        });
        Self {
            grains: grains.len(),
            packing_fraction: content(grains) / (container.base_area(grains.space) * height),
            packing_fraction_inside: inside,
            height,
            mean_diameter,
            coordination: bed.coordination(),
        }
    }
}

/// Area (m²) or volume (m³) of all grains.
fn content(grains: &Grains) -> f64 {
    let one = |r: f64| match grains.space {
        Space::Planar => PI * r * r,
        Space::Spatial => 4.0 / 3.0 * PI * r * r * r,
    };
    grains.radii().map(one).sum()
}

/// Distance of sampled columns, in mean grain diameters: a plane has room for finer ones.
pub(super) fn spacing(space: Space) -> f64 {
    match space {
        Space::Planar => 0.02,
        Space::Spatial => 0.1,
    }
}

/// Upright lines through a bed, evenly spread over a part of its base.
#[derive(Clone, Copy, Debug)]
struct Columns {
    x: Axis,
    y: Axis,
    /// Middle (m) and radius (m) of the circle that they lie in; none in a rectangle.
    circle: Option<(f64, f64)>,
    period: Period,
}

/// Points `from` + (k + ½) `spacing` (m), k < `n`, which fill `length` (m).
#[derive(Clone, Copy, Debug)]
struct Axis {
    from: f64,
    length: f64,
    spacing: f64,
    n: usize,
}

impl Axis {
    /// The axis that a plane lacks: one point, at 0.
    const NONE: Self = Self { from: -0.5, length: 1.0, spacing: 1.0, n: 1 };

    /// Between `from` and `to` (m), at most `spacing` (m) apart.
    fn new([from, to]: [f64; 2], spacing: f64) -> Self {
        let n = ((to - from) / spacing).ceil() as usize;
        Self { from, length: to - from, spacing: (to - from) / n as f64, n }
    }

    /// The point `k` (m).
    fn at(&self, k: usize) -> f64 {
        self.from + (k as f64 + 0.5) * self.spacing
    }

    /// Calls `chord(k, half length)` for every point that lies within `radius` (m) of `centre` (m).
    fn for_each_chord(&self, centre: f64, radius: f64, mut chord: impl FnMut(usize, f64)) {
        let first = ((centre - radius - self.from) / self.spacing - 0.5).ceil().max(0.0) as usize;
        for k in first..self.n {
            let offset = self.at(k) - centre;
            if offset >= radius {
                break;
            }
            chord(k, (radius * radius - offset * offset).max(0.0).sqrt());
        }
    }
}

impl Columns {
    /// Over the base of `container` but for a `margin` (m) along its walls.
    fn over(space: Space, container: &Container, margin: f64, spacing: f64) -> Self {
        let margin = if container.sides == Sides::Periodic { 0.0 } else { margin };
        let [width, depth] = container.extents();
        let along = |length: f64| Axis::new([margin, length - margin], spacing);
        let (y, circle) = match (space, container.base) {
            (Space::Planar, _) => (Axis::NONE, None),
            (Space::Spatial, Base::Rectangle { .. }) => (along(depth), None),
            (Space::Spatial, Base::Circle { diameter }) => {
                (along(depth), Some((0.5 * diameter, 0.5 * diameter - margin)))
            }
        };
        Self { x: along(width), y, circle, period: container.period(space) }
    }

    /// Whether the column `k` of `row` lies in the circle, if there is one.
    fn counts(&self, k: usize, row: usize) -> bool {
        self.circle.is_none_or(|(middle, radius)| {
            let (x, y) = (self.x.at(k) - middle, self.y.at(row) - middle);
            x * x + y * y <= radius * radius
        })
    }

    /// How many columns there are.
    fn len(&self) -> usize {
        let in_row = |row: usize| (0..self.x.n).filter(|&k| self.counts(k, row)).count();
        match self.circle {
            None => self.x.n * self.y.n,
            Some(_) => (0..self.y.n).map(in_row).sum(),
        }
    }

    /// The area (m²) or length (m) of the base that the columns stand for.
    fn base(&self) -> f64 {
        match self.circle {
            None => self.x.length * self.y.length,
            Some(_) => self.len() as f64 * (self.x.spacing * self.y.spacing),
        }
    }

    /// Mean over all columns of the highest point that grains cover (m).
    fn mean_height(&self, grains: &Grains) -> f64 {
        let mut top = vec![0.0_f64; self.x.n * self.y.n];
        self.for_each_chord(grains, |column, z, half_chord| {
            top[column] = top[column].max(z + half_chord);
        });
        top.iter().sum::<f64>() / self.len() as f64
    }

    /// Share of the columns between two heights (m) that grains cover.
    fn covered(&self, grains: &Grains, (low, high): (f64, f64)) -> f64 {
        let mut length = 0.0;
        self.for_each_chord(grains, |_, z, half_chord| {
            length += ((z + half_chord).min(high) - (z - half_chord).max(low)).max(0.0);
        });
        let volume = length * (self.x.spacing * self.y.spacing);
        volume / (self.base() * (high - low))
    }

    /// Calls `chord(column, height of its middle, half its length)` for every column that cuts a
    /// grain, and every grain it cuts.
    fn for_each_chord(&self, grains: &Grains, mut chord: impl FnMut(usize, f64, f64)) {
        for (position, radius) in grains.positions().zip(grains.radii()) {
            for y in self.images(1, position.y, radius).into_iter().flatten() {
                self.y.for_each_chord(y, radius, |row, radius| {
                    for x in self.images(0, position.x, radius).into_iter().flatten() {
                        self.x.for_each_chord(x, radius, |k, half_chord| {
                            if self.counts(k, row) {
                                chord(row * self.x.n + k, position.z, half_chord);
                            }
                        });
                    }
                });
            }
        }
    }

    /// The coordinate `at` (m) along an axis, and that of the image that reaches in from the other side.
    fn images(&self, axis: usize, at: f64, radius: f64) -> [Option<f64>; 2] {
        let image = self.period.length(axis).and_then(|length| {
            if at < radius {
                Some(at + length)
            } else if at > length - radius {
                Some(at - length)
            } else {
                None
            }
        });
        [Some(at), image]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::Grain;
    use crate::math::Vec3;

    const CUBE: Container = Container::walled_box(1.0, 1.0);

    fn one_grain(space: Space, y: f64) -> Grains {
        let grain = Grain {
            position: Vec3::new(0.5, y, 0.3),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            radius: 0.1,
            mass: 1.0,
            id: 0,
        };
        Grains::new(space, &[grain])
    }

    #[test]
    fn one_disc_covers_its_area_and_its_mean_height() {
        let grains = one_grain(Space::Planar, 0.0);
        let columns = Columns::over(Space::Planar, &CUBE, 0.0, 1e-4);
        let area = PI * 0.01;
        assert!((columns.covered(&grains, (0.0, 1.0)) - area).abs() < 1e-6);
        assert!((columns.covered(&grains, (0.0, 0.3)) - 0.5 * area / 0.3).abs() < 1e-6);
        assert!((columns.mean_height(&grains) - (0.2 * 0.3 + 0.5 * area)).abs() < 1e-5);
    }

    #[test]
    fn one_sphere_covers_its_volume_and_its_mean_height() {
        let grains = one_grain(Space::Spatial, 0.4);
        let columns = Columns::over(Space::Spatial, &CUBE, 0.0, 2e-3);
        let (section, volume) = (PI * 0.01, 4.0 / 3.0 * PI * 1e-3);
        // A hundred columns across: the sum over a disc is good to a few times its rim over 100².
        assert!((columns.covered(&grains, (0.0, 1.0)) - volume).abs() < 2e-3 * volume);
        let height = section * 0.3 + 0.5 * volume;
        assert!((columns.mean_height(&grains) - height).abs() < 2e-3 * height);
    }

    #[test]
    fn a_sphere_across_a_periodic_side_counts_on_both() {
        let container = Container { sides: Sides::Periodic, ..CUBE };
        let columns = Columns::over(Space::Spatial, &container, 0.1, 2e-3);
        let volume = 4.0 / 3.0 * PI * 1e-3;
        let covered = columns.covered(&one_grain(Space::Spatial, 0.03), (0.0, 1.0));
        assert!((covered - volume).abs() < 2e-3 * volume);
    }

    #[test]
    fn the_base_of_a_cylinder_is_a_circle() {
        let container = Container { base: Base::Circle { diameter: 1.0 }, ..CUBE };
        let columns = Columns::over(Space::Spatial, &container, 0.0, 2e-3);
        // Five hundred columns across: the rim cuts one in a hundred, on both sides alike.
        assert!((columns.base() - 0.25 * PI).abs() < 1e-3);
        let height = columns.mean_height(&one_grain(Space::Spatial, 0.5));
        let expected = (PI * 0.01 * 0.3 + 0.5 * 4.0 / 3.0 * PI * 1e-3) / (0.25 * PI);
        assert!((height - expected).abs() < 4e-3 * expected);
    }
}
