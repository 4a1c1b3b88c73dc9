//! Clocks that were written with few digits.

use super::track::Sample;

/// Share of a step that rounding has to exceed to matter.
const FINE: f64 = 0.02;

/// Powers of ten that times may be multiples of, the largest first.
const POWERS: std::ops::RangeInclusive<i32> = -3..=9;

/// Share of what times are rounded to that a reading may be off its even clock: rounding takes half, the fit of the clock a little.
const OFF: f64 = 0.7;

/// Gives evenly spaced times to readings whose own are those times, rounded, and says what they are rounded to.
///
/// Lines of the table are counted, so that rows without a reading are no hindrance.
pub(super) fn undo_rounding(samples: &mut [Sample]) -> Option<f64> {
    let first = samples.first()?.line;
    let row = |sample: &Sample| sample.line as f64 - first as f64;
    let quantum = POWERS.map(|power| 10_f64.powi(-power)).find(|quantum| {
        let are_multiples = |one: &Sample| {
            let of = one.t / quantum;
            (of - of.round()).abs() <= 1e-9 * of.abs().max(1.0)
        };
        samples.iter().all(are_multiples)
    })?;
    let n = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / n;
    let (middle, time) = (mean(&row), mean(&|one| one.t));
    let spread = mean(&|one| (row(one) - middle).powi(2));
    let step = mean(&|one| (row(one) - middle) * (one.t - time)) / spread;
    let even = |one: &Sample| time + step * (row(one) - middle);
    let off = samples.iter().map(|one| (one.t - even(one)).abs()).fold(0.0, f64::max);
    // The times of a table with digits enough are left as they are.
    let is_rounded = step > 0.0 && quantum >= FINE * step && off >= FINE * FINE * step;
    if !is_rounded || off > OFF * quantum {
        return None;
    }
    for one in samples.iter_mut() {
        one.t = time + step * (one.line as f64 - first as f64 - middle);
    }
    Some(quantum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(rate: f64, quantum: f64) -> Vec<Sample> {
        let of = |line: u64| Sample {
            line: line + 2,
            t: ((0.3 + line as f64 / rate) / quantum).round() * quantum,
            z: 0.0,
            x: 0.0,
        };
        (0..200).filter(|line| line % 17 != 5).map(of).collect()
    }

    /// Largest deviation from the true clock, whose zero does not matter.
    fn worst(samples: &[Sample], rate: f64) -> f64 {
        let off = |one: &Sample| one.t - (one.line - 2) as f64 / rate;
        let mean = samples.iter().map(off).sum::<f64>() / samples.len() as f64;
        samples.iter().map(|one| (off(one) - mean).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn times_rounded_to_a_few_digits_become_even() {
        for (rate, quantum) in [(650.0, 1e-3), (1700.0, 1e-3), (240.0, 1e-2)] {
            let mut rounded = samples(rate, quantum);
            let before = worst(&rounded, rate);
            assert_eq!(undo_rounding(&mut rounded).map(f64::to_bits), Some(quantum.to_bits()));
            assert!(worst(&rounded, rate) < 0.2 * before, "{rate}: {}", worst(&rounded, rate));
        }
    }

    #[test]
    fn clocks_with_digits_enough_and_uneven_ones_are_left() {
        let mut fine = samples(650.0, 1e-6);
        assert_eq!(undo_rounding(&mut fine), None);
        let mut even = samples(1000.0, 1e-3);
        assert_eq!(undo_rounding(&mut even), None);
        let mut uneven = samples(650.0, 1e-3);
        for one in &mut uneven[80..] {
            one.t += 3e-3;
        }
        assert_eq!(undo_rounding(&mut uneven), None);
    }
}
