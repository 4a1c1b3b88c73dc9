//! A diagnosis as `plunge diagnose` prints it, and what is written with it.

use diagnosis::calibrate::Calibration;
use diagnosis::fit::problem::FitProblem;
use diagnosis::misfit::held_out::{Fails, LeftOut};
use diagnosis::missing_force::MissingForce;
use diagnosis::verdict::{Diagnosis, RankedEffect, Status, Verdict};
use diagnosis::where_it_fails::{WhereItFails, files_of};
use reports::tables;
use serde_json::Value;

use crate::output::CommandResult;
use crate::report;
use crate::text::{noise_words, probability, shown};
use crate::workbench::{Flags, Results, failed};

/// Adds to `files` where the model called `name` fails, and the page of all of them, and writes them to `results`.
pub(crate) fn write(
    files: &mut Vec<(String, String)>,
    (problem, name, diagnosis): (&FitProblem<'_>, &str, &Diagnosis),
    flags: &Flags,
    results: &Results,
) -> CommandResult {
    let where_it_fails = WhereItFails::of_diagnosis(problem, name, diagnosis, flags.seed)
        .map_err(|error| failed(error, name))?;
    if let Some(force) = &diagnosis.missing_force {
        files.extend(files_of(force, problem.set).map_err(anyhow::Error::new)?);
    }
    files.extend(where_it_fails.files().map_err(anyhow::Error::new)?);
    files.extend(report::of_results(files, flags.quiet));
    results.write(files)
}

/// All of it but what was found by running more impacts, and the next experiment.
pub(crate) fn as_text(
    model: &str,
    (diagnosis, object): (&Diagnosis, &Value),
    [n_fit, n_holdout]: [usize; 2],
) -> String {
    let claim = reports::claim_in_words(object);
    let mut text =
        format!("{claim}\n\nModel {model}: {n_fit} conditions to fit, {n_holdout} held out.");
    // Without a held-out error nothing was fitted.
    if !diagnosis.noise.is_null() {
        text.push_str(&format!(" Errors {}.", noise_words(&diagnosis.noise)));
    }
    text.push('\n');
    if let (Some(p1), Some(p_lof)) = (diagnosis.p1, diagnosis.p_lof) {
        let answer = match diagnosis.verdict.is_explained() {
            true if reports::explains_if_conditions_differ(object) => {
                "YES, IF CONDITIONS DIFFER AS POURINGS DO"
            }
            true => "YES",
            false => "NO",
        };
        text.push_str(&format!(
            "Does the model explain the data?  {}   p1 {}   lack of fit p {}\n",
            answer,
            probability(p1),
            probability(p_lof)
        ));
    }
    if !diagnosis.ranking.is_empty() {
        text.push('\n');
        text.push_str(&ranking(diagnosis, object));
    }
    if let Some(p) = diagnosis.p_lof_with {
        text.push_str(&format!("\nLack of fit with the best: p {}.\n", probability(p)));
    }
    text.push_str(&format!("\nVERDICT  {}\n", reports::verdict_in_words(object)));
    for force in reports::forces_in_words(object) {
        text.push_str(&format!("{force}\n"));
    }
    if let Some(probability) = reports::probability_in_words(object) {
        text.push_str(&format!("{probability}\n"));
    }
    if let Some(strength) = reports::strength_in_words(object) {
        text.push_str(&format!("{strength}\n"));
    }
    for warning in &diagnosis.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text.push_str(&apparatus(diagnosis.verdict, object));
    if !diagnosis.unexplained.hint.is_empty() {
        text.push_str(&format!("{}.\n", diagnosis.unexplained.hint));
    }
    if !diagnosis.unexplained.depends_on.is_empty() {
        let on = diagnosis.unexplained.depends_on.join(", ");
        text.push_str(&format!("What remains of the force depends on {on}.\n"));
    }
    if let Some(force) = &diagnosis.missing_force {
        text.push_str(&missing_force(force));
        if !diagnosis.effects.is_empty() {
            text.push_str("It is sought without any listed effect; the verdict stands.\n");
        }
    }
    text.push_str(&held_out(diagnosis));
    text
}

/// What force is missing, and the formula for it.
fn missing_force(force: &MissingForce) -> String {
    let mut text = format!("\nMissing force ({}): {}.\n", force.file, force.words);
    let (Some(formula), Some(q), Some(held_out)) = (&force.formula, force.q, &force.holdout) else {
        return match force.formula_sought {
            true => text + "No formula of the library predicts what was held out.\n",
            false => text,
        };
    };
    let se = force.se.map_or(String::new(), |se| format!(" \u{b1} {se:.3}"));
    text.push_str(&format!(
        "A formula that fits and predicts; not an explanation:\n  {formula}\n  q = {q:.4}{se}\n"
    ));
    if let (Some(before), Some(after), Some(floor)) =
        (held_out.before, held_out.after, held_out.noise_floor)
    {
        let [before, after, floor] = [before, after, floor].map(|error| held_out.unit.told(error));
        text.push_str(&format!(
            "Error on conditions that were not fitted to: {before} without it, {after} with it (noise of the means {floor}).\n"
        ));
    }
    text + "`plunge add MODEL --from diagnosis.json --effect found -o NEW.toml` makes it a part of the model.\n"
}

fn ranking(diagnosis: &Diagnosis, object: &Value) -> String {
    let ranked = || diagnosis.ranking.iter().filter(|effect| effect.status == Status::Ranked);
    let mut text = shown(&tables::ranking(object));
    if !diagnosis.effects.is_empty() {
        text.push_str(" q and se are of each effect alone, in the form that fits best.\n");
    }
    let alike = |effect: &&RankedEffect| diagnosis.not_separable.contains(&effect.id);
    for effect in ranked().filter(alike).filter(|effect| !effect.note.is_empty()) {
        text.push_str(&format!(" separable: {} {}\n", effect.id, effect.note));
    }
    for effect in diagnosis.ranking.iter().filter(|effect| effect.status != Status::Ranked) {
        let what = match effect.status {
            Status::NotIntegrated => "could not be computed",
            Status::Imitated => "imitated by the parameters",
            Status::NotTestable | Status::NotTested | Status::Ranked => "not testable",
        };
        text.push_str(&format!(" {what}: {} ({})\n", effect.id, effect.note));
    }
    for effect in ranked().filter(|effect| !effect.form.is_empty() && effect.delta > Some(0.0)) {
        let form = effect.form.iter().map(|(key, value)| format!("{key} = {value}"));
        let form = form.collect::<Vec<_>>().join(", ");
        text.push_str(&format!(" in another form: {} with {form}\n", effect.id));
    }
    for effect in ranked().filter(|effect| effect.unusual && effect.delta > Some(0.0)) {
        let (q, [least, most]) = (effect.q.unwrap_or(0.0), effect.usual_range.unwrap_or_default());
        let id = &effect.id;
        text.push_str(&format!(" unusual: {id} of {q:.4}, where {least} to {most} is usual\n"));
    }
    text
}

/// Errors of the apparatus that are seen, whether they are larger than expected or not.
fn apparatus(verdict: Verdict, object: &Value) -> String {
    let shared = |key: &str, name: &str| {
        let seen = seen(&object[key]);
        match seen.is_empty() {
            true => String::new(),
            false => format!("{name}: {}; no effect is credited with these.\n", seen.join(", ")),
        }
    };
    let apparatus = match verdict {
        Verdict::NoneOfTheCandidates | Verdict::BelowNoise => {
            "Apparatus, in a model that does not explain the data"
        }
        _ => "Apparatus",
    };
    shared("preparation", "Preparation") + &shared("apparatus", apparatus)
}

/// Those of `errors` that are three standard errors away from zero.
pub(crate) fn seen(errors: &Value) -> Vec<String> {
    let errors = errors.as_array().map_or(&[][..], Vec::as_slice);
    let is_seen = |error: &&Value| {
        let [value, se] = ["value", "se"].map(|key| error[key].as_f64());
        se.is_some_and(|se| value.unwrap_or(0.0).abs() >= 3.0 * se)
    };
    errors.iter().filter(is_seen).map(reports::apparatus_error).collect()
}

fn held_out(diagnosis: &Diagnosis) -> String {
    let (Some(held_out), false) = (&diagnosis.holdout, diagnosis.amplitudes.is_empty()) else {
        return String::new();
    };
    let shown = |error: f64| held_out.unit.told(error);
    let which = match held_out.conditions {
        LeftOut::Holdout => "held-out conditions",
        LeftOut::OneAtATime => "conditions left out one at a time (the set holds out none)",
        LeftOut::HoldoutAndOneAtATime => {
            "held-out conditions, which show nothing, and the others left out one at a time"
        }
    };
    let errors = (held_out.before, held_out.after, held_out.noise_floor);
    let explained = match held_out.explained {
        Some(share) => format!("; {:.0} % of what exceeds noise is explained", 1e2 * share),
        None => String::new(),
    };
    let mut text = match errors {
        (Some(before), Some(after), Some(floor)) => format!(
            "Error on {which}: {} before, {} after (noise of the means {}){explained}.\n",
            shown(before),
            shown(after),
            shown(floor)
        ),
        _ => format!("No error on {which}: none could be predicted both without and with it.\n"),
    };
    let all = held_out.conditions_judged + held_out.not_predicted.len();
    for one in &held_out.not_predicted {
        let by = match one.by {
            Fails::Before => "without it",
            Fails::After => "with it",
            Fails::Both => "either way",
        };
        let (id, why) = (&one.condition, &one.why);
        text.push_str(&format!("Not predicted {by}, 1 of {all} and in no error: {id} ({why}).\n"));
    }
    text
}

/// How often verdicts are right before sets of this design, as its JSON `object` has it.
pub(crate) fn calibration_as_text(calibration: &Calibration, object: &Value) -> String {
    let covered: Vec<bool> = calibration.sets.iter().filter_map(|set| set.covered).collect();
    let holding = covered.iter().filter(|holds| **holds).count();
    format!(
        "\nOf {} simulated sets of this design:\n{}95 % intervals that hold the true amplitude: {holding} of {}.\n",
        calibration.sets.len(),
        shown(&tables::calibration(object)),
        covered.len()
    )
}
