//! Which of many tests to believe.

/// Which of the tests with these p-values are discoveries, of which on average no more than the share
/// `rate` is false (Benjamini & Hochberg 1995, J. R. Stat. Soc. B 57, 289).
pub(crate) fn discoveries(p: &[f64], rate: f64) -> Vec<bool> {
    let mut sorted = p.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let limit = sorted
        .iter()
        .enumerate()
        .rfind(|(rank, p)| **p <= rate * (*rank as f64 + 1.0) / n)
        .map_or(-1.0, |(_, p)| *p);
    p.iter().map(|p| *p <= limit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_authors_has_four_discoveries() {
        // §3.2 of their article: fifteen tests of thrombolysis, four rejected at 5 %.
        let p = [
            0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262,
            0.5719, 0.6528, 0.7590, 1.0,
        ];
        let found = discoveries(&p, 0.05);
        assert_eq!(found.iter().filter(|found| **found).count(), 4);
        assert!(found[..4].iter().all(|found| *found));
    }

    #[test]
    fn without_tests_there_is_nothing_to_believe() {
        assert!(discoveries(&[], 0.05).is_empty());
    }
}
