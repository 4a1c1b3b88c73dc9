//! How often a verdict is right in sets of the benchmark.

use crate::verdict::{Counted, Probability, Verdict};

/// Development sets of the benchmark in which a listed effect is hidden, nothing, and an unlisted one.
const SETS: [f64; 3] = [310.0, 78.0, 116.0];

/// Of these, those with one verdict.
struct Row {
    verdict: Verdict,
    /// The hidden effect is named, alone or among others.
    right: f64,
    /// A listed effect is hidden, and not named.
    missed: f64,
    /// Nothing is hidden.
    nothing: f64,
    /// An unlisted effect is hidden.
    unlisted: f64,
}

const fn row(verdict: Verdict, [right, missed, nothing, unlisted]: [f64; 4]) -> Row {
    Row { verdict, right, missed, nothing, unlisted }
}

/// Counted in the rows `singles`, `nulls`, `unlisted`, `apparatus`, `vertical`, `one-intruder`, `repeats` and `scalars` of
/// `cargo xtask bench diagnosis`, whose effects have 3, 6 or 12 % of the resistance; an error of the apparatus that is
/// hidden counts as listed. Verdicts of fewer than ten sets are left out.
const ROWS: [Row; 5] = [
    row(Verdict::Supported, [173.0, 2.0, 0.0, 1.0]),
    row(Verdict::NoneOfTheCandidates, [0.0, 2.0, 0.0, 59.0]),
    row(Verdict::NothingDetected, [0.0, 37.0, 74.0, 24.0]),
    row(Verdict::BelowNoise, [0.0, 79.0, 0.0, 25.0]),
    row(Verdict::ExplainedByApparatus, [10.0, 0.0, 4.0, 1.0]),
];

/// Added to each count: what was not seen in so few sets may be.
const UNSEEN: f64 = 0.5;

/// What is true of a verdict, where nothing, a listed effect and an unlisted one are equally likely beforehand; `None` of
/// verdicts that the benchmark does not count.
pub(crate) fn of_benchmark(verdict: Verdict) -> Option<Probability> {
    let row = ROWS.iter().find(|row| row.verdict == verdict)?;
    let [listed, nothing, unlisted] = SETS;
    let share = |count: f64, sets: f64| (count + UNSEEN) / sets;
    let shares = [
        share(row.right, listed),
        share(row.missed, listed),
        share(row.nothing, nothing),
        share(row.unlisted, unlisted),
    ];
    let all: f64 = shares.iter().sum();
    let of = |share: f64| Some(share / all);
    Some(Probability {
        counted_in: Counted::Benchmark,
        right: of(shares[0]),
        nothing: of(shares[2]),
        unlisted: of(shares[3]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_weighed_by_how_many_sets_have_that_truth() {
        let supported = of_benchmark(Verdict::Supported).expect("it is counted");
        let [right, missed, nothing, unlisted] =
            [173.5 / 310.0, 2.5 / 310.0, 0.5 / 78.0, 1.5 / 116.0];
        let all = right + missed + nothing + unlisted;
        let is = |share: Option<f64>, wanted: f64| (share.unwrap_or(0.0) - wanted).abs() < 1e-12;
        assert!(is(supported.right, right / all), "{supported:?}");
        assert!(is(supported.nothing, nothing / all), "{supported:?}");
        assert!(is(supported.unlisted, unlisted / all), "{supported:?}");
        assert_eq!(of_benchmark(Verdict::CannotTell), None);
    }
}
