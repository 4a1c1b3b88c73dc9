//! Two bodies on a collision course.

use engine::body::NoIntruder;
use engine::grains::{Grain, Space};
use engine::math::Vec3;
use engine::stage::ContactStage;
use engine::world::World;

use crate::rig::{MIDDLE, ROOM, Size, bed, run};

/// What a grain meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Another grain.
    Grain(Size),
    /// A disc as an intruder.
    Intruder(Size),
}

impl Target {
    /// Its size and mass.
    #[must_use]
    pub fn size(self) -> Size {
        match self {
            Self::Grain(size) | Self::Intruder(size) => size,
        }
    }
}

/// A grain that comes from the left, and what it meets, seen from their common centre of mass.
pub struct Encounter {
    /// The two, without gravity and far from walls.
    pub world: World,
    reach: f64,
}

impl Encounter {
    /// `gap` (m) apart along x, the grain with `velocity` (m/s) relative to the target and with
    /// `spin` (rad/s).
    pub fn new(
        (grain, target): (Size, Target),
        gap: f64,
        (velocity, spin): (Vec3, Vec3),
        stages: Vec<Box<dyn ContactStage>>,
        dt: f64,
    ) -> Self {
        let other = target.size();
        let reach = grain.radius + other.radius;
        let share = 1.0 / (grain.mass + other.mass);
        let position = MIDDLE - Vec3::x() * (reach + gap);
        let grain = Grain { spin, ..grain.grain(position, velocity * (other.mass * share)) };
        let recoil = velocity * (-grain.mass * share);
        let place = (Space::Planar, ROOM);
        let world = match target {
            Target::Grain(size) => {
                let grains = [grain, size.grain(MIDDLE, recoil)];
                let bed = bed(place, Vec3::zeros(), &grains, stages, 0);
                World::new(bed, Box::new(NoIntruder), dt)
            }
            Target::Intruder(size) => {
                let bed = bed(place, Vec3::zeros(), &[grain], stages, 1);
                World::new(bed, Box::new(size.disc(MIDDLE, recoil, Vec3::zeros())), dt)
            }
        };
        Self { world, reach }
    }

    /// Position (m) and velocity (m/s) of the grain relative to the target.
    pub fn relative(&self) -> (Vec3, Vec3) {
        let grains = self.world.bed().grains.iter();
        let mut states: Vec<(u32, Vec3, Vec3)> =
            grains.map(|grain| (grain.id, grain.position, grain.velocity)).collect();
        states.sort_by_key(|&(id, ..)| id);
        let bodies = self.world.intruder().bodies().iter();
        let target = bodies.map(|body| (body.position, body.velocity)).next();
        let (position, velocity) = target.unwrap_or_else(|| (states[1].1, states[1].2));
        (states[0].1 - position, states[0].2 - velocity)
    }

    /// Overlap (m); negative apart.
    pub fn overlap(&self) -> f64 {
        self.reach - self.relative().0.norm()
    }

    /// Steps until the two have met and parted; returns for how many steps they touched.
    ///
    /// # Panics
    /// If they do not within a million steps.
    pub fn until_parted(&mut self) -> usize {
        let mut touched = 0;
        for _ in 0..1_000_000 {
            run(&mut self.world, 1);
            if self.overlap() > 0.0 {
                touched += 1;
            } else if touched > 0 {
                // Once more: what an opened contact still held is booked by now, and nothing moves.
                run(&mut self.world, 1);
                return touched;
            }
        }
        panic!("the two have met and parted within a million steps");
    }
}
