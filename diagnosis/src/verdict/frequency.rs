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

/// Sets of the rows `--lammps` and `--prepared` of `cargo xtask bench beds`: rolling resistance or another friction is hidden,
/// nothing, and another density of the grains.
const BED_SETS: [f64; 3] = [52.0, 22.0, 7.0];

/// Of these, those in which an effect is named, alone or among others, and those in which none is: the benchmark of beds is
/// too small to count each verdict by itself.
const BEDS_NAMED: [f64; 4] = [32.0, 2.0, 0.0, 1.0];
const BEDS_UNNAMED: [f64; 4] = [0.0, 18.0, 22.0, 6.0];

/// What is true of a verdict on a force law, where nothing, a listed effect and an unlisted one are equally likely
/// beforehand; `None` of verdicts that the benchmark does not count.
pub(crate) fn of_benchmark(verdict: Verdict) -> Option<Probability> {
    let row = ROWS.iter().find(|row| row.verdict == verdict)?;
    let counts = [row.right, row.missed, row.nothing, row.unlisted];
    Some(weighed(Counted::Benchmark, counts, SETS))
}

/// The same of a verdict on a bed of grains; `None` where the data cannot answer.
pub(crate) fn of_bed_benchmark(verdict: Verdict, names: bool) -> Option<Probability> {
    let counts = match (verdict, names) {
        (Verdict::CannotTell, _) => return None,
        (_, true) => BEDS_NAMED,
        (_, false) => BEDS_UNNAMED,
    };
    Some(weighed(Counted::BedBenchmark, counts, BED_SETS))
}

/// Shares of `sets` in which the answer is right, a listed effect is missed, nothing is hidden and something unlisted is,
/// as parts of one.
fn weighed(
    counted_in: Counted,
    counts: [f64; 4],
    [listed, nothing, unlisted]: [f64; 3],
) -> Probability {
    let sets = [listed, listed, nothing, unlisted];
    let shares: [f64; 4] = std::array::from_fn(|i| (counts[i] + UNSEEN) / sets[i]);
    let all: f64 = shares.iter().sum();
    let of = |share: f64| Some(share / all);
    Probability {
        counted_in,
        right: (counts[0] > 0.0).then(|| shares[0] / all),
        nothing: of(shares[2]),
        unlisted: of(shares[3]),
    }
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

    #[test]
    fn a_name_is_right_in_most_beds_and_no_name_does_not_prove_that_nothing_is_missing() {
        let named = of_bed_benchmark(Verdict::Supported, true).expect("it is counted");
        assert!(named.right > Some(0.5) && named.nothing < Some(0.1), "{named:?}");
        let unnamed = of_bed_benchmark(Verdict::BelowNoise, false).expect("it is counted");
        assert_eq!(unnamed.right, None);
        assert!(unnamed.nothing > unnamed.unlisted, "{unnamed:?}");
        assert_eq!(of_bed_benchmark(Verdict::CannotTell, false), None);
    }
}
