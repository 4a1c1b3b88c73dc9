//! Forces on single grains: of the air between them, of plates beside them. Not of contacts.
//!
//! Such a force opposes the motion of a grain, so it has one account, of energy that is lost. It is asked
//! for once per block and step, when the forces of contacts have been gathered.

use crate::grains::Load;
use crate::math::Vec3;

/// A force on every grain by itself.
///
/// Implementations are pure: the grains of a block are taken in their order, and nothing is remembered.
pub trait GrainForce: Send + Sync {
    /// kebab-case; the ledger has a channel `dissipated` of this name.
    fn name(&self) -> &'static str;

    /// Force (N) and torque (N m) on a grain that moves as `motion` says.
    fn on(&self, grain: &Motion) -> Load;
}

/// One grain, as far as a force on it may depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// (m/s).
    pub velocity: Vec3,
    /// (rad/s).
    pub spin: Vec3,
    /// (m).
    pub radius: f64,
    /// (kg).
    pub mass: f64,
    /// Magnitude of gravity (m/s²).
    pub gravity: f64,
}

/// The grains of one block between the two kicks of a step.
pub struct GrainBlock<'a> {
    /// Index of the first.
    pub first: usize,
    /// Force and torque on each; what is added here acts on the grain.
    pub load: &'a mut [Load],
    /// Velocity of the half step of each (m/s).
    pub velocity: &'a [Vec3],
    /// Spin of the half step of each (rad/s).
    pub spin: &'a [Vec3],
    /// Velocity of all grains, extrapolated to the end of the step (m/s).
    pub velocity_now: &'a [Vec3],
    /// Spin of all grains, likewise (rad/s).
    pub spin_now: &'a [Vec3],
    /// Radius of all grains (m).
    pub radius: &'a [f64],
    /// Mass of all grains (kg).
    pub mass: &'a [f64],
}

/// Adds what each of `forces` does to the grains of `block`, and to `lost` what it takes in the step of
/// `dt` (s), in the order of `forces` (J).
///
/// As everything that dissipates, the force is that of the velocity at the end of the step; what it takes
/// is that of the velocity half-way, over the way of the step, which is second order.
pub fn apply(
    forces: &[Box<dyn GrainForce>],
    block: &mut GrainBlock<'_>,
    (gravity, dt): (f64, f64),
    lost: &mut [f64],
) {
    for (force, lost) in forces.iter().zip(lost) {
        for k in 0..block.load.len() {
            let i = block.first + k;
            let motion = |velocity: Vec3, spin: Vec3| Motion {
                velocity,
                spin,
                radius: block.radius[i],
                mass: block.mass[i],
                gravity,
            };
            let half_way = motion(block.velocity[k], block.spin[k]);
            let taken = force.on(&half_way);
            *lost -= (taken.force.dot(&half_way.velocity) + taken.torque.dot(&half_way.spin)) * dt;
            let now = force.on(&motion(block.velocity_now[i], block.spin_now[i]));
            block.load[k].add(&now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −c v, and nothing on the spin.
    struct Drag(f64);

    impl GrainForce for Drag {
        fn name(&self) -> &'static str {
            "drag"
        }

        fn on(&self, grain: &Motion) -> Load {
            Load { force: grain.velocity * -self.0, torque: Vec3::zeros() }
        }
    }

    /// Integrates one free grain of 1 kg from 1 m/s as a step of a bed does, for 1 s in `n` steps; gives
    /// its kinetic energy at the end and what the drag took (J).
    fn braked(n: u32) -> (f64, f64) {
        let dt = 1.0 / f64::from(n);
        let (mut velocity, mut load, mut lost) = (Vec3::x(), Load::ZERO, [0.0]);
        let forces: [Box<dyn GrainForce>; 1] = [Box::new(Drag(0.5))];
        load.add(&forces[0].on(&Motion {
            velocity,
            spin: Vec3::zeros(),
            radius: 1.0,
            mass: 1.0,
            gravity: 0.0,
        }));
        for _ in 0..n {
            let half = velocity + load.force * (0.5 * dt);
            let now = half + load.force * (0.5 * dt);
            let mut loads = [Load::ZERO];
            let mut block = GrainBlock {
                first: 0,
                load: &mut loads,
                velocity: &[half],
                spin: &[Vec3::zeros()],
                velocity_now: &[now],
                spin_now: &[Vec3::zeros()],
                radius: &[1.0],
                mass: &[1.0],
            };
            apply(&forces, &mut block, (0.0, dt), &mut lost);
            load = loads[0];
            velocity = half + load.force * (0.5 * dt);
        }
        (0.5 * velocity.norm_squared(), lost[0])
    }

    #[test]
    fn what_a_force_takes_is_what_the_grain_loses_to_second_order_at_least() {
        let error = |n| {
            let (left, lost) = braked(n);
            (0.5 - left - lost).abs()
        };
        let (coarse, fine) = (error(50), error(100));
        // Half the step, a quarter of the error at most: for a drag that is linear the second order cancels.
        assert!(coarse / fine > 3.9, "{coarse} {fine}");
        let left = braked(100).0;
        // v falls as exp(−t/2); the scheme is of second order, and (dt/2)²/6 is 4e-6.
        assert!((left / (0.5 * libm::exp(-1.0)) - 1.0).abs() < 2e-5, "{left}");
    }
}
