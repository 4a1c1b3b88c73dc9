//! `plunge compare`: revisions of a model against measurements; `compare_runs` has a run against a run.

use std::path::PathBuf;

use diagnosis::compare::{Comparison, ModelComparison, Revision, compare};
use diagnosis::forward::Forward;
use diagnosis::misfit::residual::Residual;
use diagnosis::observed::error_columns::named;
use diagnosis::picture;
use measurements::{Axis, MeasurementSet};
use reports::tables;
use serde_json::{Value, json};

use crate::beds::{self, Beds, Workshop};
use crate::compare_runs::{self, Found};
use crate::output::{self, CommandError, CommandResult};
use crate::report;
use crate::table_file;
use crate::text::{lines, noise_words, shown, table};
use crate::verdict;
use crate::workbench::{Flags, failed};

/// Arguments of `plunge compare`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A measurement set: its folder, or its measurement.toml. Or the folder of a run.
    #[arg(value_name = "SET|RUN_A")]
    first: PathBuf,
    /// The folder of the run to compare with RUN_A.
    #[arg(value_name = "RUN_B")]
    second: Option<PathBuf>,
    /// A model file or the name of a shipped model; repeatable. Without it, the baseline that the set
    /// names.
    #[arg(long = "model", value_name = "MODEL")]
    models: Vec<PathBuf>,
    #[command(flatten)]
    flags: Flags,
    #[command(flatten)]
    beds: Beds,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let flags = &args.flags;
    table_file::refuse(&args.first)?;
    args.second.iter().try_for_each(|second| table_file::refuse(second))?;
    match (compare_runs::what_is(&args.first), &args.second) {
        (Found::Run, Some(_)) if !args.models.is_empty() => {
            return Err(CommandError::bad_input(
                "--model goes with a measurement set, not with runs",
            ));
        }
        (Found::Run, Some(second)) => return compare_runs::run([&args.first, second], flags),
        (Found::Run, None) => {
            return Err(CommandError::bad_input(format!(
                "{} is a run; name the run to compare it with, as in `plunge compare RUN_A RUN_B`",
                args.first.display()
            )));
        }
        (Found::NoRun(why), _) => return Err(CommandError::bad_input(why)),
        (Found::Other, Some(second)) => {
            return Err(CommandError::bad_input(format!(
                "{} is no run, so that {} is one argument too many; models go with --model",
                args.first.display(),
                second.display()
            )));
        }
        (Found::Other, None) => {}
    }
    if let Some(flag) = args.beds.flag_of_ranking() {
        return Err(CommandError::bad_input(format!(
            "{flag} belongs to `plunge diagnose`: a comparison ranks no candidates and runs every condition"
        )));
    }
    let measured = flags.measured(&args.first, &args.models)?;
    let models = flags.models(&args.models, &measured)?;
    let measured = flags.answerable(measured, &models)?;
    let mut workshop = Workshop::new(&args.beds, flags)?;
    if args.beds.plan {
        return workshop.plan_of_comparison(&models, &measured);
    }
    let mut forwards: Vec<Box<dyn Forward>> = Vec::with_capacity(models.len());
    let mut floors = Vec::with_capacity(models.len());
    for model in &models {
        match model.loaded.model.grains() {
            Some(_) => {
                let bed = workshop.forward(model, &measured)?;
                floors.push(Some((bed.scatter(&measured.set), bed.noise_floor())));
                forwards.push(Box::new(bed));
            }
            None => {
                floors.push(None);
                forwards.push(Box::new(model.forward_before_stated_apparatus(&measured, flags)?));
            }
        }
    }
    let revisions: Vec<Revision<'_>> = models
        .iter()
        .zip(&forwards)
        .map(|(model, forward)| Revision { name: &model.name, forward: &**forward })
        .collect();
    let results = flags.results(&measured, "compare", &models)?;
    let comparison = compare(&measured.set, &measured.observed, &revisions, flags.seed)
        .map_err(|failure| failed(failure.error, &failure.model))?;
    flags.notes(&comparison.notes);
    let mut object = serde_json::to_value(&comparison).map_err(anyhow::Error::new)?;
    for (at, (scatter, floor)) in
        floors.iter().enumerate().filter_map(|(at, f)| Some((at, f.as_ref()?)))
    {
        object["models"][at]["bed"] = json!({ "scatter": scatter, "noise_floor": floor });
    }
    let figure = picture::comparison(&measured.set, &comparison)
        .map_err(|error| CommandError::Failed(error.into()))?;
    let mut files = vec![("comparison.json".to_owned(), format!("{object:#}\n"))];
    files.extend(figure.map(|figure| ("comparison.svg".to_owned(), figure)));
    let where_it_fails = comparison.where_it_fails(&measured.set, &measured.observed);
    files.extend(where_it_fails.files().map_err(anyhow::Error::new)?);
    files.extend(report::of_results(&files, flags.quiet));
    results.write(&files)?;
    match flags.json {
        true => output::json_to_stdout(&object),
        false => {
            let n = [&measured.observed.fit, &measured.observed.holdout].map(Vec::len);
            let mut text = as_text(&measured.set, (&comparison, &object), n);
            text.push_str(&beds::floors(&comparison, &object));
            text.push_str(&results.told(&files));
            output::to_stdout(&text)
        }
    }
}

