//! Tables in which readings of several bodies alternate and nothing says which is of which.

use measurements::median;

use super::track::Sample;

/// Most bodies that are looked for.
const MOST: usize = 4;

/// Least ratio of the roughness of a mixture to that of each of its paths, and least roughness of a mixture as a share of the
/// distance that is travelled.
const ROUGH: f64 = 5.0;
const CLEAR: f64 = 0.01;

/// How many bodies take turns in the rows of `samples`; `None` if they are of one.
pub(super) fn bodies(samples: &[Sample]) -> Option<usize> {
    let [low, high] =
        samples.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], one| {
            [low.min(one.z), high.max(one.z)]
        });
    let together = roughness(samples, 1);
    let is_mixed =
        |turns: &usize| together > (CLEAR * (high - low)).max(ROUGH * roughness(samples, *turns));
    (2..=MOST).find(is_mixed)
}

/// Median distance of a reading from the mean of the readings `apart` rows before and after it.
fn roughness(samples: &[Sample], apart: usize) -> f64 {
    let off = |at: usize| {
        let [before, behind] = [samples[at - apart].z, samples[at + apart].z];
        (samples[at].z - 0.5 * (before + behind)).abs()
    };
    median((apart..samples.len().saturating_sub(apart)).map(off)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fall that a bed stops at `depth`, with a little noise.
    fn path(depth: f64) -> impl Fn(usize) -> f64 {
        move |k| {
            let t = k as f64 / 200.0;
            (5.0 * t * t).min(depth) + 1e-4 * libm::sin(k as f64 * 2.3)
        }
    }

    fn samples(depths: &[f64]) -> Vec<Sample> {
        let at = |row: usize| path(depths[row % depths.len()])(row / depths.len());
        (0..200 * depths.len())
            .map(|row| Sample { line: row as u64, t: row as f64, z: at(row), x: 0.0 })
            .collect()
    }

    #[test]
    fn bodies_that_take_turns_are_counted() {
        assert_eq!(bodies(&samples(&[0.4])), None);
        assert_eq!(bodies(&samples(&[0.4, 0.5])), Some(2));
        assert_eq!(bodies(&samples(&[0.3, 0.5, 0.7])), Some(3));
        // Pixels.
        let mut pixels = samples(&[0.4]);
        pixels.iter_mut().for_each(|one| one.z = (one.z * 100.0).round() / 100.0);
        assert_eq!(bodies(&pixels), None);
    }
}
