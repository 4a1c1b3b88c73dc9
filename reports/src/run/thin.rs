//! As many samples of a series as a figure can show.

/// Places of at most `n` of `times` (s, rising), the first and the last among them, about as far apart
/// in time as they can be.
pub(super) fn places(times: &[f64], n: usize) -> Vec<usize> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let n = n.max(2);
    if times.len() <= n {
        return (0..times.len()).collect();
    }
    let step = (last - first) / (n - 1) as f64;
    let mut places: Vec<usize> = (0..n)
        .map(|at| times.partition_point(|time| *time < first + step * at as f64))
        .map(|place| place.min(times.len() - 1))
        .collect();
    places.dedup();
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_series_keeps_its_ends_and_is_even_in_time() {
        let times: Vec<f64> = (0..10_001).map(|at| 1e-4 * f64::from(at)).collect();
        let kept = places(&times, 101);
        assert_eq!((kept[0], kept.last().copied()), (0, Some(10_000)));
        // A hundred steps of 10 ms; a sample may lie one beside.
        assert!(kept.windows(2).all(|pair| (99..=101).contains(&(pair[1] - pair[0]))), "{kept:?}");
    }

    #[test]
    fn samples_that_crowd_at_the_end_leave_the_rest_of_the_time_its_places() {
        let times = [0.0, 0.5, 0.9, 0.99, 0.999, 1.0];
        assert_eq!(places(&times, 3), [0, 1, 5]);
    }

    #[test]
    fn a_short_series_is_kept_whole() {
        assert_eq!(places(&[0.0, 1.0, 1.0], 5), [0, 1, 2]);
        assert!(places(&[], 5).is_empty());
    }
}
