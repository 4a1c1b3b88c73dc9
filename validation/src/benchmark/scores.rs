//! Rows of the tables: what was measured beside what is asked for.

use super::interval::{Share, mcnemar, quantile};
use super::next::Resolved;
use super::plan::{CAMERAS, Row, STRENGTHS};
use super::trial::{Answer, Trial};
use crate::diagnose::ALPHA;
use crate::verdict::Verdict;

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// What is measured.
    pub metric: String,
    /// What came out.
    pub measured: Measured,
    /// What must be reached.
    pub required: Target,
    /// What would be good.
    pub stretch: Target,
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// How many of how many.
    Share(Share),
    /// Median, quartiles, and of how many.
    Spread {
        /// First quartile, median, third quartile; none of none.
        quartiles: Option<[f64; 3]>,
        /// How many.
        n: usize,
    },
}

/// What a number is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At least.
    AtLeast(f64),
    /// At most.
    AtMost(f64),
    /// From, to.
    Within(f64, f64),
    /// Only shown.
    None,
}

impl Target {
    /// Whether it is met: by the median of a spread, by the interval of a share if that reaches it;
    /// `None` where nothing is asked or nothing was measured.
    #[must_use]
    pub fn is_met(self, measured: &Measured) -> Option<bool> {
        let [low, high] = match measured {
            Measured::Share(share) => {
                share.value()?;
                share.interval()
            }
            Measured::Spread { quartiles, .. } => [(*quartiles)?[1]; 2],
        };
        match self {
            Self::AtLeast(least) => Some(high >= least),
            Self::AtMost(most) => Some(low <= most),
            Self::Within(from, to) => Some(high >= from && low <= to),
            Self::None => None,
        }
    }
}

/// A trial that was answered.
type Answered<'a> = (&'a Trial, &'a Answer);

/// Every row, from `trials` of any rows of the benchmark; rows without trials are left out.
#[must_use]
pub fn scores(trials: &[Trial]) -> Vec<Score> {
    let answered = |row: Row| -> Vec<Answered<'_>> {
        let of_row = trials.iter().filter(|trial| trial.plan.row == row);
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
    next(&mut rows, &answered(Row::Next));
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

fn is_wrong(one: &Answered<'_>) -> bool {
    is_named_alone(one) && !is_printed(one)
}

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
    let metrics: [(&str, Judge, [Target; 3], [Target; 3]); 7] = [
        (
            "truth ranked first",
            is_first,
            [0.70, 0.90, 0.92].map(AtLeast),
            [0.85, 0.95, 0.98].map(AtLeast),
        ),
        (
            "truth in first two",
            is_in_first_two,
            [0.88, 0.95, 0.95].map(AtLeast),
            [0.95, 0.98, 1.0].map(AtLeast),
        ),
        (
            "truth among those not separable from the first",
            is_among_leaders,
            [AtLeast(0.93); 3],
            [AtLeast(0.98); 3],
        ),
        ("truth printed, alone or in a set", is_printed, [Target::None; 3], [Target::None; 3]),
        ("named alone and wrong", is_wrong, [AtMost(0.05); 3], [AtMost(0.02); 3]),
        (
            "detected (p1 ≤ 0.01)",
            is_detected,
            [0.65, 0.92, 0.99].map(AtLeast),
            [0.85, 1.0, 1.0].map(AtLeast),
        ),
        ("in the list, called none or pair", is_none_or_pair, [AtMost(0.10); 3], [AtMost(0.05); 3]),
    ];
    for (name, is, required, stretch) in metrics {
        for (level, strength) in STRENGTHS.into_iter().enumerate() {
            let here = at_strength(singles, strength);
            let metric = format!("{name}, {}", percent(strength));
            let share = Share::of(&here, is);
            rows.push(row(metric, share, required[level], stretch[level]));
        }
    }
}

fn nulls(rows: &mut Vec<Score>, nulls: &[Answered<'_>], data: &str) {
    let (required, stretch) = (Target::AtMost(0.05), Target::AtMost(0.02));
    let named = |(_, answer): &Answered<'_>| {
        matches!(answer.verdict, Verdict::Supported | Verdict::NotSeparable | Verdict::Pair)
    };
    let rejected = |(_, answer): &Answered<'_>| answer.p_lof.is_some_and(|p| p <= ALPHA);
    let label = |what: &str| format!("{data}nothing hidden: {what}");
    rows.push(row(label("an effect named"), Share::of(nulls, named), required, stretch));
    rows.push(row(label("baseline rejected"), Share::of(nulls, rejected), required, stretch));
    rows.push(row(label("p1 ≤ 0.01"), Share::of(nulls, is_detected), required, stretch));
}

