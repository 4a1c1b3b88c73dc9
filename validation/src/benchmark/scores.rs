//! Rows of the tables: what was measured beside what is asked for.

use diagnosis::diagnose::ALPHA;
use diagnosis::verdict::Verdict;

use super::beyond;
use super::imperfection::Imperfection;
use super::interval::{Share, mcnemar};
use super::next::Resolved;
use super::plan::{CAMERAS, Row, STRENGTHS};
use super::score::spread;
pub use super::score::{Measured, Reached, Score, Target};
use super::trial::{Answer, Trial};

/// A trial that was answered.
type Answered<'a> = (&'a Trial, &'a Answer);

/// Every row, but of sets that hide errors of the apparatus, from `trials` of any rows of the benchmark; rows without trials are left out.
pub fn scores(trials: &[Trial]) -> Vec<Score> {
    let answered = |row: Row| -> Vec<Answered<'_>> {
        let is_effect = |trial: &&Trial| !trial.plan.hidden.iter().any(|one| one.is_of_apparatus());
        let of_row = trials.iter().filter(|trial| trial.plan.row == row).filter(is_effect);
        of_row.filter_map(|trial| Some((trial, trial.answer()?))).collect()
    };
    let mut rows = Vec::new();
    let singles = answered(Row::Singles);
    full_data(&mut rows, &singles);
    nulls(&mut rows, &answered(Row::Nulls), "");
    unlisted(&mut rows, &answered(Row::Unlisted));
    pairs(&mut rows, &answered(Row::Pairs));
    less_data(&mut rows, &answered(Row::OneIntruder), &answered(Row::Vertical));
    scalars(&mut rows, &answered(Row::Scalars));
    nulls(&mut rows, &answered(Row::ScalarNulls), "scalars only, ");
    instrument(&mut rows, &answered(Row::Camera), &answered(Row::Beds), &answered(Row::Repeats));
    amplitudes(&mut rows, &singles);
    apparatus(&mut rows, &answered(Row::Apparatus));
    next(&mut rows, &answered(Row::Next));
    beyond::rows(&mut rows, &answered(Row::Beyond));
    rows.retain(|row| match &row.measured {
        Measured::Share(share) => share.n > 0,
        Measured::Spread { n, .. } => *n > 0,
    });
    rows
}

/// Whether the truth is ranked first.
pub(super) fn is_first((trial, answer): &Answered<'_>) -> bool {
    answer.ranked.first().is_some_and(|first| trial.hides(first))
}

fn is_in_first_two((trial, answer): &Answered<'_>) -> bool {
    answer.ranked.iter().take(2).any(|id| trial.hides(id))
}

/// Whether the truth is among those that cannot be told from the first.
fn is_among_leaders((trial, answer): &Answered<'_>) -> bool {
    answer.leaders.iter().any(|id| trial.hides(id))
}

/// Whether the verdict prints the truth, alone or in a set.
fn is_printed((trial, answer): &Answered<'_>) -> bool {
    match answer.verdict {
        Verdict::Supported => answer.named.iter().any(|id| trial.hides(id)),
        Verdict::NotSeparable => is_among_leaders(&(trial, answer)),
        _ => false,
    }
}

fn is_named_alone((_, answer): &Answered<'_>) -> bool {
    answer.verdict == Verdict::Supported
}

/// Whether the verdict names anything: one effect, a set or a pair.
fn is_anything_named((_, answer): &Answered<'_>) -> bool {
    answer.verdict.names_effects()
}

/// Whether a verdict is wrong that names something, where one effect is hidden: another effect alone, a set without it, or
/// a pair, which claims two.
fn is_wrong(one: &Answered<'_>) -> bool {
    is_anything_named(one) && !is_printed(one)
}

/// Whether the truth is named alone.
fn is_right(one: &Answered<'_>) -> bool {
    is_named_alone(one) && is_printed(one)
}

fn is_detected((_, answer): &Answered<'_>) -> bool {
    answer.p1.is_some_and(|p| p <= ALPHA)
}

