//! The benchmark as one JSON object.

use serde_json::{Value, json};

use super::calibration::{Bin, rows};
use super::scores::{Measured, Reached, Score, Target, scores};
use super::trial::{Answer, Outcome, Trial};

/// Scores, calibration and every trial.
pub fn report(trials: &[Trial], bins: &[Bin]) -> Value {
    let mut all = scores(trials);
    all.extend(rows(bins));
    let scores: Vec<Value> = all.iter().map(score).collect();
    let trials: Vec<Value> = trials.iter().map(trial).collect();
    json!({ "scores": scores, "trials": trials })
}

fn score(row: &Score) -> Value {
    let measured = match &row.measured {
        Measured::Share(share) => json!({
            "share": share.value(), "hits": share.hits, "n": share.n, "interval": share.interval(),
        }),
        Measured::Spread { quartiles, median, n } => {
            json!({ "quartiles": quartiles, "interval_of_median": median, "n": n })
        }
    };
    json!({
        "metric": row.metric,
        "measured": measured,
        "target": target(row.target),
        "reached": row.target.reached(&row.measured).map(|reached| match reached {
            Reached::Met => "met",
            Reached::NotShown => "not-shown",
            Reached::Missed => "missed",
        }),
    })
}

fn target(target: Target) -> Value {
    match target {
        Target::AtLeast(least) => json!({ "at_least": least }),
        Target::AtMost(most) => json!({ "at_most": most }),
        Target::Within(from, to) => json!({ "from": from, "to": to }),
        Target::None => Value::Null,
    }
}

fn trial(trial: &Trial) -> Value {
    let hidden: Vec<&str> = trial.plan.hidden.iter().map(|hidden| hidden.id()).collect();
    let outcome = match &trial.outcome {
        Outcome::Answered(answer) => said(answer),
        Outcome::Skipped(why) => json!({ "skipped": why }),
    };
    json!({
        "row": trial.plan.row.name(),
        "seed": trial.plan.seed,
        "hidden": hidden,
        "strength": trial.plan.strength,
        "outcome": outcome,
    })
}

fn said(answer: &Answer) -> Value {
    json!({
        "verdict": answer.verdict,
        "p1": answer.p1,
        "p_lof": answer.p_lof,
        "p_lof_with": answer.p_lof_with,
        "ranked": answer.ranked.iter().take(4).collect::<Vec<_>>(),
        "not_separable_from_first": answer.leaders,
        "named": answer.named,
        "predicted_first": answer.predicted_first,
        "q_of_first": answer.amplitude.map(|(q, se)| json!({ "q": q, "se": se })),
        "q_hidden": answer.hidden,
        "resting_error_m": answer.endpoint,
        "pair_found": answer.pair,
        "truth_alone": answer.resolved.map(|resolved| json!({
            "after_recommended": resolved.recommended, "after_spread": resolved.spread,
            "after_drawn": resolved.drawn,
        })),
        "cost": { "wall_s": answer.seconds },
    })
}
