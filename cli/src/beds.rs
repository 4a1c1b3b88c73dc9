//! Beds of grains on the workbench: many impacts, a plan before them, and what they cost.

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::PathBuf;

use anyhow::Context as _;
use diagnosis::beds::{
    BedDiagnosis, BedError, BedForward, BedModel, Plan, Wish, bed_forward, compare_jobs,
    diagnose_bed, unaffordable,
};
use diagnosis::compare::Comparison;
use diagnosis::fit::problem::FitProblem;
use engine::units::{self, Dimension};
use runner::beds::{Impacts, Place};
use runner::{CampaignError, Elsewhere};
use serde_json::{Value, json};

use crate::common::{On, of_scheduler};
use crate::control::Terminal;
use crate::output::{self, CommandError, CommandResult};
use crate::report;
use crate::text::{lines, table};
use crate::verdict::{as_text, write};
use crate::workbench::{Candidate, Flags, Measured, Results, failed};

/// The flags of commands that run many impacts on beds of grains.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Beds {
    /// The folder of prepared beds and finished impacts, which are never run again.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Time to spend on impacts, such as "20 min": the largest plan that fits is chosen.
    #[arg(long, value_name = "TIME", value_parser = time)]
    budget: Option<f64>,
    /// Print which impacts would be run, and how long they would take; run nothing.
    #[arg(long)]
    pub(crate) plan: bool,
    /// Go on from impacts that have ended: the cache keeps them, and they are taken from it without this flag too.
    #[arg(long)]
    resume: bool,
    /// Make this candidate a parameter of the model: its change is fitted, not ranked. Repeatable.
    #[arg(long = "free", value_name = "CANDIDATE")]
    free: Vec<String>,
    /// Where impacts run. A scheduler gets those that are not in the cache; the command waits for it.
    #[arg(long, value_name = "WHERE", default_value = "local")]
    on: On,
    /// Rank this candidate only; repeatable. Candidates of the apparatus are left out unless they are named.
    #[arg(long = "candidate", value_name = "CANDIDATE")]
    candidates: Vec<String>,
}

impl Beds {
    /// The first given flag that says how impacts on beds are run or which candidates they are run for.
    pub(crate) fn flag_of_impacts(&self) -> Option<&'static str> {
        self.flag_of_ranking().or(self.on.scheduler().is_some().then_some("--on"))
    }

    /// The first given flag that says which candidates are ranked with how many impacts.
    pub(crate) fn flag_of_ranking(&self) -> Option<&'static str> {
        [
            ("--candidate", !self.candidates.is_empty()),
            ("--free", !self.free.is_empty()),
            ("--budget", self.budget.is_some()),
        ]
        .into_iter()
        .find_map(|(flag, is_given)| is_given.then_some(flag))
    }
}

pub(crate) fn time(text: &str) -> Result<f64, String> {
    let seconds = units::parse(text, Dimension::TIME).map_err(|error| error.to_string())?;
    match seconds > 0.0 {
        true => Ok(seconds),
        false => Err("a budget must be above zero".to_owned()),
    }
}

/// Where impacts are run, and whoever watches.
pub(crate) struct Workshop<'a> {
    flags: &'a Flags,
    cache: PathBuf,
    terminal: Terminal,
    elsewhere: Option<Elsewhere>,
}

impl<'a> Workshop<'a> {
    pub(crate) fn new(beds: &Beds, flags: &'a Flags) -> Result<Self, CommandError> {
        let cache = runner::cache_folder(beds.cache.as_deref());
        let elsewhere = beds.on.scheduler().map(Elsewhere::by).transpose();
        let elsewhere = elsewhere.context("cannot find this program")?;
        Ok(Self { flags, cache, terminal: Terminal::new(flags.quiet), elsewhere })
    }

