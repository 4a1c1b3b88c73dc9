//! How a bed is made: grains at random without overlap, settled under gravity until at rest; and
//! what can be said of a bed that is.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use crate::body::NoIntruder;
use crate::boundary::Container;
use crate::clock::Clock;
use crate::contact::ContactStage;
use crate::error::StepError;
use crate::grain_bed::{GrainBed, RestingBed};
use crate::grains::{Grain, Grains, Space};
use crate::math::Vec3;
use crate::world::{SavedWorld, World};

/// Share of the area that grains fill when they are placed at random.
const FILL_FRACTION: f64 = 0.5;

/// A bed is at rest when the mean kinetic energy of a grain stays below this many m g d …
const REST_ENERGY: f64 = 1e-6;

/// … for this long (s).
const REST_HOLD: f64 = 0.02;

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

/// A generator of random numbers for one purpose: the same for the same seed and name, whatever
/// else a run draws.
#[must_use]
pub fn random(seed: u64, purpose: &str) -> Pcg64 {
    let hash =
        blake3::Hasher::new().update(&seed.to_le_bytes()).update(purpose.as_bytes()).finalize();
    Pcg64::from_seed(*hash.as_bytes())
}

/// Discs of all kinds at random places in a planar container, none touching another or a wall; the
/// container is filled as high as it takes.
#[must_use]
pub fn fill(kinds: &[GrainKind], container: &Container, seed: u64) -> Vec<Grain> {
    let mut rng = random(seed, "fill");
    let area: f64 = kinds.iter().map(|kind| kind.count as f64 * kind.radius * kind.radius).sum();
    let height = std::f64::consts::PI * area / (FILL_FRACTION * container.width);
    let largest = kinds.iter().fold(0.0_f64, |largest, kind| largest.max(kind.radius));
    let mut free = FreeSpace::new(container.width, height, 2.0 * largest);
    // Large grains first: later they would find no place.
    let mut kinds = kinds.to_vec();
    kinds.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    let mut grains = Vec::new();
    for kind in kinds {
        for _ in 0..kind.count {
            let mut tries = 0;
            let position = loop {
                let x = kind.radius + (container.width - 2.0 * kind.radius) * rng.random::<f64>();
                let z = kind.radius + (free.height - kind.radius) * rng.random::<f64>();
                if free.fits(x, z, kind.radius, &grains) {
                    break Vec3::new(x, 0.0, z);
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

/// Which grains have been placed where, in square cells as wide as the largest grain.
struct FreeSpace {
    height: f64,
    cell: f64,
    n_x: usize,
    cells: Vec<Vec<usize>>,
}

impl FreeSpace {
    fn new(width: f64, height: f64, cell: f64) -> Self {
        let n_x = (width / cell) as usize + 1;
        let n_z = (height / cell) as usize + 2;
        Self { height, cell, n_x, cells: vec![Vec::new(); n_x * n_z] }
    }

    fn grow(&mut self) {
        self.height *= 1.1;
        let n_z = (self.height / self.cell) as usize + 2;
        self.cells.resize(self.n_x * n_z, Vec::new());
    }

    fn fits(&self, x: f64, z: f64, radius: f64, grains: &[Grain]) -> bool {
        let (column, row) = ((x / self.cell) as usize, (z / self.cell) as usize);
        let n_z = self.cells.len() / self.n_x;
        (row.saturating_sub(1)..=(row + 1).min(n_z - 1)).all(|row| {
            (column.saturating_sub(1)..=(column + 1).min(self.n_x - 1)).all(|column| {
                self.cells[row * self.n_x + column].iter().all(|&other| {
                    let Grain { position, radius: other, .. } = &grains[other];
                    let (dx, dz, near) = (position.x - x, position.z - z, other + radius);
                    dx * dx + dz * dz > near * near
                })
            })
        })
    }

    fn take(&mut self, position: Vec3, grain: usize) {
        let (column, row) = ((position.x / self.cell) as usize, (position.z / self.cell) as usize);
        self.cells[row * self.n_x + column].push(grain);
    }
}

/// A bed on its way to rest.
pub struct Settling {
    world: World,
    quiet_since: Option<f64>,
    quiet_energy: f64,
}

impl Settling {
    /// Lets `grains` fall under the laws `stages`; `dt` (s) is the step.
    ///
    /// # Panics
    /// If there are no grains.
    #[must_use]
    pub fn new(
        grains: &[Grain],
        container: Container,
        gravity: Vec3,
        stages: Vec<Box<dyn ContactStage>>,
        dt: f64,
    ) -> Self {
        let start = RestingBed::without_history(Space::Planar, grains);
        let bed = GrainBed::new(&start, container, gravity, stages, 0);
        let n = grains.len() as f64;
        let mean_mass = grains.iter().map(|grain| grain.mass).sum::<f64>() / n;
        let mean_diameter = 2.0 * grains.iter().map(|grain| grain.radius).sum::<f64>() / n;
        let quiet_energy = REST_ENERGY * mean_mass * gravity.norm() * mean_diameter;
        let world = World::new(bed, Box::new(NoIntruder), dt);
        Self { world, quiet_since: None, quiet_energy }
    }

    /// Moves on by one step.
    ///
    /// # Errors
    /// If the step cannot be trusted.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.world.advance()?;
        if self.restlessness() >= 1.0 {
            self.quiet_since = None;
        } else if self.quiet_since.is_none() {
            self.quiet_since = Some(self.clock().time());
        }
        Ok(())
    }

    /// Whether the bed has kept quiet for long enough.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.quiet_since.is_some_and(|since| self.clock().time() - since >= REST_HOLD)
    }

    /// Mean kinetic energy of a grain over the one that counts as rest.
    #[must_use]
    pub fn restlessness(&self) -> f64 {
        self.bed().mean_kinetic_energy() / self.quiet_energy
    }

    /// Simulated time and steps.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.world.clock()
    }

    /// Everything that changes while it settles.
    #[must_use]
    pub fn save(&self) -> SavedSettling {
        SavedSettling { world: self.world.save(), quiet_since: self.quiet_since }
    }

    /// Takes back a saved state of the same preparation; `false`, and an unusable one, if it is of
    /// another.
    #[must_use]
    pub fn restore(&mut self, saved: SavedSettling) -> bool {
        self.quiet_since = saved.quiet_since;
        self.world.restore(saved.world)
    }

    /// The bed as it stands.
    #[must_use]
    pub fn bed(&self) -> &GrainBed {
        self.world.bed()
    }
}

/// The state of a settling bed between two steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSettling {
    world: SavedWorld,
    quiet_since: Option<f64>,
}

/// What a planar bed at rest looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BedReport {
    /// How many grains.
    pub grains: usize,
    /// Area of the grains over width times mean surface height (–): the packing fraction as a text
    /// that gives grains, width and height can be read.
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

impl BedReport {
    /// Measures `bed`.
    #[must_use]
    pub fn of(bed: &GrainBed) -> Self {
        let grains = &bed.grains;
        let width = bed.container().width;
        let mean_diameter = 2.0 * grains.radius.iter().sum::<f64>() / grains.len() as f64;
        let area: f64 = grains.radius.iter().map(|r| std::f64::consts::PI * r * r).sum();
        let height = mean_surface_height(grains, width, 0.02 * mean_diameter);
        let margin = 5.0 * mean_diameter;
        let inside = [margin, width - margin, margin, height - margin];
        Self {
            grains: grains.len(),
            packing_fraction: area / (width * height),
            packing_fraction_inside: (inside[1] - inside[0] > margin
                && inside[3] - inside[2] > margin)
                .then(|| covered(grains, inside, 0.02 * mean_diameter)),
            height,
            mean_diameter,
            coordination: bed.coordination(),
        }
    }
}

/// Mean over x of the highest point that grains cover (m), sampled every `spacing` (m).
fn mean_surface_height(grains: &Grains, width: f64, spacing: f64) -> f64 {
    let n = (width / spacing).ceil() as usize;
    let spacing = width / n as f64;
    let mut top = vec![0.0_f64; n];
    for (position, radius) in grains.position.iter().zip(&grains.radius) {
        for_each_chord(position.x, *radius, 0.0, spacing, n, |k, half_chord| {
            top[k] = top[k].max(position.z + half_chord);
        });
    }
    top.iter().sum::<f64>() / n as f64
}

/// Share of the rectangle [x0, x1, z0, z1] (m) that grains cover, by chords every `spacing` (m).
fn covered(grains: &Grains, [x0, x1, z0, z1]: [f64; 4], spacing: f64) -> f64 {
    let n = ((x1 - x0) / spacing).ceil() as usize;
    let spacing = (x1 - x0) / n as f64;
    let mut length = 0.0;
    for (position, radius) in grains.position.iter().zip(&grains.radius) {
        for_each_chord(position.x, *radius, x0, spacing, n, |_, half_chord| {
            let (low, high) = (position.z - half_chord, position.z + half_chord);
            length += (high.min(z1) - low.max(z0)).max(0.0);
        });
    }
    length * spacing / ((x1 - x0) * (z1 - z0))
}

/// Calls `chord(k, half length)` for each line x = `from` + (k + ½) `spacing`, k < `n`, that cuts a
/// disc at `x`.
fn for_each_chord(
    x: f64,
    radius: f64,
    from: f64,
    spacing: f64,
    n: usize,
    mut chord: impl FnMut(usize, f64),
) {
    let first = ((x - radius - from) / spacing - 0.5).ceil().max(0.0) as usize;
    for k in first..n {
        let offset = from + (k as f64 + 0.5) * spacing - x;
        if offset >= radius {
            break;
        }
        chord(k, (radius * radius - offset * offset).max(0.0).sqrt());
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
        let container = Container { width: 0.1, depth: 0.0 };
        let grains = fill(&KINDS, &container, 7);
        assert_eq!(grains.len(), 360);
        for (i, a) in grains.iter().enumerate() {
            assert!(a.position.x >= a.radius && a.position.x <= 0.1 - a.radius);
            assert!(a.position.z >= a.radius);
            for b in &grains[..i] {
                assert!((a.position - b.position).norm() > a.radius + b.radius);
            }
        }
        assert_eq!(grains, fill(&KINDS, &container, 7));
        assert_ne!(grains, fill(&KINDS, &container, 8));
    }

    #[test]
    fn one_disc_covers_its_area_and_its_mean_height() {
        let grain = Grain {
            position: Vec3::new(0.5, 0.0, 0.3),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            radius: 0.1,
            mass: 1.0,
            id: 0,
        };
        let grains = Grains::new(Space::Planar, &[grain]);
        let area = std::f64::consts::PI * 0.01;
        assert!((covered(&grains, [0.0, 1.0, 0.0, 1.0], 1e-4) - area).abs() < 1e-6);
        assert!((covered(&grains, [0.0, 1.0, 0.0, 0.3], 1e-4) - 0.5 * area / 0.3).abs() < 1e-6);
        let height = mean_surface_height(&grains, 1.0, 1e-4);
        assert!((height - (0.2 * 0.3 + 0.5 * area)).abs() < 1e-5);
    }
}