fn unlisted(rows: &mut Vec<Score>, unlisted: &[Answered<'_>]) {
    use Target::{AtLeast, AtMost};
    let is = |verdict: Verdict| move |(_, answer): &Answered<'_>| answer.verdict == verdict;
    let label = |what: &str| format!("outside the list: {what}");
    let mut add = |what: &str, share, required, stretch| {
        rows.push(row(label(what), share, required, stretch));
    };
    let refused = Share::of(unlisted, is_none_or_pair);
    add("none of the candidates or pair", refused, AtLeast(0.60), AtLeast(0.8));
    let none = Share::of(unlisted, is(Verdict::NoneOfTheCandidates));
    add("none of the candidates", none, Target::None, Target::None);
    add("pair", Share::of(unlisted, is(Verdict::Pair)), Target::None, Target::None);
    let single = Share::of(unlisted, is_named_alone);
    add("one effect named", single, AtMost(0.25), AtMost(0.1));
    let set = Share::of(unlisted, is(Verdict::NotSeparable));
    add("a set named", set, Target::None, Target::None);
    let nothing = Share::of(unlisted, is(Verdict::NothingDetected));
    add("nothing detected", nothing, Target::None, Target::None);
}

fn pairs(rows: &mut Vec<Score>, pairs: &[Answered<'_>]) {
    use Target::AtLeast;
    let exact =
        |ids: &[String], trial: &Trial| ids.len() == 2 && ids.iter().all(|id| trial.hides(id));
    let found = |(trial, answer): &Answered<'_>| {
        answer.pair.as_ref().is_some_and(|pair| exact(pair, trial))
    };
    let said = |(trial, answer): &Answered<'_>| {
        answer.verdict == Verdict::Pair && exact(&answer.named, trial)
    };
    let mut add = |what: &str, share, required, stretch| {
        rows.push(row(
            format!("two effects (9 % each): {what}"),
            share,
            AtLeast(required),
            AtLeast(stretch),
        ));
    };
    add("exact pair found by the search", Share::of(pairs, found), 0.7, 0.8);
    add("verdict pair, and exact", Share::of(pairs, said), 0.5, 0.7);
    add("first-ranked is one of them", Share::of(pairs, is_first), 0.85, 0.95);
}

fn less_data(rows: &mut Vec<Score>, one: &[Answered<'_>], vertical: &[Answered<'_>]) {
    use Target::AtLeast;
    let label = |what: &str| format!("one intruder, no spin (8 %): {what}");
    rows.push(row(label("ranked first"), Share::of(one, is_first), AtLeast(0.65), AtLeast(0.8)));
    rows.push(row(
        label("unique and right"),
        Share::of(one, is_right),
        AtLeast(0.55),
        AtLeast(0.7),
    ));
    let label = |what: &str| format!("vertical only (8 %): {what}");
    let first = Share::of(vertical, is_first);
    rows.push(row(label("ranked first"), first, AtLeast(0.85), AtLeast(0.95)));
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
    rows.push(row(label("untestable effects refused"), share, AtLeast(1.0), AtLeast(1.0)));
}

