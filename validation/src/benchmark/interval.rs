//! Shares with their intervals.

/// Of the normal distribution: 95 % lie within this many standard deviations.
const Z: f64 = 1.959_963_984_540_054;

/// How many of how many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// How many.
    pub hits: usize,
    /// Of how many.
    pub n: usize,
}

impl Share {
    /// Those of `all` for which `is` holds.
    pub fn of<T>(all: &[T], is: impl Fn(&T) -> bool) -> Self {
        Self { hits: all.iter().filter(|one| is(one)).count(), n: all.len() }
    }

    /// The share; none of none.
    #[must_use]
    pub fn value(self) -> Option<f64> {
        (self.n > 0).then(|| self.hits as f64 / self.n as f64)
    }

    /// Interval of 95 % (Wilson 1927, J. Am. Stat. Assoc. 22, 209); everything is possible of none.
    #[must_use]
    pub fn interval(self) -> [f64; 2] {
        let Some(share) = self.value() else { return [0.0, 1.0] };
        let n = self.n as f64;
        let square = Z * Z / n;
        let middle = share + 0.5 * square;
        let half = Z * (share * (1.0 - share) / n + 0.25 * square / n).sqrt();
        [(middle - half) / (1.0 + square), (middle + half) / (1.0 + square)]
            .map(|bound| bound.clamp(0.0, 1.0))
    }
}

/// Probability that two methods which are equally good differ as much as here or more, where the first
/// alone is right `first` times and the second alone `second` times (McNemar 1947, Psychometrika 12,
/// 153, with the binomial distribution itself).
pub fn mcnemar(first: usize, second: usize) -> f64 {
    let n = first + second;
    // The first term is 1/2ⁿ, each next one is larger by (n − k)/(k + 1).
    let mut term = 0.5_f64.powi(i32::try_from(n).unwrap_or(i32::MAX));
    let mut tail = 0.0;
    for k in 0..=first.min(second) {
        tail += term;
        term *= (n - k) as f64 / (k + 1) as f64;
    }
    f64::min(1.0, 2.0 * tail)
}

/// The quantile `share` of `values`, linear between two; none of none.
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().checked_sub(1)? as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    Some(below + (above - below) * place.fract())
}

/// Interval of at least 95 % of the median of what `values` are drawn from, whatever its distribution: the two values
/// between which it lies as a coin would have it (Conover 1999, Practical Nonparametric Statistics, section 3.2). None of
/// fewer than six.
pub fn interval_of_median(values: &[f64]) -> Option<[f64; 2]> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    // The first term is 1/2ⁿ, each next one is larger by (n − k)/(k + 1).
    let mut term = 0.5_f64.powi(i32::try_from(n).unwrap_or(i32::MAX));
    let (mut tail, mut outside) = (term, 0);
    while tail <= 0.025 && outside < n {
        term *= (n - outside) as f64 / (outside + 1) as f64;
        tail += term;
        outside += 1;
    }
    let first = outside.checked_sub(1)?;
    Some([*sorted.get(first)?, sorted[n - 1 - first]])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table I of Newcombe (1998), Stat. Med. 17, 857, method 3, to its four digits.
    #[test]
    fn intervals_are_the_published_ones() {
        for (hits, n, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let found = Share { hits, n }.interval();
            assert!((found[0] - low).abs() < 5.1e-5, "{found:?}");
            assert!((found[1] - high).abs() < 5.1e-5, "{found:?}");
        }
    }

    #[test]
    fn the_test_of_pairs_is_the_two_sided_binomial_one() {
        // (1 + 10)/2¹⁰ twice; a tie says nothing, nor do no pairs. Sums of powers of two are exact.
        assert!((mcnemar(9, 1) - 22.0 / 1024.0).abs() < 1e-15);
        assert!((mcnemar(1, 9) - mcnemar(9, 1)).abs() < 1e-15);
        assert_eq!((mcnemar(3, 3), mcnemar(0, 0)), (1.0, 1.0));
    }

    #[test]
    fn a_median_lies_between_the_values_that_the_tables_say() {
        // Ranks of the interval of at least 95 %: 1 and 6 of 6, 2 and 9 of 10, 6 and 15 of 20.
        let ranks = |n: u32| interval_of_median(&(1..=n).map(f64::from).collect::<Vec<_>>());
        assert_eq!(ranks(5), None);
        assert_eq!(ranks(0), None);
        assert_eq!(ranks(6), Some([1.0, 6.0]));
        assert_eq!(ranks(10), Some([2.0, 9.0]));
        assert_eq!(ranks(20), Some([6.0, 15.0]));
    }

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        assert_eq!(quantile(&[4.0, 1.0, 3.0, 2.0], 0.5), Some(2.5));
        assert_eq!(quantile(&[7.0], 0.25), Some(7.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
