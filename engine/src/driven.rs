//! A body on a drive that keeps its velocity, whatever the bed does.

use crate::body::{Mechanism, Part, RigidBody};
use crate::math::Vec3;
use crate::surface::Wrench;

/// A rigid body that moves along a straight line at constant speed, without turning: a plate, penetrometer or
/// cone on an actuator.
///
/// The drive balances the bed and the weight. Its work in a step is minus the mean force over the step times the
/// way made in it, as the work of all forces is booked: the ledger closes to second order in the step.
#[derive(Clone)]
pub struct Driven {
    body: RigidBody,
    /// Bed and weight at the end of the last step (N).
    before: Vec3,
    /// In the last step (J).
    work: f64,
}

impl Driven {
    /// `body` with the velocity that it has; a spin is taken from it.
    pub fn new(mut body: RigidBody) -> Self {
        body.angular_momentum = Vec3::zeros();
        body.hold_on();
        Self { body, before: Vec3::zeros(), work: 0.0 }
    }

    /// What the bed and gravity do to the body (N).
    fn force(&self) -> Vec3 {
        self.body.contact.force + self.body.weight
    }
}

impl Mechanism for Driven {
    fn kick_drift(&mut self, dt: f64) {
        self.before = self.force();
        self.body.glide(dt);
    }

    fn kick(&mut self, dt: f64) {
        let way = self.body.velocity * dt;
        self.work = -0.5 * (self.before + self.force()).dot(&way);
    }

    fn parts(&self) -> &[Part] {
        self.body.parts()
    }

    fn load(&mut self, wrenches: &[Wrench], gravity: Vec3) {
        self.body.load(wrenches, gravity);
    }

    fn bodies(&self) -> &[RigidBody] {
        self.body.bodies()
    }

    fn drive_work(&self) -> Option<f64> {
        Some(self.work)
    }

    fn save(&self) -> Vec<f64> {
        self.body.save()
    }

    fn restore(&mut self, state: &[f64]) -> bool {
        let fits = self.body.restore(state);
        self.body.hold_on();
        fits
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::body::tests::Nothing;
    use crate::math::Quat;

    fn driven() -> Driven {
        let mut body = RigidBody::new("plate", Arc::new(Nothing), 2.0, Vec3::new(1.0, 1.0, 1.0));
        body.launch(Vec3::zeros(), Quat::identity(), Vec3::new(0.0, 0.0, -0.5), Vec3::y());
        Driven::new(body)
    }

    /// Pushed for a second against a force that grows by 8 N per metre of depth; the work of the drive (J).
    fn pushed(driven: &mut Driven) -> f64 {
        let (dt, gravity) = (1.0 / 64.0, Vec3::new(0.0, 0.0, -4.0));
        driven.load(&[Wrench::default()], gravity);
        (0..64).fold(0.0, |work, _| {
            driven.kick_drift(dt);
            let depth = -driven.bodies()[0].position.z;
            let force = Vec3::new(3.0, 0.0, 8.0 * depth);
            driven.load(&[Wrench { force, torque: Vec3::x(), contacts: 1 }], gravity);
            driven.kick(dt);
            work + driven.drive_work().expect("a drive")
        })
    }

    #[test]
    fn neither_force_nor_torque_changes_the_motion_and_the_drive_does_their_work() {
        let mut plate = driven();
        let work = pushed(&mut plate);
        let body = &plate.bodies()[0];
        // Half a metre: powers of two, exact. ½ 8 N/m (½ m)² against the bed, 8 N ½ m from the weight.
        assert_eq!(body.position, Vec3::new(0.0, 0.0, -0.5));
        assert_eq!((body.velocity, body.spin()), (Vec3::new(0.0, 0.0, -0.5), Vec3::zeros()));
        assert_eq!(work.to_bits(), (1.0_f64 - 4.0).to_bits());
        // Contacts with it have the mass of the grain alone.
        assert_eq!(plate.parts()[0].placement.inverse_mass.to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn a_restored_drive_goes_on_to_the_bit() {
        let mut whole = driven();
        pushed(&mut whole);
        let mut resumed = driven();
        assert!(resumed.restore(&whole.save()));
        let [a, b] = [&mut whole, &mut resumed].map(|one| (pushed(one).to_bits(), one.save()));
        assert_eq!(a, b);
        assert!(resumed.parts()[0].placement == whole.parts()[0].placement);
    }
}
