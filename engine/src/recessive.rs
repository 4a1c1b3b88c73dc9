//! The work of surfaces that grains feel and bodies do not.
//!
//! A body that carries a recessive wall moves as if it had none, so that wall is moved by nothing that the
//! ledger knows: what it does to the grains is energy put in.

use serde::{Deserialize, Serialize};

use crate::body::Part;
use crate::math::Vec3;
use crate::surface::Wrench;

/// Follows what such surfaces do to the grains; the mean force over a step times the way made in it is
/// second order in the step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct RecessiveWork {
    /// Per part of the intruder: force (N) and torque (N m) on the grains at the end of the last step.
    before: Vec<(Vec3, Vec3)>,
    /// Done in the last step (J).
    work: f64,
}

impl RecessiveWork {
    pub(crate) fn new(n_parts: usize) -> Self {
        Self { before: vec![(Vec3::zeros(), Vec3::zeros()); n_parts], work: 0.0 }
    }

    pub(crate) fn n_parts(&self) -> usize {
        self.before.len()
    }

    /// Done in the last step (J).
    pub(crate) fn work(&self) -> f64 {
        self.work
    }

    /// Books a step of `dt` (s), in which `parts` moved; `unfelt` is what grains do to them at its end.
    pub(crate) fn book(&mut self, parts: &[Part], unfelt: &[Wrench], dt: f64) {
        self.work = 0.0;
        for ((part, unfelt), before) in parts.iter().zip(unfelt).zip(&mut self.before) {
            let (force, torque) = (-unfelt.force, -unfelt.torque);
            let (way, turn) = (part.placement.velocity * dt, part.placement.spin * dt);
            self.work += 0.5 * ((before.0 + force).dot(&way) + (before.1 + torque).dot(&turn));
            *before = (force, torque);
        }
    }
}
