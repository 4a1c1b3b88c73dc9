//! Rows of the missing force: how often a formula is offered, whether it predicts, and whether its band holds.
//!
//! A verdict that names a listed effect offers no formula in its place. Where the truth is outside the list, one is then asked
//! for: a listed effect that fits as well is another description of the same force.

use diagnosis::diagnose::ALPHA;

use super::interval::Share;
use super::score::{Measured, Score, Target, spread};
use super::trial::{Answer, Missing, Trial};

/// Largest error with a formula, over that without, that is far nearer.
const FAR_NEARER: f64 = 0.6;

/// A trial that was answered.
type Answered<'a> = (&'a Trial, &'a Answer);

/// The formula that a verdict offers.
fn formula(answer: &Answer) -> Option<&Missing> {
    answer.missing.as_ref().filter(|one| one.formula.is_some())
}

/// The force that a verdict offers, or that is asked for.
fn force(answer: &Answer) -> Option<&Missing> {
    answer.missing.as_ref().or(answer.asked.as_ref())
}

/// The formula that a verdict offers, or that is asked for.
fn found(answer: &Answer) -> Option<&Missing> {
    force(answer).filter(|one| one.formula.is_some())
}

fn is_detected((_, answer): &Answered<'_>) -> bool {
    [answer.p1, answer.p_lof].into_iter().flatten().any(|p| p <= ALPHA)
}

/// Error on held-out conditions with the formula over that without; 1 where none is found.
fn ratio(answer: &Answer) -> f64 {
    let errors = found(answer).and_then(|one| one.held_out);
    let ratio = errors.and_then(|[before, after, _]| Some(after? / before?));
    ratio.unwrap_or(1.0)
}

/// All rows of `trials`.
pub(super) fn rows(rows: &mut Vec<Score>, trials: &[Answered<'_>]) {
    let of = |is: fn(&Answered<'_>) -> bool| trials.iter().copied().filter(is).collect::<Vec<_>>();
    unlisted(rows, &of(|(trial, _)| trial.plan.hidden.iter().any(|one| !one.is_listed())));
    listed(rows, &of(|(trial, _)| trial.plan.hidden.iter().any(|one| one.is_listed())));
    nulls(rows, &of(|(trial, _)| trial.plan.hidden.is_empty()));
}

/// Rows of `unlisted` effects.
fn unlisted(rows: &mut Vec<Score>, unlisted: &[Answered<'_>]) {
    let label = |what: &str| format!("outside the list: {what}");
    let detected: Vec<Answered<'_>> = unlisted.iter().copied().filter(is_detected).collect();
    let with_formula: Vec<Answered<'_>> =
        detected.iter().copied().filter(|(_, answer)| found(answer).is_some()).collect();
    let share = |what: &str, of: &[Answered<'_>], is: fn(&Answered<'_>) -> bool, target| Score {
        metric: label(what),
        measured: Measured::Share(Share::of(of, is)),
        target,
    };
    let has_formula: fn(&Answered<'_>) -> bool = |(_, answer)| formula(answer).is_some();
    rows.push(share("a formula offered, of those detected", &detected, has_formula, Target::None));
    let is_found: fn(&Answered<'_>) -> bool = |(_, answer)| found(answer).is_some();
    let what = "a formula offered, or found when it is asked for";
    rows.push(share(what, &detected, is_found, Target::None));
    let ratios: Vec<f64> = detected.iter().map(|(_, answer)| ratio(answer)).collect();
    let what = "held-out error with the formula over that without, 1 without a formula";
    rows.push(spread(label(what), &ratios, Target::AtMost(0.4)));
    let is_far_nearer: fn(&Answered<'_>) -> bool = |(_, answer)| ratio(answer) <= FAR_NEARER;
    rows.push(share("of these, at most 0.6", &detected, is_far_nearer, Target::AtLeast(0.8)));
    let ratios: Vec<f64> = with_formula.iter().map(|(_, answer)| ratio(answer)).collect();
    rows.push(spread(label("the same where there is a formula"), &ratios, Target::None));
    let is_worse: fn(&Answered<'_>) -> bool = |(_, answer)| ratio(answer) >= 1.0;
    let what = "formulas that predict worse than nothing";
    rows.push(share(what, &with_formula, is_worse, Target::AtMost(0.0)));
    let covered: Vec<f64> = detected
        .iter()
        .filter_map(|(_, answer)| force(answer))
        .map(|one| one.covered[0] as f64 / one.covered[1].max(1) as f64)
        .collect();
    let what = "share of a path where the 95 % band holds the true force";
    rows.push(spread(label(what), &covered, Target::Within(0.9, 0.98)));
}

/// Of listed effects: no formula is preferred to the true one.
fn listed(rows: &mut Vec<Score>, singles: &[Answered<'_>]) {
    let none = Share::of(singles, |(_, answer): &Answered<'_>| formula(answer).is_none());
    rows.push(Score {
        metric: "in the list: no formula offered in place of the effect".to_owned(),
        measured: Measured::Share(none),
        target: Target::AtLeast(0.95),
    });
}

/// Of nothing.
fn nulls(rows: &mut Vec<Score>, nulls: &[Answered<'_>]) {
    let offered = Share::of(nulls, |(_, answer): &Answered<'_>| formula(answer).is_some());
    rows.push(Score {
        metric: "nothing hidden: a formula offered".to_owned(),
        measured: Measured::Share(offered),
        target: Target::AtMost(0.01),
    });
}
