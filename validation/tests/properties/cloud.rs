//! A cloud of spinning grains of two sizes that falls in on a disc, without gravity and out of reach
//! of walls.

use engine::bed::random;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::stage::ContactStage;
use engine::world::World;
use rand::RngExt;
use validation::rig::{MIDDLE, ROOM, S1, Size, bed, rolling};

/// A collision of two of the small grains lasts 0.12 ms.
pub(crate) const DT: f64 = 4e-6;

/// Of the small grains (m).
pub(crate) const DIAMETER: f64 = 2e-3;

/// The small ones, and ones four times as wide.
const SIZES: [Size; 2] = [Size { radius: 1e-3, mass: 9.4e-6 }, Size { radius: 4e-3, mass: 1.5e-4 }];

const DISC: Size = Size { radius: 1.5e-2, mass: 2e-3 };

/// Grains, and a disc with velocity (m/s) and spin (rad/s).
#[derive(Clone)]
pub(crate) struct Cloud {
    pub(crate) grains: Vec<Grain>,
    pub(crate) disc: (Vec3, Vec3, Vec3),
}

/// Every law there is in these tests: friction and rolling resistance, both with dashpots.
pub(crate) fn laws() -> Vec<Box<dyn ContactStage>> {
    vec![S1.stage(), rolling(0.1, 0.3)]
}

impl Cloud {
    /// `n` grains around the disc, none touching another.
    pub(crate) fn random(n: usize, seed: u64) -> Self {
        let mut rng = random(seed, "cloud");
        let mut number = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
        let mut grains: Vec<Grain> = Vec::new();
        while grains.len() < n {
            let size = SIZES[grains.len() % 2];
            let place = Vec3::new(number(-0.06, 0.06), 0.0, number(-0.06, 0.06));
            let reach = place.norm();
            let position = MIDDLE + place;
            let free = reach < 0.06
                && reach > 1.05 * (DISC.radius + size.radius)
                && grains.iter().all(|other| {
                    (other.position - position).norm() > 1.05 * (other.radius + size.radius)
                });
            let inwards = place * (-number(1.0, 3.0) / reach);
            let astray = Vec3::new(number(-0.5, 0.5), 0.0, number(-0.5, 0.5));
            let spin = Vec3::y() * number(-300.0, 300.0);
            if free {
                grains.push(Grain { spin, ..size.grain(position, inwards + astray) });
            }
        }
        Self { grains, disc: (MIDDLE, Vec3::new(0.3, 0.0, -0.2), Vec3::y() * 30.0) }
    }

    /// The cloud as another observer describes it.
    pub(crate) fn seen(
        &self,
        grain: impl Fn(Grain) -> Grain,
        vectors: impl Fn(Vec3, Vec3, Vec3) -> (Vec3, Vec3, Vec3),
    ) -> Self {
        let (position, velocity, spin) = self.disc;
        Self {
            grains: self.grains.iter().map(|&one| grain(one)).collect(),
            disc: vectors(position, velocity, spin),
        }
    }

    pub(crate) fn world(&self) -> World {
        let bed = bed((Space::Planar, ROOM), Vec3::zeros(), &self.grains, laws(), 1);
        let (position, velocity, spin) = self.disc;
        World::new(bed, Box::new(DISC.disc(position, velocity, spin)), DT)
    }
}

/// Positions (m) of the grains in the order of their numbers, then that of the disc.
pub(crate) fn positions(world: &World) -> Vec<Vec3> {
    let mut grains: Vec<(u32, Vec3)> =
        world.bed().grains.iter().map(|grain| (grain.id, grain.position)).collect();
    grains.sort_by_key(|&(id, _)| id);
    let bodies = world.intruder().bodies().iter().map(|body| body.position);
    grains.into_iter().map(|(_, position)| position).chain(bodies).collect()
}

/// Largest distance (m) of two lists of positions.
pub(crate) fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |worst, (a, b)| worst.max((a - b).norm()))
}

/// Counts how often grains begin to touch.
#[derive(Default)]
pub(crate) struct Collisions {
    touching: Vec<[usize; 2]>,
    pub(crate) count: usize,
}

impl Collisions {
    pub(crate) fn watch(&mut self, world: &World) {
        let now = world.bed().touching_pairs();
        self.count += now.iter().filter(|pair| self.touching.binary_search(pair).is_err()).count();
        self.touching = now;
    }
}
