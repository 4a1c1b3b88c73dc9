//! Clocks that were written with few digits.

use measurements::median;

use super::track::Sample;

/// Share of a step that rounding has to exceed to matter.
const FINE: f64 = 0.02;

/// Powers of ten that times may be multiples of, the largest first.
const POWERS: std::ops::RangeInclusive<i32> = -3..=9;

/// Share of what times are rounded to that a reading may be off its even clock: rounding takes half, the fit of the clock a little.
const OFF: f64 = 0.7;

/// An exact clock has so few longer steps at most, or so small a share of them: a tracker that loses the body writes no row.
const FEW: usize = 3;
const FEW_OF: f64 = 0.03;

/// Gives evenly spaced times to readings whose own are those times, rounded, and says what they are rounded to.
///
/// Lines of the table are counted, so that rows without a reading are no hindrance.
pub(super) fn undo_rounding(samples: &mut [Sample]) -> Option<f64> {
    let (first, start) = samples.first().map(|one| (one.line, one.t))?;
    let row = |sample: &Sample| sample.line as f64 - first as f64;
    let quantum = POWERS.map(|power| 10_f64.powi(-power)).find(|quantum| {
        let are_multiples = |one: &Sample| {
            let of = (one.t - start) / quantum;
            // A time in seconds since 1970 is itself rounded to 0.2 µs.
            let rounding = 1e-6 + 4.0 * f64::EPSILON * one.t.abs() / quantum;
            rounding < 0.05 && (of - of.round()).abs() <= rounding
        };
        samples.iter().all(are_multiples)
    })?;
    if is_exact(samples, quantum) {
        return None;
    }
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

/// Least ratio of the roughness over the stated times to that over even times, at which the stated times are noise; and the
/// largest distance of a time from an even clock, in steps.
const SMOOTHER: f64 = 0.5;
const NOISY: f64 = 1.0;

/// Replaces times that scatter around an even clock by even ones, if the path is much smoother over these. Returns the root mean
/// square scatter of the stated times.
pub(super) fn undo_jitter(samples: &mut [Sample]) -> Option<f64> {
    let is_gapless = samples.windows(2).all(|pair| pair[1].line == pair[0].line + 1);
    let n = samples.len() as f64;
    if !is_gapless || samples.len() < 16 {
        return None;
    }
    let rows: Vec<f64> = (0..samples.len()).map(|row| row as f64 - 0.5 * (n - 1.0)).collect();
    let middle = samples.iter().map(|one| one.t).sum::<f64>() / n;
    let spread = rows.iter().map(|row| row * row).sum::<f64>();
    let step =
        rows.iter().zip(&*samples).map(|(row, one)| row * (one.t - middle)).sum::<f64>() / spread;
    let even: Vec<f64> = rows.iter().map(|row| middle + step * row).collect();
    let off: Vec<f64> = even.iter().zip(&*samples).map(|(even, one)| one.t - even).collect();
    let rms = (off.iter().map(|off| off * off).sum::<f64>() / n).sqrt();
    let is_scattered = off.iter().all(|off| off.abs() < NOISY * step) && rms > FINE * step;
    let own: Vec<f64> = samples.iter().map(|one| one.t).collect();
    if !is_scattered || roughness(samples, &even) > SMOOTHER * roughness(samples, &own) {
        return None;
    }
    samples.iter_mut().zip(even).for_each(|(one, t)| one.t = t);
    Some(rms)
}

/// Median distance of the readings of a moving body from a parabola through their neighbours, with the times of this clock.
fn roughness(samples: &[Sample], clock: &[f64]) -> f64 {
    /// Share of the longest way over four rows below which a body counts as still.
    const MOVES: f64 = 0.3;
    let fours = || samples.windows(4).zip(clock.windows(4));
    let way = |four: &[Sample]| (four[3].z - four[0].z).abs();
    let longest = fours().map(|(four, _)| way(four)).fold(0.0, f64::max);
    let off = |(four, t): (&[Sample], &[f64])| {
        let weight = |at: usize| {
            (0..4)
                .filter(|other| *other != at)
                .map(|other| t[at] - t[other])
                .product::<f64>()
                .recip()
        };
        let weights = [0, 1, 2, 3].map(weight);
        let sum: f64 = four.iter().zip(weights).map(|(one, weight)| weight * one.z).sum();
        sum.abs() / weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt()
    };
    let moving = fours().filter(|(four, _)| way(four) > MOVES * longest);
    // Times that repeat make no parabola.
    median(moving.map(off).filter(|off| off.is_finite())).unwrap_or(0.0)
}

/// Whether consecutive rows are one constant number of `quantum` apart, with few exceptions.
fn is_exact(samples: &[Sample], quantum: f64) -> bool {
    let beside = samples.windows(2).filter(|pair| pair[1].line == pair[0].line + 1);
    let steps: Vec<i64> =
        beside.map(|pair| ((pair[1].t - pair[0].t) / quantum).round() as i64).collect();
    let mut counts = std::collections::BTreeMap::new();
    steps.iter().for_each(|step| *counts.entry(*step).or_insert(0_usize) += 1);
    let commonest = counts.into_iter().max_by_key(|(_, count)| *count);
    commonest.is_some_and(|(step, count)| {
        let others = steps.len() - count;
        step > 0 && others <= FEW.max((FEW_OF * steps.len() as f64) as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(rate: f64, quantum: f64) -> Vec<Sample> {
        samples_where(rate, quantum, |line| line % 17 != 5)
    }

    fn samples_where(rate: f64, quantum: f64, is_there: fn(&u64) -> bool) -> Vec<Sample> {
        let of = |line: u64| Sample {
            line: line + 2,
            t: ((0.3 + line as f64 / rate) / quantum).round() * quantum,
            z: 0.0,
            x: 0.0,
        };
        (0..200).filter(is_there).map(of).collect()
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

    /// A fall at 240 Hz; true and written times are given as functions of the even time.
    fn fall(truth: impl Fn(f64) -> f64, written: impl Fn(f64) -> f64) -> Vec<Sample> {
        let of = |line: u64| {
            let t = line as f64 / 240.0;
            let z = 0.5 * 9.81 * truth(t).powi(2) + 1e-4 * libm::sin(line as f64 * 1.7);
            Sample { line: line + 2, t: written(t), z, x: 0.0 }
        };
        (0..60).map(of).collect()
    }

    #[test]
    fn noisy_stamps_of_even_rows_become_even_and_true_ones_stay() {
        let jitter = |t: f64| t + 5e-4 * libm::sin(t * 2399.0);
        let mut noisy = fall(|t| t, jitter);
        let off = undo_jitter(&mut noisy).expect("they are noise");
        assert!((2e-4..5e-4).contains(&off), "{off}");
        assert!(worst(&noisy, 240.0) < 2e-4, "{}", worst(&noisy, 240.0));
        assert_eq!(undo_jitter(&mut fall(jitter, jitter)), None);
        assert_eq!(undo_jitter(&mut fall(|t| t, |t| t)), None);
    }

    #[test]
    fn clocks_with_digits_enough_and_uneven_ones_are_left() {
        let mut fine = samples(650.0, 1e-6);
        assert_eq!(undo_rounding(&mut fine), None);
        let mut even = samples(1000.0, 1e-3);
        assert_eq!(undo_rounding(&mut even), None);
        // The tracker writes no row for a frame in which it loses the body.
        for (rate, quantum) in [(1000.0, 1e-3), (100.0, 1e-2), (240.0, 1e-7)] {
            let mut gaps = samples_where(rate, quantum, |line| ![20, 75, 140].contains(line));
            gaps.iter_mut().zip(2..).for_each(|(one, line)| {
                one.line = line;
                one.t += 1.7e9;
            });
            assert_eq!(undo_rounding(&mut gaps), None, "{rate}");
        }
        let mut uneven = samples(650.0, 1e-3);
        for one in &mut uneven[80..] {
            one.t += 3e-3;
        }
        assert_eq!(undo_rounding(&mut uneven), None);
    }
}
