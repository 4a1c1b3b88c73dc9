//! `plunge diagnose SET --after OLD_DIAGNOSIS.json`: what was expected of new runs, and what came.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use configs::printable;
use diagnosis::diagnose::diagnose;
use diagnosis::fit::problem::FitProblem;
use diagnosis::next::{FollowUp, follow_up};
use diagnosis::observed::Observed;
use measurements::{MeasurementSet, Run};
use reports::tables;
use serde::Deserialize;
use serde_json::Value;

use crate::output::CommandError;
use crate::text::shown;
use crate::workbench::{Candidate, Flags, Measured, failed};

/// What is read of an earlier diagnosis.
#[derive(Deserialize)]
struct Earlier {
    /// Names of the runs that it rests on, by condition.
    measured: BTreeMap<String, Vec<String>>,
}

/// The runs of `measured` that the diagnosis in `path` does not rest on, held against what `model` expected of them when
/// it knew only the others; `None` if no effect can say what they would be.
///
/// # Errors
/// If the file is no diagnosis, the set lacks a run that it rests on or has no other, or a model fails.
pub(crate) fn held_against(
    path: &Path,
    measured: &Measured,
    model: &Candidate,
    flags: &Flags,
) -> Result<Option<FollowUp>, CommandError> {
    let (earlier, later) = parted(path, &measured.set)?;
    let (observed, new) = (Observed::of(&earlier), Observed::of(&later));
    let forward = model.forward_of(&earlier, &observed)?;
    let before = model.forward_of(&later, &new)?;
    let problem = FitProblem { set: &earlier, observed: &observed, forward: &forward };
    let diagnosis = diagnose(&problem, flags.seed).map_err(|error| failed(error, &model.name))?;
    follow_up(&problem, &diagnosis, (&new, &before))
        .map_err(|error| failed(error.into(), &model.name))
}

/// The set with the runs that the diagnosis in `path` rests on, and with all others.
fn parted(
    path: &Path,
    set: &MeasurementSet,
) -> Result<(MeasurementSet, MeasurementSet), CommandError> {
    let shown = printable(&path.display().to_string());
    let bad = |why: String| CommandError::BadInput(format!("error: --after {shown}: {why}\n"));
    let text = fs::read_to_string(path).map_err(|error| bad(error.to_string()))?;
    let earlier: Earlier = serde_json::from_str(&text).map_err(|error| {
        bad(format!(
            "this is not the diagnosis.json of `plunge diagnose`, which lists the runs that it rests on: {error}"
        ))
    })?;
    let known: BTreeSet<(&str, &str)> = earlier
        .measured
        .iter()
        .flat_map(|(id, runs)| runs.iter().map(|run| (id.as_str(), run.as_str())))
        .collect();
    let key = |run: &Run| {
        let Run { condition, name, .. } = run;
        (set.conditions[*condition].id.clone(), name.clone())
    };
    let here: BTreeSet<(String, String)> = set.runs.iter().map(key).collect();
    let is_here =
        |(id, name): &&(&str, &str)| here.contains(&((*id).to_owned(), (*name).to_owned()));
    if let Some((id, name)) = known.iter().find(|one| !is_here(one)) {
        return Err(bad(format!(
            "it rests on run `{}` of condition `{}`, which the set has not: keep the earlier runs in the set and put \
             the new ones beside them",
            printable(name),
            printable(id)
        )));
    }
    let with = |is_known: bool| {
        let mut part = set.clone();
        part.runs.retain(|run| {
            let (id, name) = key(run);
            known.contains(&(id.as_str(), name.as_str())) == is_known
        });
        part
    };
    let later = with(false);
    if later.runs.is_empty() {
        return Err(
            bad("it rests on every run of the set: add the new runs to the set".to_owned()),
        );
    }
    Ok((with(true), later))
}

/// `sequel`, which the JSON `object` of its diagnosis holds, as `plunge diagnose` prints it.
pub(crate) fn as_text(follow_up: &FollowUp, object: &Value) -> String {
    let after = &object["after"];
    let told = match follow_up.hypotheses.len() {
        1 => String::new(),
        _ if follow_up.is_unexpected => String::new(),
        _ => format!("They tell {:.2} bit of which it is.\n", follow_up.told_bits),
    };
    let unexpected = match follow_up.is_unexpected {
        true => format!(
            "No hypothesis expected this: even the nearest misses by more than chance does (p {:.1e}).\n",
            follow_up.p_nearest
        ),
        false => String::new(),
    };
    format!(
        "\nNEW RUNS  measured, and as expected from the earlier ones:\n{}\n{}{told}{unexpected}",
        shown(&tables::new_runs(after)),
        shown(&tables::hypotheses(after))
    )
}
