//! The diagnosis of a bed, with impacts that take no time.

use diagnosis::beds::Wish;
use validation::benchmark::beds::{Case, Hidden, Outcome};

use crate::imitation::Imitation;

/// On beds that scatter by 5 %, and runs on one bed by `runs`.
fn outcome(hidden: Hidden, runs: f64) -> Outcome {
    let impacts = Imitation { beds: 0.05, runs, fades: false };
    Case { hidden, seed: 0 }.run(&impacts, &Wish::default()).unwrap()
}

#[test]
fn where_nothing_is_hidden_nothing_is_named() {
    let one = outcome(Hidden::Nothing, 0.02);
    assert_eq!((one.verdict.as_str(), one.named.len()), ("nothing-detected", 0), "{one:?}");
}

#[test]
fn what_is_hidden_is_named_and_the_error_falls_on_fresh_beds() {
    // Runs on one bed that have much in common are screened alone, others by a design.
    for runs in [0.01, 0.05] {
        let one = outcome(Hidden::Switch("rolling-resistance", 0.2), runs);
        assert!(one.first && one.right && !one.wrong, "{one:?}");
        let [before, after, floor] = one.held_out.unwrap();
        assert!(before > 2.0 * after && after < 2.0 * floor, "{one:?}");
    }
}

#[test]
fn what_has_impacts_on_fresh_beds_miss_by_more_than_without_it_is_not_named() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: true };
    let case = Case { hidden: Hidden::Switch("rolling-resistance", 0.2), seed: 0 };
    let one = case.run(&impacts, &Wish::default()).unwrap();
    assert!(one.first, "{one:?}");
    assert_eq!((one.verdict.as_str(), one.named.len()), ("none-of-the-candidates", 0), "{one:?}");
}

#[test]
fn a_budget_that_pays_for_nothing_is_said_to_be_too_small() {
    let impacts = Imitation { beds: 0.05, runs: 0.02, fades: false };
    let wish = Wish { budget: Some(1e-3), ..Wish::default() };
    let case = Case { hidden: Hidden::Nothing, seed: 0 };
    let one = case.run(&impacts, &wish).unwrap();
    assert_eq!((one.verdict.as_str(), one.impacts), ("cannot-tell", 0));
}