    fn place(&self) -> Place<'_> {
        let workers = self.flags.threads.and_then(|n| NonZero::new(usize::from(n)));
        let elsewhere = self.elsewhere.as_ref();
        Place { cache: &self.cache, workers, watch: &self.terminal, elsewhere }
    }

    /// What a comparison would run.
    pub(crate) fn plan_of_comparison(
        &self,
        models: &[Candidate],
        measured: &Measured,
    ) -> CommandResult {
        let mut plans = Vec::new();
        for model in models.iter().filter(|model| model.loaded.model.grains().is_some()) {
            let bed_model = bed_model(model, measured)?;
            let jobs = compare_jobs(&bed_model, &measured.observed).map_err(|e| self.failed(e))?;
            let place = self.place();
            let left = place.outstanding(&jobs).map_err(|e| self.failed(e.into()))?;
            let rate = place.rate(bed_model.grains()).map_err(|e| self.failed(e.into()))?;
            plans.push(json!({
                "model": model.name,
                "impacts": jobs.len(),
                "to_run": left.impacts,
                "beds": left.beds,
                "estimated_s": (left.work / (rate * place.n_workers() as f64)).round(),
            }));
        }
        output::json_to_stdout(&json!({ "set": measured.set.id, "cost": { "plan": plans } }))
    }

    /// `model` before the set, all its impacts run.
    pub(crate) fn forward(
        &mut self,
        model: &Candidate,
        measured: &Measured,
    ) -> Result<BedForward, CommandError> {
        let bed_model = bed_model(model, measured)?;
        let forward = bed_forward(&bed_model, &measured.observed, &self.place());
        self.terminal.clear();
        forward.map_err(|error| self.failed(error))
    }

    fn failed(&self, error: BedError) -> CommandError {
        match error {
            BedError::Campaign(CampaignError::Interrupted) => {
                self.terminal.interrupted("what has ended is kept; the same command goes on")
            }
            BedError::BedModel(_) | BedError::UnknownCandidate { .. } => {
                CommandError::bad_input(error)
            }
            BedError::Campaign(CampaignError::Run(error)) => error.into(),
            BedError::Campaign(CampaignError::Scheduler(error)) => of_scheduler(error),
            BedError::FitProblem(error) => failed(error, "the bed"),
            other => CommandError::Failed(other.into()),
        }
    }
}

fn bed_model<'a>(
    model: &'a Candidate,
    measured: &'a Measured,
) -> Result<BedModel<'a>, CommandError> {
    BedModel::new(&model.loaded.model, &measured.set)
        .map_err(|error| CommandError::bad_input(format!("{}: {error}", model.name)))
}

/// `plunge diagnose` of a bed of grains.
pub(crate) fn diagnose(
    beds: &Beds,
    (flags, seeks_force): (&Flags, bool),
    measured: &Measured,
    models: &[Candidate],
) -> CommandResult {
    let model = &models[0];
    let workshop = Workshop::new(beds, flags)?;
    let bed_model = bed_model(model, measured)?;
    let wish =
        Wish { budget: beds.budget, free: beds.free.clone(), candidates: beds.candidates.clone() };
    let place = workshop.place();
    let plan = Plan::new(&bed_model, &measured.observed, &place, &wish)
        .map_err(|error| workshop.failed(error))?;
    let shown = plan_as_text(&plan);
    if beds.plan {
        let object =
            json!({ "set": measured.set.id, "cost": { "plan": plan.to_json(&bed_model) } });
        return if flags.json {
            output::json_to_stdout(&object)
        } else {
            output::to_stdout(&shown)
        };
    }
    if !flags.quiet {
        output::to_stderr(&format!("{shown}\n"));
    }
    let results = flags.results_of(measured, "diagnose", models, &format!("{wish:?}"))?;
    if !plan.fits() {
        return tell_unaffordable((&plan, &bed_model), (flags, &model.name), &results);
    }
    let found = diagnose_bed(&bed_model, &measured.observed, &place, plan, flags.seed);
    workshop.terminal.clear();
    let mut found = found.map_err(|error| workshop.failed(error))?;
    if seeks_force {
        let sought = found.seek_missing_force(&measured.set);
        sought.map_err(|error| failed(error, &model.name))?;
    }
    flags.notes(&measured.set.notes);
    flags.notes(&measured.observed.notes);
    let object = found.to_json(&bed_model).map_err(anyhow::Error::new)?;
    let json = format!("{object:#}\n");
    let mut files = vec![("diagnosis.json".to_owned(), json.clone())];
    files.extend(found.proposals(&bed_model)?);
    let BedDiagnosis { diagnosis, forward, observed, .. } = &found;
    let problem = FitProblem { set: &measured.set, observed, forward };
    write(&mut files, (&problem, &model.name, diagnosis), flags, &results)?;
    if flags.json {
        return output::whole_to_stdout(&json);
    }
    let mut text = as_text(
        &model.name,
        (diagnosis, &object),
        [found.plan.fit.len(), found.plan.confirm.len()],
    );
    text.push_str(&evidence(&found, &object));
    text.push_str(&results.told(&files));
    output::to_stdout(&text)
}

