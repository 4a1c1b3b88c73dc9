//! The tables of the benchmark, as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::calibration::Bin;
use super::hidden::{FORMS, Hidden, Kinship};
use super::interval::quantile;
use super::peers::PEERS;
use super::plan::{Row, STRENGTHS};
use super::scores::{Measured, Reached, Score, Target, at_strength, is_first, percent};
use super::trial::{Outcome, Trial};
use super::{calibration, scores};

/// Everything that was measured in `trials`.
pub fn report(trials: &[Trial], bins: &[Bin]) -> String {
    let mut rows = scores::scores(trials);
    rows.extend(calibration::rows(bins));
    let mut text = summary(trials);
    text.push_str("\n### Scores\n\n");
    text.push_str(&score_table(&rows));
    text.push_str("\n### Truth ranked first, by effect\n\n");
    text.push_str(&by_effect(trials));
    text.push_str("\n### Verdicts on what is outside the list\n\n");
    text.push_str(&by_unlisted(trials));
    text.push_str("\n### Formulas of missing forces\n\n");
    text.push_str(&formulas(trials));
    text.push_str("\n### Other methods\n\n");
    text.push_str(&peers());
    text
}

/// What can be hidden, and how its law stands to the candidate of the same name.
pub fn worlds() -> String {
    let rows = FORMS.iter().map(|form| {
        let kinship = match form.kinship {
            Kinship::Same => "the same",
            Kinship::Other => "another",
            Kinship::Unlisted => "in no list",
        };
        [form.id.to_owned(), form.law.to_owned(), kinship.to_owned()]
    });
    table(["hidden", "law in the world", "form of the candidate"], rows)
}

/// The rows, each with its interval (of a spread, that of the median), its target and what became of it.
pub fn score_table(rows: &[Score]) -> String {
    let cells = rows.iter().map(|row| {
        let (value, n, interval) = match &row.measured {
            Measured::Share(share) => {
                let [low, high] = share.interval();
                let value = share.value().map_or("-".to_owned(), |value| format!("{value:.2}"));
                (value, share.n, format!("{low:.2} to {high:.2}"))
            }
            Measured::Spread { quartiles, median, n } => {
                let middle =
                    quartiles.map_or("-".to_owned(), |[_, middle, _]| format!("{middle:.3}"));
                let ends = |[low, high]: [f64; 2]| format!("{low:.3} to {high:.3}");
                (middle, *n, median.map_or("-".to_owned(), ends))
            }
        };
        let reached = match row.target.reached(&row.measured) {
            Some(Reached::Met) => "met",
            Some(Reached::NotShown) => "not shown",
            Some(Reached::Missed) => "**missed**",
            None => "-",
        };
        [row.metric.clone(), value, n.to_string(), interval, target(row.target), reached.to_owned()]
    });
    table(["metric", "measured", "n", "95 % interval", "target", ""], cells)
}

fn target(target: Target) -> String {
    match target {
        Target::AtLeast(least) => format!("≥ {least:.2}"),
        Target::AtMost(most) => format!("≤ {most:.2}"),
        Target::Within(from, to) => format!("{from:.2} to {to:.2}"),
        Target::None => "-".to_owned(),
    }
}

fn summary(trials: &[Trial]) -> String {
    let answers: Vec<_> = trials.iter().filter_map(Trial::answer).collect();
    let seconds: Vec<f64> = answers.iter().map(|answer| answer.seconds).collect();
    let mut text = format!("{} sets were drawn and {} diagnosed", trials.len(), answers.len());
    if let Some(median) = quantile(&seconds, 0.5) {
        let _ = write!(text, ", in {median:.2} s each at the median (all threads busy)");
    }
    text.push_str(".\n");
    let mut skipped: BTreeMap<&str, usize> = BTreeMap::new();
    for trial in trials {
        if let Outcome::Skipped(why) = &trial.outcome {
            *skipped.entry(why).or_default() += 1;
        }
    }
    for (why, count) in skipped {
        let _ = writeln!(text, "{count} left out: {why}.");
    }
    text
}

