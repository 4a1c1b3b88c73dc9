//! Taps that make a bed denser, and when there have been enough.

use serde::{Deserialize, Serialize};

/// A packing fraction this near below its target is reached.
const NEAR_TARGET: f64 = 0.005;

/// Taps are judged by what so many of them bring together: one alone may bring nothing, and the next
/// one more than the last.
const JUDGED_TAPS: u32 = 4;

/// So many taps that bring less than this in packing fraction, all together, are the last.
const LEAST_GAIN: f64 = 0.001;

/// A bed is tapped this often at most.
const MOST_TAPS: u32 = 50;

/// How far the tapping of a bed has come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Tapping {
    /// How often it was tapped.
    pub(super) taps: u32,
    /// When the last tap was (s).
    pub(super) tapped_at: f64,
    /// Packing fraction when the taps that are judged now began.
    before: f64,
    /// Whether no tap is to follow.
    pub(super) is_over: bool,
}

impl Tapping {
    /// A bed that is not to be tapped.
    pub(super) const NONE: Self = Self { taps: 0, tapped_at: 0.0, before: 0.0, is_over: true };

    /// A bed that is to be tapped where it is too loose.
    pub(super) const WANTED: Self = Self { is_over: false, ..Self::NONE };

    /// What follows a calm bed of packing fraction `fraction` at `time` (s): a tap, or the end of the
    /// tapping.
    pub(super) fn decide(&mut self, (fraction, target): (f64, f64), time: f64) {
        let is_judged = self.taps.is_multiple_of(JUDGED_TAPS);
        let is_tired = self.taps > 0 && is_judged && fraction - self.before < LEAST_GAIN;
        if target - fraction <= NEAR_TARGET || is_tired || self.taps >= MOST_TAPS {
            self.is_over = true;
            return;
        }
        if is_judged {
            self.before = fraction;
        }
        self.taps += 1;
        self.tapped_at = time;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often a bed is tapped that answers its taps with these packing fractions.
    fn taps(fractions: &[f64], target: f64) -> u32 {
        let mut tapping = Tapping::WANTED;
        for &fraction in fractions {
            tapping.decide((fraction, target), 0.0);
            if tapping.is_over {
                break;
            }
        }
        tapping.taps
    }

    #[test]
    fn a_tap_that_brings_nothing_is_not_the_last_if_the_next_ones_help() {
        let late = [0.800, 0.800, 0.800, 0.800, 0.804, 0.804, 0.806, 0.808, 0.810, 0.812];
        assert_eq!(taps(&late, 0.816), 9);
    }

    #[test]
    fn four_taps_that_bring_nothing_are_the_last() {
        assert_eq!(taps(&[0.8; 20], 0.9), 4);
        // Looser, it is not tapped for ever either.
        assert_eq!(taps(&[0.80, 0.79, 0.80, 0.79, 0.79, 0.80], 0.9), 4);
    }

    #[test]
    fn a_bed_within_reach_of_its_target_or_denser_is_left_alone() {
        assert_eq!(taps(&[0.796], 0.8), 0);
        assert_eq!(taps(&[0.9], 0.8), 0);
    }

    #[test]
    fn no_bed_is_tapped_more_than_fifty_times() {
        let slow: Vec<f64> = (0..100).map(|k| 0.5 + 0.001 * f64::from(k)).collect();
        assert_eq!(taps(&slow, 0.9), 50);
    }
}
