//! What happens to each body of an intruder during an impact.

use serde::{Deserialize, Serialize};

use crate::body::{Mechanism, RigidBody};
use crate::math::Vec3;
use crate::stopping::Stopping;

/// The course of one body of an intruder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Course {
    stopping: Stopping,
    contact: Option<f64>,
    given: f64,
    /// Kinetic and potential, at the start (J).
    energy: [f64; 2],
    before: Moment,
}

/// A body and its load between two steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Moment {
    position: Vec3,
    spin: Vec3,
    force: Vec3,
    torque: Vec3,
}

impl Moment {
    fn of(body: &RigidBody) -> Self {
        let (force, torque) = (body.contact.force, body.contact.torque);
        Self { position: body.position, spin: body.spin(), force, torque }
    }

    /// What the body gives to the bed until `next`, `dt` (s) later: less the mean force times the way
    /// and less the mean torque times the turn (J).
    fn given(&self, next: &Self, dt: f64) -> f64 {
        let way = next.position - self.position;
        let turn = (self.spin + next.spin) * (0.5 * dt);
        -0.5 * ((self.force + next.force).dot(&way) + (self.torque + next.torque).dot(&turn))
    }
}

/// Kinetic and potential energy of a body (J).
fn energy(body: &RigidBody) -> [f64; 2] {
    let [translation, rotation] = body.kinetic_energy();
    [translation + rotation, -body.weight.dot(&body.position)]
}

impl Course {
    /// Body `index` of `intruder` at the start.
    pub(crate) fn new(intruder: &dyn Mechanism, index: usize) -> Self {
        let (body, followed) = (&intruder.bodies()[index], intruder.followed(index));
        let (stopping, contact) = match intruder.stops_with_its_tips() {
            true => (Stopping::of_tip(0.0, followed), None),
            false => (Stopping::new(followed), Some(0.0)),
        };
        Self { stopping, contact, given: 0.0, energy: energy(body), before: Moment::of(body) }
    }

    /// Takes note of it at `time` (s), a step of `dt` (s) later.
    pub(crate) fn observe(
        &mut self,
        (time, dt): (f64, f64),
        intruder: &dyn Mechanism,
        index: usize,
    ) {
        let (body, followed) = (&intruder.bodies()[index], intruder.followed(index));
        let now = Moment::of(body);
        self.given += self.before.given(&now, dt);
        self.before = now;
        if self.contact.is_some() {
            self.stopping.observe(time, followed);
            return;
        }
        self.stopping = Stopping::of_tip(time, followed);
        self.contact = (body.contact.contacts > 0).then_some(time);
    }

    /// Stopping times, which count from the start, and the depth.
    pub fn stopping(&self) -> &Stopping {
        &self.stopping
    }

    /// When it first touched the bed (s); of an intruder of one body, the start.
    pub fn contact(&self) -> Option<f64> {
        self.contact
    }

    /// Whether it has touched, has stopped, and keeps still.
    pub fn is_over(&self) -> bool {
        self.contact.is_some() && self.stopping.is_over()
    }

    /// Energy that it has given to the bed by the force on it (J).
    pub fn given(&self) -> f64 {
        self.given
    }

    /// Kinetic and potential energy that it has lost since the start, as `body` is now (J).
    pub fn lost(&self, body: &RigidBody) -> [f64; 2] {
        let [kinetic, potential] = energy(body);
        [self.energy[0] - kinetic, self.energy[1] - potential]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_force_along_a_way_and_a_couple_through_a_turn_are_given_in_full() {
        let before = Moment {
            position: Vec3::zeros(),
            spin: Vec3::y() * 2.0,
            force: Vec3::z() * 3.0,
            torque: -Vec3::y(),
        };
        let after = Moment { position: Vec3::z() * -0.5, ..before };
        // 3 N against 0.5 m and 1 N m against 2 rad/s for 0.25 s: powers of two, exact.
        assert_eq!(before.given(&after, 0.25).to_bits(), 2.0_f64.to_bits());
    }
}