fn is_none_or_pair((_, answer): &Answered<'_>) -> bool {
    matches!(answer.verdict, Verdict::NoneOfTheCandidates | Verdict::Pair)
}

fn full_data(rows: &mut Vec<Score>, singles: &[Answered<'_>]) {
    use Target::{AtLeast, AtMost};
    type Judge = fn(&Answered<'_>) -> bool;
    let metrics: [(&str, Judge, [Target; 3]); 8] = [
        ("truth ranked first", is_first, [0.70, 0.90, 0.92].map(AtLeast)),
        ("truth in first two", is_in_first_two, [0.88, 0.95, 0.95].map(AtLeast)),
        ("truth among those not separable from the first", is_among_leaders, [AtLeast(0.93); 3]),
        ("truth printed, alone or in a set", is_printed, [Target::None; 3]),
        ("named alone and right", is_right, [Target::None; 3]),
        ("a wrong effect, pair or set named", is_wrong, [AtMost(0.05); 3]),
        ("detected (p1 ≤ 0.01)", is_detected, [0.65, 0.92, 0.99].map(AtLeast)),
        ("in the list, called none or pair", is_none_or_pair, [AtMost(0.10); 3]),
    ];
    for (name, is, targets) in metrics {
        for (strength, target) in STRENGTHS.into_iter().zip(targets) {
            let here = at_strength(singles, strength);
            let metric = format!("{name}, {}", percent(strength));
            rows.push(row(metric, Share::of(&here, is), target));
        }
    }
}

fn nulls(rows: &mut Vec<Score>, nulls: &[Answered<'_>], data: &str) {
    let target = Target::AtMost(0.05);
    let rejected = |(_, answer): &Answered<'_>| answer.p_lof.is_some_and(|p| p <= ALPHA);
    let label = |what: &str| format!("{data}nothing hidden: {what}");
    let named = Share::of(nulls, is_anything_named);
    rows.push(row(label("an effect, pair or set named"), named, target));
    rows.push(row(label("baseline rejected"), Share::of(nulls, rejected), target));
    rows.push(row(label("p1 ≤ 0.01"), Share::of(nulls, is_detected), target));
}

fn unlisted(rows: &mut Vec<Score>, unlisted: &[Answered<'_>]) {
    let is = |verdict: Verdict| {
        Share::of(unlisted, move |(_, answer): &Answered<'_>| answer.verdict == verdict)
    };
    let mut add = |what: &str, share, target| {
        rows.push(row(format!("outside the list: {what}"), share, target));
    };
    add("none of the candidates", is(Verdict::NoneOfTheCandidates), Target::AtLeast(0.60));
    let blamed = Share::of(unlisted, is_anything_named);
    add("an effect, pair or set named", blamed, Target::AtMost(0.25));
    add("of these, one effect", is(Verdict::Supported), Target::None);
    add("of these, a pair", is(Verdict::Pair), Target::None);
    add("of these, a set", is(Verdict::NotSeparable), Target::None);
    add("nothing detected", is(Verdict::NothingDetected), Target::None);
}

/// Whether the verdict is a pair, and both of it are hidden.
fn is_exact_pair((trial, answer): &Answered<'_>) -> bool {
    answer.verdict == Verdict::Pair && is_hidden_pair(trial, &answer.named)
}

fn is_hidden_pair(trial: &Trial, ids: &[String]) -> bool {
    ids.len() == 2 && ids.iter().all(|id| trial.hides(id))
}

/// Whether a verdict is wrong that names something, where two effects are hidden: a pair that is not theirs, or an effect
/// or a set with neither.
fn is_wrong_of_two(one: &Answered<'_>) -> bool {
    let (_, answer) = one;
    match answer.verdict {
        Verdict::Pair => !is_exact_pair(one),
        _ => is_anything_named(one) && !is_printed(one),
    }
}

fn pairs(rows: &mut Vec<Score>, pairs: &[Answered<'_>]) {
    use Target::{AtLeast, AtMost};
    let found = |(trial, answer): &Answered<'_>| {
        answer.pair.as_ref().is_some_and(|pair| is_hidden_pair(trial, pair))
    };
    let mut add = |what: &str, share, target| {
        rows.push(row(format!("two effects (9 % each): {what}"), share, target));
    };
    add("exact pair found by the search", Share::of(pairs, found), AtLeast(0.7));
    add("verdict pair, and exact", Share::of(pairs, is_exact_pair), AtLeast(0.5));
    add("a wrong effect, pair or set named", Share::of(pairs, is_wrong_of_two), AtMost(0.05));
    add("first-ranked is one of them", Share::of(pairs, is_first), AtLeast(0.85));
}

fn less_data(rows: &mut Vec<Score>, one: &[Answered<'_>], vertical: &[Answered<'_>]) {
    use Target::AtLeast;
    let label = |what: &str| format!("one intruder, no spin (8 %): {what}");
    rows.push(row(label("ranked first"), Share::of(one, is_first), AtLeast(0.65)));
    rows.push(row(label("named alone and right"), Share::of(one, is_right), AtLeast(0.55)));
    let wrong = Share::of(one, is_wrong);
    rows.push(row(label("a wrong effect, pair or set named"), wrong, Target::AtMost(0.05)));
    let label = |what: &str| format!("vertical only (8 %): {what}");
    let first = Share::of(vertical, is_first);
    rows.push(row(label("ranked first"), first, AtLeast(0.85)));
    let wrong = Share::of(vertical, is_wrong);
    rows.push(row(label("a wrong effect, pair or set named"), wrong, Target::AtMost(0.05)));
    let blind = |id: &&str| {
        super::hidden::Hidden::listed()
            .any(|hidden| hidden.id() == *id && (hidden.needs_oblique() || hidden.needs_spin()))
    };
    let (mut refused, mut n) = (0, 0);
    for (_, answer) in vertical {
        n += answer.ranked.iter().map(String::as_str).filter(blind).count();
        let here = answer.refused.iter().map(String::as_str).filter(blind).count();
        (refused, n) = (refused + here, n + here);
    }
    let share = Share { hits: refused, n };
    rows.push(row(label("untestable effects refused"), share, AtLeast(1.0)));
}

fn scalars(rows: &mut Vec<Score>, scalars: &[Answered<'_>]) {
    use Target::AtLeast;
    for (strength, first) in STRENGTHS.into_iter().zip([0.65, 0.8, 0.9]) {
        let here = at_strength(scalars, strength);
        let label = |what: &str| format!("scalars only, {}: {what}", percent(strength));
        let share = Share::of(&here, is_first);
        rows.push(row(label("ranked first"), share, AtLeast(first)));
        let share = Share::of(&here, is_among_leaders);
        rows.push(row(label("not separable from the first"), share, AtLeast(0.9)));
        let wrong = Share::of(&here, is_wrong);
        let metric = label("a wrong effect, pair or set named");
        rows.push(row(metric, wrong, Target::AtMost(0.05)));
        let sizes: Vec<f64> = here.iter().map(|(_, answer)| answer.leaders.len() as f64).collect();
        rows.push(spread(label("size of that set"), &sizes, Target::None));
    }
}

/// Whether the truth is named, alone or among three at most.
fn is_among_three(one: &Answered<'_>) -> bool {
    is_printed(one) && one.1.leaders.len() <= 3
}

fn apparatus(rows: &mut Vec<Score>, all: &[Answered<'_>]) {
    use Target::{AtLeast, AtMost};
    let of = |is: &dyn Fn(&Trial) -> bool| -> Vec<Answered<'_>> {
        all.iter().copied().filter(|(trial, _)| is(trial)).collect()
    };
    let is_null = |trial: &Trial| trial.plan.hidden.is_empty();
    let is_unlisted = |trial: &Trial| trial.plan.hidden.iter().any(|one| !one.is_listed());
    let mut of_each =
        |what: &str, is_in: &dyn Fn(&Trial) -> bool, is: fn(&Answered<'_>) -> bool, target| {
            let label = |where_to: &str| format!("apparatus, {what}: {where_to}");
            rows.push(row(label("all"), Share::of(&of(is_in), is), target));
            for imperfection in Imperfection::ALL {
                let here =
                    of(&|trial| is_in(trial) && trial.plan.design.imperfection == imperfection);
                rows.push(row(label(imperfection.describe()), Share::of(&here, is), Target::None));
            }
        };
    of_each("nothing hidden, an effect named", &is_null, is_anything_named, AtMost(0.02));
    let listed = |trial: &Trial| !is_null(trial) && !is_unlisted(trial);
    of_each(
        "listed effect (12 %) named, among three at most",
        &listed,
        is_among_three,
        AtLeast(0.85),
    );
    of_each(
        "outside the list, a listed effect named alone",
        &is_unlisted,
        is_named_alone,
        AtMost(0.03),
    );
}

fn instrument(
    rows: &mut Vec<Score>,
    camera: &[Answered<'_>],
    beds: &[Answered<'_>],
    repeats: &[Answered<'_>],
) {
    let here = |all: &[Answered<'_>], is: &dyn Fn(&Trial) -> bool| {
        let some: Vec<Answered<'_>> = all.iter().copied().filter(|(trial, _)| is(trial)).collect();
        Share::of(&some, is_first)
    };
    for error in CAMERAS {
        let share = here(camera, &|trial| trial.plan.design.camera.total_cmp(&error).is_eq());
        let metric = format!("camera {:.2} mm (8 %): ranked first", 1e3 * error);
        rows.push(row(metric, share, Target::None));
    }
    for (name, low, least) in [("halved", true, 0.95), ("doubled", false, 0.4)] {
        let share = here(beds, &|trial| (trial.plan.design.path_scatter < 0.12) == low);
        let metric = format!("scatter of the bed {name} (8 %): ranked first");
        rows.push(row(metric, share, Target::AtLeast(least)));
    }
    for runs in [2, 5] {
        let share = here(repeats, &|trial| trial.plan.design.repeats == runs);
        let metric = format!("{runs} runs of each condition (8 %): ranked first");
        rows.push(row(metric, share, Target::None));
    }
}

fn amplitudes(rows: &mut Vec<Score>, singles: &[Answered<'_>]) {
    use super::hidden::Kinship;
    let right: Vec<Answered<'_>> = singles.iter().copied().filter(is_right).collect();
    let comparable: Vec<(f64, f64, f64)> = right
        .iter()
        .filter(|(trial, _)| trial.plan.hidden[0].form().kinship == Kinship::Same)
        .filter_map(|(_, answer)| answer.amplitude.map(|(q, se)| (q, se, answer.hidden[0])))
        .collect();
    let ratios: Vec<f64> = comparable.iter().map(|(q, _, truth)| q / truth).collect();
    let within = Target::Within(0.97, 1.03);
    rows.push(spread("amplitude over the hidden one, where named right".into(), &ratios, within));
    let covered = Share::of(&comparable, |(q, se, truth)| (q - truth).abs() <= 1.96 * se);
    let target = Target::Within(0.92, 0.98);
    rows.push(row("amplitude: 95 % intervals that hold the truth".into(), covered, target));
    for (strength, most) in STRENGTHS.into_iter().zip([0.30, 0.15, 0.12]) {
        let here = at_strength(singles, strength);
        let ratios: Vec<f64> = here
            .iter()
            .filter_map(|(_, answer)| answer.endpoint.map(|[before, after]| after / before))
            .collect();
        let metric = format!(
            "held-out resting points, error with / without what is named alone, {}",
            percent(strength)
        );
        rows.push(spread(metric, &ratios, Target::AtMost(most)));
    }
}

/// A choice of further conditions, and whether the truth stands alone with them.
type Arm = (&'static str, fn(&Resolved) -> bool);

fn next(rows: &mut Vec<Score>, extended: &[Answered<'_>]) {
    let unseparated: Vec<Resolved> =
        extended.iter().filter_map(|(_, answer)| answer.resolved).collect();
    let label = |what: &str| format!("several effects left (8 %), two more conditions: {what}");
    let arms: [Arm; 3] = [
        ("recommended", |one| one.recommended),
        ("of largest spread", |one| one.spread),
        ("drawn", |one| one.drawn),
    ];
    for (which, is_right) in arms {
        let share = Share::of(&unseparated, is_right);
        rows.push(row(label(&format!("truth alone with those {which}")), share, Target::None));
    }
    let [recommended, others @ ..] = arms;
    for (which, is_right) in others {
        let one_alone: Vec<&Resolved> =
            unseparated.iter().filter(|one| recommended.1(one) != is_right(one)).collect();
        let share = Share::of(&one_alone, |one| recommended.1(one));
        let p = mcnemar(share.hits, share.n - share.hits);
        let what = format!("with the recommended and not with those {which} (McNemar p {p:.3})");
        rows.push(row(label(&what), share, Target::None));
    }
}

pub(super) fn at_strength<'a>(all: &[Answered<'a>], strength: f64) -> Vec<Answered<'a>> {
    let here = |(trial, _): &Answered<'_>| trial.plan.strength.total_cmp(&strength).is_eq();
    all.iter().copied().filter(here).collect()
}

fn row(metric: String, share: Share, target: Target) -> Score {
    Score { metric, measured: Measured::Share(share), target }
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::super::plan::{Plan, Seeds, Size};
    use super::super::trial::Outcome;
    use super::*;

    #[test]
    fn a_target_is_met_by_the_end_of_the_interval_and_from_sixty_trials_on_by_the_estimate() {
        let reached = |target: Target, hits, n| target.reached(&Measured::Share(Share { hits, n }));
        // 18 of 20: 0.70 to 0.97.
        assert_eq!(reached(Target::AtLeast(0.69), 18, 20), Some(Reached::Met));
        assert_eq!(reached(Target::AtLeast(0.85), 18, 20), Some(Reached::NotShown));
        assert_eq!(reached(Target::AtLeast(0.95), 18, 20), Some(Reached::Missed));
        // 0 of 20: 0 to 0.16; fewer trials make it harder.
        assert_eq!(reached(Target::AtMost(0.05), 0, 20), Some(Reached::NotShown));
        assert_eq!(reached(Target::AtMost(0.05), 0, 100), Some(Reached::Met));
        // 54 of 60: 0.80 to 0.95.
        assert_eq!(reached(Target::AtLeast(0.9), 54, 60), Some(Reached::Met));
        assert_eq!(reached(Target::AtLeast(0.9), 53, 60), Some(Reached::Missed));
        assert_eq!(reached(Target::Within(0.6, 1.0), 18, 20), Some(Reached::Met));
        assert_eq!(reached(Target::Within(0.8, 1.0), 18, 20), Some(Reached::NotShown));
        assert_eq!(reached(Target::AtLeast(0.0), 0, 0), None);
        assert_eq!(reached(Target::None, 18, 20), None);
    }

    #[test]
    fn a_median_meets_a_target_by_its_interval() {
        let of = |values: &[f64]| spread(String::new(), values, Target::AtMost(0.3));
        let reached = |values: &[f64]| {
            let Score { measured, target, .. } = of(values);
            target.reached(&measured)
        };
        assert_eq!(reached(&[0.1; 20]), Some(Reached::Met));
        let scattered: Vec<f64> = (0..20).map(|k| 0.1 + 0.02 * f64::from(k)).collect();
        assert_eq!(reached(&scattered), Some(Reached::NotShown));
        assert_eq!(reached(&[0.1, 0.1, 0.1]), Some(Reached::NotShown), "no interval of three");
        assert_eq!(reached(&[0.4; 20]), Some(Reached::Missed));
    }

    /// The scores of one world of `row`, in which the first effect (and of pairs the second) of the list is hidden, answered
    /// with `verdict` and `named`, where `T` is what is hidden first.
    fn share_of(row: Row, metric: &str, (verdict, named): (Verdict, &[&str])) -> usize {
        let size = Size { draws: 1, rows: vec![row] };
        let plan: Plan = size.plans(Seeds::Development).swap_remove(0);
        let truth = plan.hidden.first().map_or("", |hidden| hidden.id()).to_owned();
        let named: Vec<String> = named
            .iter()
            .map(|id| if *id == "T" { truth.clone() } else { (*id).to_owned() })
            .collect();
        let answer = Answer {
            verdict,
            p1: None,
            p_lof: None,
            p_lof_with: None,
            ranked: Vec::new(),
            refused: Vec::new(),
            leaders: named.clone(),
            named,
            predicted_first: None,
            amplitude: None,
            hidden: vec![1.0; plan.hidden.len()],
            endpoint: None,
            held_out: None,
            apparatus: Vec::new(),
            pair: None,
            resolved: None,
            missing: None,
            asked: None,
            seconds: 1.0,
        };
        let trial = Trial { plan, outcome: Outcome::Answered(Box::new(answer)) };
        let found = scores(&[trial]).into_iter().find(|score| score.metric.starts_with(metric));
        match found.expect("the row").measured {
            Measured::Share(share) => share.hits,
            Measured::Spread { .. } => panic!("{metric} is no share"),
        }
    }

    #[test]
    fn a_wrong_pair_and_a_wrong_set_count_as_wrong_like_a_wrong_effect() {
        let wrong = |verdict, named: &[&str]| {
            share_of(Row::Singles, "a wrong effect, pair or set named", (verdict, named))
        };
        assert_eq!(wrong(Verdict::Supported, &["T"]), 0);
        assert_eq!(wrong(Verdict::Supported, &["tilt"]), 1);
        assert_eq!(wrong(Verdict::NotSeparable, &["tilt", "T"]), 0);
        assert_eq!(wrong(Verdict::NotSeparable, &["tilt", "lift"]), 1);
        // One effect is hidden, and a pair claims two.
        assert_eq!(wrong(Verdict::Pair, &["tilt", "lift"]), 1);
        assert_eq!(wrong(Verdict::Pair, &["tilt", "T"]), 1);
        assert_eq!(wrong(Verdict::NoneOfTheCandidates, &[]), 0);
        assert_eq!(wrong(Verdict::NothingDetected, &[]), 0);
    }

    #[test]
    fn what_is_outside_the_list_is_not_blamed_only_where_nothing_is_named() {
        let share =
            |metric, verdict, named: &[&str]| share_of(Row::Unlisted, metric, (verdict, named));
        let [blamed, refused] =
            ["outside the list: an effect", "outside the list: none of the candidates"];
        for (verdict, named) in [
            (Verdict::Supported, &["tilt"][..]),
            (Verdict::Pair, &["tilt", "lift"]),
            (Verdict::NotSeparable, &["tilt", "lift"]),
        ] {
            assert_eq!(share(blamed, verdict, named), 1, "{verdict:?}");
            assert_eq!(share(refused, verdict, named), 0, "{verdict:?}");
        }
        assert_eq!(share(blamed, Verdict::NoneOfTheCandidates, &[]), 0);
        assert_eq!(share(refused, Verdict::NoneOfTheCandidates, &[]), 1);
        assert_eq!(share(refused, Verdict::NothingDetected, &[]), 0);
    }

    #[test]
    fn of_two_hidden_effects_one_may_be_named_and_a_pair_must_be_theirs() {
        let wrong = |verdict, named: &[&str]| {
            let metric = "two effects (9 % each): a wrong effect, pair or set named";
            share_of(Row::Pairs, metric, (verdict, named))
        };
        assert_eq!(wrong(Verdict::Supported, &["T"]), 0);
        assert_eq!(wrong(Verdict::Supported, &["late-force"]), 1);
        assert_eq!(wrong(Verdict::Pair, &["T", "late-force"]), 1);
        assert_eq!(wrong(Verdict::NotSeparable, &["late-force", "drift"]), 1);
    }
}
