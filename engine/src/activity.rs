//! How much of a bed takes part in an impact, and for how long.

use serde::{Deserialize, Serialize};

/// The bed counts as calm again when its kinetic energy stays below this share of its greatest.
const CALM_SHARE: f64 = 0.01;

/// Follows the motion of a bed through one impact.
///
/// The three-shape manuscript relates the two numbers that come of it to the energy which the bed was given:
/// T γ = ζ ln E + c (eq. 24). It defines neither exactly; here γ is the largest share of the grains that
/// move at one time ([`GrainBed::moving_share`](crate::grain_bed::GrainBed::moving_share)), and T the time
/// from which on the kinetic energy of the grains stays below 1 % of its greatest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Activity {
    largest_share: f64,
    /// (J).
    largest_energy: f64,
    /// When the largest energy was reached (s).
    peak_time: f64,
    /// When the energy last came below the calm share, if it is below now (s).
    calm_since: Option<f64>,
}

impl Activity {
    /// Takes note of the state at `time` (s): the share of the grains that move, and the kinetic energy
    /// of all (J).
    pub fn observe(&mut self, time: f64, moving_share: f64, kinetic_energy: f64) {
        self.largest_share = self.largest_share.max(moving_share);
        if kinetic_energy > self.largest_energy {
            self.largest_energy = kinetic_energy;
            self.peak_time = time;
        }
        if kinetic_energy > CALM_SHARE * self.largest_energy {
            self.calm_since = None;
        } else if self.calm_since.is_none() && self.largest_energy > 0.0 {
            self.calm_since = Some(time);
        }
    }

    /// γ, the largest share of the grains that moved at one time (–).
    pub fn largest_share(&self) -> f64 {
        self.largest_share
    }

    /// The greatest kinetic energy of the grains (J).
    pub fn largest_energy(&self) -> f64 {
        self.largest_energy
    }

    /// When the grains had it (s).
    pub fn peak_time(&self) -> f64 {
        self.peak_time
    }

    /// T, since when the bed has been calm (s); none while it is not.
    pub fn dissipation_time(&self) -> Option<f64> {
        self.calm_since
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bed_is_calm_after_the_last_time_that_it_moved() {
        let mut activity = Activity::default();
        let energies = [0.0, 1.0, 4.0, 0.03, 0.2, 0.05, 0.03, 0.02];
        for (step, energy) in (0..).zip(energies) {
            activity.observe(f64::from(step), 0.1 * energy, energy);
        }
        // 1 % of 4 J; the second wave of 0.2 J counts, and 0.05 J is still above.
        assert_eq!(activity.dissipation_time(), Some(6.0));
        assert_eq!(activity.peak_time().to_bits(), 2.0_f64.to_bits());
        assert_eq!(activity.largest_share().to_bits(), 0.4_f64.to_bits());
    }

    #[test]
    fn a_bed_that_still_moves_has_no_dissipation_time() {
        let mut activity = Activity::default();
        activity.observe(0.0, 0.5, 1.0);
        activity.observe(1.0, 0.5, 0.5);
        assert_eq!(activity.dissipation_time(), None);
    }
}
