//! `plunge diagnose`: which effect a model lacks.

use std::path::PathBuf;

use configs::edit::add_effects;
use diagnosis::calibrate::{Calibration, Size, calibrate};
use diagnosis::diagnose::{diagnose, seek_missing_force};
use diagnosis::fit::problem::FitProblem;
use diagnosis::missing_force::FOUND;
use diagnosis::next::recommend;
use diagnosis::verdict::{Diagnosis, Verdict};
use serde_json::{Value, json};

use crate::add::from_diagnosis;
use crate::after;
use crate::beds::{self, Beds};
use crate::next;
use crate::output::{self, CommandError, CommandResult};
use crate::table_file;
use crate::verdict::{as_text, calibration_as_text, write};
use crate::workbench::{CALIBRATION, Candidate, Flags, Measured, failed};

/// Arguments of `plunge diagnose`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A measurement set: its folder, or its measurement.toml.
    set: PathBuf,
    /// A model file or the name of a shipped model. Without it, the baseline that the set names.
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Simulate a hundred sets of the same design and say how often verdicts are right: some minutes.
    #[arg(long)]
    calibrate: bool,
    /// The diagnosis.json of an earlier diagnosis of this set: compares the runs added since with what it expected of them.
    #[arg(long, value_name = "OLD_DIAGNOSIS.json")]
    after: Option<PathBuf>,
    /// Seek the force that the model lacks, and a formula for it, whatever the verdict: some seconds. Of a bed of grains,
    /// the force alone.
    #[arg(long)]
    missing_force: bool,
    #[command(flatten)]
    flags: Flags,
    #[command(flatten)]
    beds: Beds,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let flags = &args.flags;
    table_file::refuse(&args.set)?;
    let measured = flags.measured(&args.set, args.model.as_slice())?;
    let models = flags.models(args.model.as_slice(), &measured)?;
    let measured = flags.answerable(measured, &models)?;
    let refused = |why: &str| Err(CommandError::bad_input(why));
    if models[0].loaded.model.grains().is_some() {
        return match (args.calibrate, &args.after) {
            (true, _) => refused(
                "--calibrate is of resistive-force models: sets of a bed of grains take hours to simulate",
            ),
            (_, Some(_)) => refused(
                "--after is of resistive-force models: an earlier diagnosis of a bed of grains is not taken up",
            ),
            _ => beds::diagnose(&args.beds, (flags, args.missing_force), &measured, &models),
        };
    }
    if let Some(flag) = args.beds.flag_of_impacts() {
        return refused(&format!(
            "{flag} is of beds of grains: with a resistive-force model every effect is ranked, in seconds"
        ));
    }
    match (args.beds.plan, flags.json) {
        (true, true) => {
            output::json_to_stdout(&json!({ "set": measured.set.id, "cost": { "impacts": 0 } }))
        }
        (true, false) => {
            output::to_stdout("a resistive-force model takes no impacts on beds: seconds\n")
        }
        _ => diagnose_law(args, &measured, &models),
    }
}

/// Of a resistive-force model.
fn diagnose_law(args: &Args, measured: &Measured, models: &[Candidate]) -> CommandResult {
    let (flags, model) = (&args.flags, &models[0]);
    let forward = model.forward(measured, flags)?;
    let follow_up = match &args.after {
        Some(path) => after::held_against(path, measured, model, flags)?,
        None => None,
    };
    let results = flags.results(measured, "diagnose", models)?;
    let problem =
        FitProblem { set: &measured.set, observed: &measured.observed, forward: &forward };
    let mut diagnosis =
        diagnose(&problem, flags.seed).map_err(|error| failed(error, &model.name))?;
    if args.missing_force {
        seek_missing_force(&problem, &mut diagnosis).map_err(|error| failed(error, &model.name))?;
    }
    let next = recommend(&problem, &model.loaded.model, &mut diagnosis);
    flags.notes(&measured.set.notes);
    flags.notes(&measured.observed.notes);
    let calibration: Option<Calibration> = match args.calibrate {
        // Sets that were simulated for the same inputs are not simulated again.
        false => {
            results.written_before(CALIBRATION).and_then(|text| serde_json::from_str(&text).ok())
        }
        true => {
            let found = calibrate(&problem, &diagnosis, Size::default(), flags.seed);
            Some(found.map_err(|error| failed(error, &model.name))?)
        }
    };
    if let Some(calibration) = &calibration {
        diagnosis.probability = Some(calibration.probability(&diagnosis));
    }
    if let Some(follow_up) = &follow_up {
        diagnosis.after = Some(serde_json::to_value(follow_up).map_err(anyhow::Error::new)?);
    }
    let object = diagnosis.to_json().map_err(anyhow::Error::new)?;
    let text = format!("{object:#}\n");
    let mut files = propose(model, &object, &diagnosis)?;
    files.insert(0, ("diagnosis.json".to_owned(), text.clone()));
    let counted = calibration.as_ref().map(|all| json!({ "rows": all.rows(), "sets": all.sets }));
    if let Some(object) = &counted {
        files.push((CALIBRATION.to_owned(), format!("{object:#}\n")));
    }
    write(&mut files, (&problem, &model.name, &diagnosis), flags, &results)?;
    if flags.json {
        return output::to_stdout(&text);
    }
    let n = [&measured.observed.fit, &measured.observed.holdout].map(Vec::len);
    let mut text = as_text(&model.name, (&diagnosis, &object), n);
    if let (Some(calibration), Some(counted)) = (&calibration, &counted) {
        text.push_str(&calibration_as_text(calibration, counted));
    }
    if let Some(follow_up) = &follow_up {
        text.push_str(&after::as_text(follow_up, &object));
    }
    if let Some(next) = &next {
        text.push_str(&next::as_text(next, &object));
    }
    text.push_str(&results.told(&files));
    output::to_stdout(&text)
}

fn has_formula(diagnosis: &Diagnosis) -> bool {
    diagnosis.missing_force.as_ref().is_some_and(|force| force.formula.is_some())
}

/// A model for each effect worth adding: names and texts of files.
fn propose(
    model: &Candidate,
    object: &Value,
    diagnosis: &Diagnosis,
) -> Result<Vec<(String, String)>, CommandError> {
    let mut proposals: Vec<Vec<&str>> = match diagnosis.verdict {
        Verdict::Supported | Verdict::Pair => {
            vec![diagnosis.effects.iter().map(String::as_str).collect()]
        }
        Verdict::NotSeparable => {
            diagnosis.not_separable.iter().map(|id| vec![id.as_str()]).collect()
        }
        _ => Vec::new(),
    };
    if has_formula(diagnosis) {
        proposals.push(vec![FOUND]);
    }
    proposals
        .into_iter()
        .map(|effects| {
            let addition = from_diagnosis(object, &effects)
                .map_err(|why| CommandError::Failed(anyhow::anyhow!(why)))?;
            let text = add_effects(&model.text, &addition)
                .map_err(|error| CommandError::Failed(anyhow::Error::new(error)))?;
            Ok((format!("model+{}.toml", effects.join("+")), text))
        })
        .collect()
}
