//! Grains at random places, none touching another.

use std::f64::consts::PI;

use rand::RngExt;

use super::random;
use crate::boundary::{Container, Period};
use crate::grains::Grain;
use crate::math::Vec3;
use crate::neighbours::CellAxis;
use crate::space::Space;

/// Grains of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrainKind {
    /// How many.
    pub count: usize,
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
}

/// Share of the area or volume that grains fill when they are placed at random, well below the one
/// at which no further grain finds a place: 0.547 for equal discs, 0.38 for equal spheres.
pub(super) fn fill_fraction(space: Space) -> f64 {
    match space {
        Space::Planar => 0.5,
        Space::Spatial => 0.3,
    }
}

/// Grains of all kinds at random places in `container`, discs or spheres as `space` says, none
/// touching another or a wall; the container is filled as high as it takes.
pub fn fill(kinds: &[GrainKind], (space, container): (Space, &Container), seed: u64) -> Vec<Grain> {
    let mut rng = random(seed, "fill");
    let ([width, depth], period) = (container.extents(), container.period(space));
    let largest = kinds.iter().fold(0.0_f64, |largest, kind| largest.max(kind.radius));
    let height = fill_height(kinds, space, container);
    let mut free = FreeSpace::new(space, container, height, 2.0 * largest);
    let mut grains = Vec::new();
    for kind in large_first(kinds) {
        for _ in 0..kind.count {
            let mut tries = 0;
            let position = loop {
                let mut between = |length: f64| match period.is_none() {
                    true => kind.radius + (length - 2.0 * kind.radius) * rng.random::<f64>(),
                    false => length * rng.random::<f64>(),
                };
                let x = between(width);
                let y = match space {
                    Space::Planar => 0.0,
                    Space::Spatial => between(depth),
                };
                let z = kind.radius + (free.height - kind.radius) * rng.random::<f64>();
                let place = Vec3::new(x, y, z);
                if container.holds(space, (x, y), kind.radius)
                    && free.fits(place, kind.radius, &grains)
                {
                    break place;
                }
                tries += 1;
                if tries % 10_000 == 0 {
                    free.grow();
                }
            };
            free.take(position, grains.len());
            grains.push(Grain {
                position,
                velocity: Vec3::zeros(),
                spin: Vec3::zeros(),
                radius: kind.radius,
                mass: kind.mass,
                id: grains.len() as u32,
            });
        }
    }
    grains
}

/// The kinds in the order in which they are placed: small grains first would leave large ones no place.
pub(super) fn large_first(kinds: &[GrainKind]) -> Vec<GrainKind> {
    let mut kinds = kinds.to_vec();
    kinds.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    kinds
}

/// How high (m) the grains reach when they are placed.
pub(super) fn fill_height(kinds: &[GrainKind], space: Space, container: &Container) -> f64 {
    let content = |kind: &GrainKind| {
        let squares = kind.count as f64 * kind.radius * kind.radius;
        match space {
            Space::Planar => squares,
            Space::Spatial => 4.0 / 3.0 * squares * kind.radius,
        }
    };
    let content: f64 = kinds.iter().map(content).sum();
    PI * content / (fill_fraction(space) * container.base_area(space))
}

/// Which grains have been placed where, in square (cubic) cells as wide as the largest grain.
pub(super) struct FreeSpace {
    height: f64,
    cell: f64,
    x: CellAxis,
    y: CellAxis,
    period: Period,
    cells: Vec<Vec<usize>>,
}

impl FreeSpace {
    /// Of `container`, filled up to `height` (m); no grain is wider than `cell` (m).
    pub(super) fn new(space: Space, container: &Container, height: f64, cell: f64) -> Self {
        let (extents, period) = (container.extents(), container.period(space));
        let axis = |axis: usize| CellAxis::new(0.0, extents[axis], cell, period.length(axis));
        let y = match space {
            Space::Planar => CellAxis::new(0.0, 0.0, cell, None),
            Space::Spatial => axis(1),
        };
        let mut free = Self { height, cell, x: axis(0), y, period, cells: Vec::new() };
        free.make_room();
        free
    }

    fn grow(&mut self) {
        self.height *= 1.1;
        self.make_room();
    }

    fn make_room(&mut self) {
        let n_z = (self.height / self.cell) as usize + 2;
        self.cells.resize(self.x.n * self.y.n * n_z, Vec::new());
    }

    fn fits(&self, place: Vec3, radius: f64, grains: &[Grain]) -> bool {
        self.near(place).all(|other| {
            let Grain { position, radius: other, .. } = &grains[other];
            let near = other + radius;
            self.period.shortest(position - place).norm_squared() > near * near
        })
    }

    /// The grains in the cells around `place`.
    pub(super) fn near(&self, place: Vec3) -> impl Iterator<Item = usize> + '_ {
        let layer = (place.z / self.cell) as usize;
        let n_z = self.cells.len() / (self.x.n * self.y.n);
        let around = |axis: &CellAxis, at: f64| axis.around(axis.cell(at)).into_iter().flatten();
        let columns = move |y: usize| around(&self.x, place.x).map(move |x| y * self.x.n + x);
        let layers = layer.saturating_sub(1)..(layer + 2).min(n_z);
        let bases = layers.flat_map(move |z| {
            let rows = around(&self.y, place.y).map(move |y| z * self.y.n + y);
            rows.flat_map(columns)
        });
        bases.flat_map(|cell| self.cells[cell].iter().copied())
    }

    pub(super) fn take(&mut self, place: Vec3, grain: usize) {
        let (x, y) = (self.x.cell(place.x), self.y.cell(place.y));
        let z = (place.z / self.cell) as usize;
        self.cells[(z * self.y.n + y) * self.x.n + x].push(grain);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [GrainKind; 2] = [
        GrainKind { count: 300, radius: 2.28e-3, mass: 4.9e-5 },
        GrainKind { count: 60, radius: 3.175e-3, mass: 9.7e-5 },
    ];

    #[test]
    fn random_grains_overlap_neither_each_other_nor_a_wall() {
        let container = Container::walled_box(0.1, 0.03);
        for space in [Space::Planar, Space::Spatial] {
            let grains = fill(&KINDS, (space, &container), 7);
            assert_eq!(grains.len(), 360);
            for (i, a) in grains.iter().enumerate() {
                assert!(a.position.x >= a.radius && a.position.x <= 0.1 - a.radius);
                match space {
                    Space::Planar => assert_eq!(a.position.y.to_bits(), 0.0_f64.to_bits()),
                    Space::Spatial => {
                        assert!(a.position.y >= a.radius && a.position.y <= 0.03 - a.radius);
                    }
                }
                assert!(a.position.z >= a.radius);
                for b in &grains[..i] {
                    assert!((a.position - b.position).norm() > a.radius + b.radius);
                }
            }
            assert_eq!(grains, fill(&KINDS, (space, &container), 7));
            assert_ne!(grains, fill(&KINDS, (space, &container), 8));
        }
    }
}