/// Most numbers that are listed one by one.
const MOST_NUMBERS: usize = 24;

fn as_text(
    set: &MeasurementSet,
    (comparison, object): (&Comparison, &Value),
    [n_fit, n_holdout]: [usize; 2],
) -> String {
    let mut text = format!(
        "{}: {n_fit} conditions to fit, {n_holdout} held out; errors {}\n\n",
        comparison.set,
        noise_words(&comparison.noise)
    );
    let models = object["models"].as_array().map_or(&[][..], Vec::as_slice);
    text.push_str("root mean square errors\n");
    text.push_str(&shown(&tables::errors(models)));
    text.push_str(&numbers(set, &comparison.models));
    let refitted = tables::parameters(models);
    if !refitted.is_empty() {
        text.push_str(&format!("\nparameters, refitted\n{}", shown(&refitted)));
    }
    for model in models {
        let seen = verdict::seen(&model["apparatus"]);
        if !seen.is_empty() {
            let name = model["model"].as_str().unwrap_or_default();
            text.push_str(&format!("\nApparatus by {name}: {}.\n", seen.join(", ")));
        }
    }
    text.push_str("\nwhere the force is wrong (significant at a false-discovery rate of 5 %)\n");
    let failures = tables::failures(models);
    text.push_str(&if failures.is_empty() { " nowhere\n".to_owned() } else { shown(&failures) });
    text
}

/// Scalars beside their predictions; sets of many conditions have them in the picture alone.
fn numbers(set: &MeasurementSet, models: &[ModelComparison]) -> String {
    let Some(first) = models.first() else { return String::new() };
    let is_scalar = |one: &Residual| one.observable.is_scalar();
    let n = first.failing.residuals.iter().filter(|one| is_scalar(one)).count();
    if n == 0 || n > MOST_NUMBERS {
        return String::new();
    }
    let mut header = vec!["condition", "speed (m/s)", "angle (deg)", "", "measured"];
    header.extend(models.iter().map(|model| model.model.as_str()));
    let mut table = table(&header);
    for (place, one) in first.failing.residuals.iter().enumerate().filter(|(_, one)| is_scalar(one))
    {
        let condition = &set.conditions[one.condition];
        let Axis { name, unit, scale } = named(one.observable);
        let mut row = vec![
            condition.id.clone(),
            format!("{}", condition.speed),
            format!("{}", condition.angle_deg),
            name.to_owned(),
            format!("{:.1} {unit}", scale * one.measured),
        ];
        row.extend(models.iter().map(|model| {
            let predicted = model.failing.residuals[place].predicted;
            let error = 100.0 * (predicted / one.measured - 1.0);
            match error.is_finite() {
                true => format!("{:.1} ({error:+.0} %)", scale * predicted),
                false => format!("{:.1}", scale * predicted),
            }
        }));
        table.add_row(row);
    }
    format!("\nmeasured and predicted\n{}", lines(&table))
}
