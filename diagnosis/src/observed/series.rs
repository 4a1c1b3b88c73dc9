//! Readings along a path: a choice of them, and their stated errors.

/// The indices of at most `count` of `n` readings. They are evenly spaced and include the first and the last. A `count` of
/// one gives the middle reading.
pub(crate) fn evenly(n: usize, count: usize) -> Vec<usize> {
    match count {
        _ if n <= count => (0..n).collect(),
        0 => Vec::new(),
        1 => vec![n / 2],
        _ => (0..count).map(|k| (k * (n - 1) + (count - 1) / 2) / (count - 1)).collect(),
    }
}

/// Root mean square of the stated errors of the readings nearest to `place`, one reading per run. A reading is a pair of
/// place and standard deviation. `None` if one of these readings states no error.
pub(crate) fn stated_sigma<R>(runs: impl Iterator<Item = R>, place: f64) -> Option<f64>
where
    R: Iterator<Item = (f64, Option<f64>)>,
{
    let (mut sum, mut n) = (0.0, 0.0);
    for run in runs {
        let away = |one: &(f64, Option<f64>)| (one.0 - place).abs();
        let (_, sigma) = run.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        sum += sigma?.powi(2);
        n += 1.0;
    }
    (n > 0.0).then(|| f64::sqrt(sum / n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_and_the_last_are_kept_and_each_once() {
        assert_eq!(evenly(9, 3), [0, 4, 8]);
        assert_eq!(evenly(9, 1), [4]);
        assert!(evenly(9, 0).is_empty());
        for count in 2..12 {
            let mut chosen = evenly(9, count);
            assert_eq!((chosen[0], chosen[chosen.len() - 1]), (0, 8));
            chosen.dedup();
            assert_eq!(chosen.len(), count.min(9));
        }
    }

    #[test]
    fn the_error_of_a_place_is_that_of_the_nearest_readings() {
        let runs = [[(0.0, Some(1.0)), (1.0, Some(3.0))], [(0.1, Some(2.0)), (0.9, Some(4.0))]];
        let at = |place| stated_sigma(runs.iter().map(|run| run.iter().copied()), place);
        assert!((at(1.0).expect("stated") - f64::sqrt(12.5)).abs() < 1e-15);
        assert!((at(-1.0).expect("stated") - f64::sqrt(2.5)).abs() < 1e-15);
        let unsure = [[(0.0, None)]];
        assert_eq!(stated_sigma(unsure.iter().map(|run| run.iter().copied()), 0.0), None);
    }
}