/// What is said and written of a `plan` that takes more than the budget.
fn tell_unaffordable(
    (plan, bed_model): (&Plan, &BedModel<'_>),
    (flags, name): (&Flags, &str),
    results: &Results,
) -> CommandResult {
    let diagnosis = unaffordable(plan);
    let mut object = diagnosis.to_json().map_err(anyhow::Error::new)?;
    object["cost"] = json!({ "impacts": 0, "plan": plan.to_json(bed_model) });
    let text = format!("{object:#}\n");
    let mut files = vec![("diagnosis.json".to_owned(), text.clone())];
    files.extend(report::of_results(&files, flags.quiet));
    results.write(&files)?;
    match flags.json {
        true => output::to_stdout(&text),
        false => {
            let n = [plan.fit.len(), plan.confirm.len()];
            output::to_stdout(&as_text(name, (&diagnosis, &object), n))
        }
    }
}

/// A time as one would say it.
fn about(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

fn plan_as_text(plan: &Plan) -> String {
    let mut text = format!(
        "Plan ({}): {} impacts, about {} with {} at a time\n",
        plan.size.name,
        plan.impacts(),
        about(plan.seconds()),
        plan.workers
    );
    let mut rows = table(&["", "impacts", "to run", "beds to settle", "about"]);
    for stage in &plan.stages {
        rows.add_row([
            stage.name.to_owned(),
            stage.impacts.to_string(),
            stage.to_run.to_string(),
            stage.beds.to_string(),
            about(stage.seconds),
        ]);
    }
    text.push_str(&lines(&rows));
    if let Some(budget) = plan.wish.budget.filter(|_| !plan.fits()) {
        text.push_str(&format!(
            "It is the smallest, and takes more than the budget of {}.\n",
            about(budget)
        ));
    }
    text
}

/// What impacts and their ledgers say for what is named.
fn evidence(found: &BedDiagnosis, object: &Value) -> String {
    let mut text = String::new();
    if let Some(correlation) = found.correlation {
        let _ = writeln!(text, "\nTwo runs on one draw of a bed correlate by {correlation:.2}.");
    }
    let Some(confirmation) = &found.confirmation else { return text };
    let _ = writeln!(
        text,
        "\nWhere the energy goes, over all that is dissipated, under the conditions that confirm"
    );
    let mut rows = table(&["channel", "before (%)", "after (%)"]);
    for channel in &confirmation.channels {
        let share = |(mean, se): (f64, f64)| format!("{:.1} ± {:.1}", 1e2 * mean, 1e2 * se);
        rows.add_row([channel.name.clone(), share(channel.before), share(channel.after)]);
    }
    text.push_str(&lines(&rows));
    if let Some(impacts) = object["cost"]["impacts"].as_u64() {
        let _ = writeln!(text, "\n{impacts} impacts in all, including those from the cache.");
    }
    text
}

/// Floors of the errors of models of grains, below the errors of a comparison.
pub(crate) fn floors(comparison: &Comparison, object: &Value) -> String {
    const KINDS: [(&str, &str, f64); 6] = [
        ("z_m", "z (mm)", 1e3),
        ("x_m", "x (mm)", 1e3),
        ("stop_time_s", "stop time (ms)", 1e3),
        ("final_z_m", "depth (mm)", 1e3),
        ("final_x_m", "range (mm)", 1e3),
        ("rms_relative", "relative (%)", 1e2),
    ];
    let mut rows = table(&["model", "number", "standard error of the means of its beds"]);
    for (at, model) in comparison.models.iter().enumerate() {
        let floor = &object["models"][at]["bed"]["noise_floor"];
        for (key, name, scale) in KINDS {
            if let Some(error) = floor[key].as_f64() {
                rows.add_row([
                    model.model.clone(),
                    name.to_owned(),
                    format!("{:.3}", scale * error),
                ]);
            }
        }
    }
    match rows.row_iter().next() {
        Some(_) => format!("\nnoise floor from bed to bed\n{}", lines(&rows)),
        None => String::new(),
    }
}
