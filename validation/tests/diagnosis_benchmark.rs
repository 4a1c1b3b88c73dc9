//! A few worlds of the benchmark of the diagnosis, with claims that can fail.

use validation::benchmark::hidden::Hidden;
use validation::benchmark::plan::{Row, Seeds, Size};
use validation::benchmark::trial::{Answer, Trial, baseline};
use validation::verdict::Verdict;

/// The answers to the first `most` sets of `row` that `wanted` picks.
fn answers(row: Row, most: usize, wanted: impl Fn(&[Hidden], f64) -> bool) -> Vec<(Trial, Answer)> {
    let model = baseline().expect("the shipped model loads");
    let plans = Size { draws: 1, rows: vec![row] }.plans(Seeds::Development);
    let wanted = plans.into_iter().filter(|plan| wanted(&plan.hidden, plan.strength));
    wanted
        .take(most)
        .map(|plan| {
            let trial = Trial::of(plan, &model);
            let answer = trial.answer().cloned().unwrap_or_else(|| panic!("{:?}", trial.outcome));
            (trial, answer)
        })
        .collect()
}

#[test]
fn strong_effects_of_clear_signature_are_detected_and_ranked_first() {
    let clear = [Hidden::Magnus, Hidden::RailFriction, Hidden::Buoyancy];
    let strong = |hidden: &[Hidden], strength: f64| clear.contains(&hidden[0]) && strength > 0.1;
    for (trial, answer) in answers(Row::Singles, 3, strong) {
        let hidden = trial.plan.hidden[0].id();
        // The study found each of these in every set at 12 %.
        assert_eq!(answer.ranked[0], hidden, "{answer:?}");
        assert!(answer.p1.is_some_and(|p| p <= 0.01), "{answer:?}");
    }
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    for (_, answer) in answers(Row::Nulls, 3, |_, _| true) {
        assert_eq!(answer.verdict, Verdict::NothingDetected, "{answer:?}");
    }
}

#[test]
fn what_the_data_cannot_show_is_refused_not_ranked() {
    let some = |hidden: &[Hidden], _: f64| hidden[0] == Hidden::YieldStress;
    for (_, answer) in answers(Row::Vertical, 1, some) {
        for blind in Hidden::listed().filter(|hidden| hidden.needs_oblique() || hidden.needs_spin())
        {
            assert!(!answer.ranked.iter().any(|id| id == blind.id()), "{answer:?}");
        }
    }
}