fn by_effect(trials: &[Trial]) -> String {
    let answered: Vec<_> = trials
        .iter()
        .filter(|trial| trial.plan.row == Row::Singles)
        .filter_map(|trial| Some((trial, trial.answer()?)))
        .collect();
    let rows = Hidden::listed().filter_map(|hidden| {
        let mut cells =
            [hidden.id().to_owned(), String::new(), String::new(), String::new(), String::new()];
        let mut instead: BTreeMap<&str, usize> = BTreeMap::new();
        let mut any = false;
        for (level, strength) in STRENGTHS.into_iter().enumerate() {
            let mut here = at_strength(&answered, strength);
            here.retain(|(trial, _)| trial.hides(hidden.id()));
            any |= !here.is_empty();
            let hits = here.iter().filter(|one| is_first(one)).count();
            cells[1 + level] = format!("{hits}/{}", here.len());
            for (_, answer) in here.iter().filter(|one| !is_first(one)) {
                let first = answer.ranked.first().map_or("-", String::as_str);
                *instead.entry(first).or_default() += 1;
            }
        }
        let instead = instead.iter().map(|(id, count)| format!("{id} {count}"));
        cells[4] = instead.collect::<Vec<_>>().join(", ");
        any.then_some(cells)
    });
    let [low, middle, high] = STRENGTHS.map(percent);
    table(["hidden", &low, &middle, &high, "ranked first instead"], rows)
}

fn by_unlisted(trials: &[Trial]) -> String {
    let rows = Hidden::unlisted().filter_map(|hidden| {
        let mut verdicts: BTreeMap<String, usize> = BTreeMap::new();
        for trial in trials {
            if trial.plan.row != Row::Unlisted || !trial.hides(hidden.id()) {
                continue;
            }
            if let Some(answer) = trial.answer() {
                let named = answer.named.join(" + ");
                let verdict = format!("{:?} {named}", answer.verdict);
                *verdicts.entry(verdict.trim_end().to_owned()).or_default() += 1;
            }
        }
        let list: Vec<String> =
            verdicts.iter().map(|(verdict, count)| format!("{verdict} {count}")).collect();
        (!list.is_empty()).then(|| [hidden.id().to_owned(), list.join(", ")])
    });
    table(["hidden", "verdicts"], rows)
}

/// What is said of the missing force, set by set.
fn formulas(trials: &[Trial]) -> String {
    let of_row = trials.iter().filter(|trial| trial.plan.row == Row::Beyond);
    let rows = of_row.filter_map(|trial| {
        let missing = trial.answer()?.missing.as_ref()?;
        let hidden: Vec<&str> = trial.plan.hidden.iter().map(|one| one.id()).collect();
        let millimetres = |error: Option<f64>| match error {
            Some(error) => format!("{:.2}", 1e3 * error),
            None => "-".to_owned(),
        };
        let errors = missing.held_out.unwrap_or_default().map(millimetres);
        Some([
            hidden.join(" + "),
            percent(trial.plan.strength),
            missing.formula.as_deref().unwrap_or("none").replace("q * rho * g * A * D * ", ""),
            errors.join(" / "),
        ])
    });
    let head =
        ["hidden", "strength", "formula, over q ρ g A D", "held out, mm: without / with / noise"];
    table(head, rows)
}

fn peers() -> String {
    let rows = PEERS.iter().map(|peer| {
        [
            peer.method.to_owned(),
            peer.first.join(" / "),
            peer.selected.to_owned(),
            peer.nulls.to_owned(),
        ]
    });
    let head = ["method", "truth first, 6 / 12 %", "truth selected", "nothing hidden"];
    format!(
        "Measured on the sets of the study that this diagnosis follows, not on these sets.\n\n{}",
        table(head, rows)
    )
}

/// A Markdown table whose columns are aligned.
fn table<const N: usize>(head: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let rows: Vec<[String; N]> = rows.collect();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.fold(head[column].chars().count().max(3), usize::max)
    };
    let widths: [usize; N] = std::array::from_fn(width);
    let line = |cells: [&str; N]| {
        let mut line = String::from("|");
        for (cell, width) in cells.iter().zip(widths) {
            let _ = write!(line, " {cell}{} |", " ".repeat(width - cell.chars().count()));
        }
        line + "\n"
    };
    let rule = widths.map(|width| "-".repeat(width));
    let mut text = line(head);
    text.push_str(&line(std::array::from_fn(|column| rule[column].as_str())));
    for row in &rows {
        text.push_str(&line(std::array::from_fn(|column| row[column].as_str())));
    }
    text
}