fn scalars(rows: &mut Vec<Score>, scalars: &[Answered<'_>]) {
    use Target::AtLeast;
    let first = [(0.65, 0.70), (0.8, 0.85), (0.9, 0.95)];
    for (strength, (required, stretch)) in STRENGTHS.into_iter().zip(first) {
        let here = at_strength(scalars, strength);
        let label = |what: &str| format!("scalars only, {}: {what}", percent(strength));
        let share = Share::of(&here, is_first);
        rows.push(row(label("ranked first"), share, AtLeast(required), AtLeast(stretch)));
        let share = Share::of(&here, is_among_leaders);
        rows.push(row(label("not separable from the first"), share, AtLeast(0.9), AtLeast(0.95)));
        let sizes: Vec<f64> = here.iter().map(|(_, answer)| answer.leaders.len() as f64).collect();
        rows.push(spread(label("size of that set"), &sizes, [Target::None; 2]));
    }
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
        rows.push(row(metric, share, Target::None, Target::None));
    }
    for (name, low, least) in [("halved", true, 0.95), ("doubled", false, 0.4)] {
        let share = here(beds, &|trial| (trial.plan.design.path_scatter < 0.12) == low);
        let metric = format!("scatter of the bed {name} (8 %): ranked first");
        rows.push(row(metric, share, Target::AtLeast(least), Target::None));
    }
    for runs in [2, 5] {
        let share = here(repeats, &|trial| trial.plan.design.repeats == runs);
        let metric = format!("{runs} runs of each condition (8 %): ranked first");
        rows.push(row(metric, share, Target::None, Target::None));
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
    let within = [Target::Within(0.97, 1.03), Target::None];
    rows.push(spread("amplitude over the hidden one, where named right".into(), &ratios, within));
    let covered = Share::of(&comparable, |(q, se, truth)| (q - truth).abs() <= 1.96 * se);
    let target = Target::Within(0.92, 0.98);
    rows.push(row(
        "amplitude: 95 % intervals that hold the truth".into(),
        covered,
        target,
        Target::None,
    ));
    let targets = [(0.30, 0.15), (0.15, 0.08), (0.12, 0.06)];
    for (strength, (required, stretch)) in STRENGTHS.into_iter().zip(targets) {
        let here = at_strength(singles, strength);
        let ratios: Vec<f64> = here
            .iter()
            .filter_map(|(_, answer)| answer.endpoint.map(|[before, after]| after / before))
            .collect();
        let metric = format!(
            "held-out resting points, error with / without what is named, {}",
            percent(strength)
        );
        rows.push(spread(metric, &ratios, [Target::AtMost(required), Target::AtMost(stretch)]));
    }
}

fn next(rows: &mut Vec<Score>, extended: &[Answered<'_>]) {
    let unseparated: Vec<Resolved> =
        extended.iter().filter_map(|(_, answer)| answer.resolved).collect();
    let label = |what: &str| format!("several effects left (8 %): {what}");
    for (at, number) in ["one", "two"].into_iter().enumerate() {
        let by_both = [
            Share::of(&unseparated, |one| one.recommended[at]),
            Share::of(&unseparated, |one| one.drawn[at]),
        ];
        // Unresolved sets halved, by two.
        let target = if at == 1 { Target::AtLeast(0.5) } else { Target::None };
        for (share, (which, target)) in
            by_both.into_iter().zip([("recommended", target), ("drawn", Target::None)])
        {
            let what = format!("truth alone after {number} {which}");
            rows.push(row(label(&what), share, target, Target::None));
        }
        let one_alone: Vec<&Resolved> =
            unseparated.iter().filter(|one| one.recommended[at] != one.drawn[at]).collect();
        let share = Share::of(&one_alone, |one| one.recommended[at]);
        let p = mcnemar(share.hits, share.n - share.hits);
        let what = format!("after {number}, resolved by the recommended alone (McNemar p {p:.3})");
        rows.push(row(label(&what), share, Target::None, Target::None));
    }
}

pub(super) fn at_strength<'a>(all: &[Answered<'a>], strength: f64) -> Vec<Answered<'a>> {
    let here = |(trial, _): &Answered<'_>| trial.plan.strength.total_cmp(&strength).is_eq();
    all.iter().copied().filter(here).collect()
}

fn row(metric: String, share: Share, required: Target, stretch: Target) -> Score {
    Score { metric, measured: Measured::Share(share), required, stretch }
}

fn spread(metric: String, values: &[f64], [required, stretch]: [Target; 2]) -> Score {
    let at = |share| quantile(values, share);
    let quartiles = at(0.25).zip(at(0.5)).zip(at(0.75)).map(|((a, b), c)| [a, b, c]);
    let measured = Measured::Spread { quartiles, n: values.len() };
    Score { metric, measured, required, stretch }
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_is_met_when_the_interval_reaches_it() {
        // 6 of 10: 0.31 to 0.83.
        let share = Measured::Share(Share { hits: 6, n: 10 });
        assert_eq!(Target::AtLeast(0.8).is_met(&share), Some(true));
        assert_eq!(Target::AtLeast(0.9).is_met(&share), Some(false));
        assert_eq!(Target::AtMost(0.3).is_met(&share), Some(false));
        assert_eq!(Target::Within(0.2, 0.3).is_met(&share), Some(false));
        assert_eq!(Target::AtLeast(0.0).is_met(&Measured::Share(Share::default())), None);
        let spread = Measured::Spread { quartiles: Some([0.1, 0.2, 0.9]), n: 3 };
        assert_eq!(Target::AtMost(0.2).is_met(&spread), Some(true));
        assert_eq!(Target::None.is_met(&spread), None);
    }
}
