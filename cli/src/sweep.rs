//! `plunge sweep`: a campaign on all cores of this machine, or on others by a scheduler.

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context as _;
use configs::estimate::{MEMORY_SHARE, available_memory_bytes};
use engine::checkpoint;
use engine::parallel::with_threads;
use runner::beds::{Impacts, Place};
use runner::campaign::file::Campaign;
use runner::campaign::pace::Pace;
use runner::campaign::{
    Counts, Folder, FolderError, Planned, Results, SubmitError, SweepError, TABLE, Task,
};
use runner::schedulers::Scheduler;
use runner::{CampaignError, Progress, Watch};
use serde_json::json;

use crate::beds::time;
use crate::common::{On, of_scheduler};
use crate::control::Terminal;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;

/// Most failed points that are named in the text.
const MOST_NAMED: usize = 5;

/// Arguments of `plunge sweep`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A campaign file.
    campaign: PathBuf,
    /// The folder of the campaign; without it, `runs/` and its name.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the points with time and memory; run nothing.
    #[arg(long)]
    plan: bool,
    /// Print how many points are done; run nothing.
    #[arg(long, conflicts_with = "plan")]
    status: bool,
    /// Where points are run. A scheduler gets those that are not done; --status says how far it is.
    #[arg(long, value_name = "WHERE", default_value = "local")]
    on: On,
    /// Run this point of the plan alone: what a scheduler's tasks do.
    #[arg(long, value_name = "N", hide = true, conflicts_with_all = ["plan", "status", "on"])]
    point: Option<usize>,
    /// Time after which to stop, such as "20 min"; the same command continues.
    #[arg(long, value_name = "TIME", value_parser = time)]
    budget: Option<f64>,
    /// Points at a time, 1 to 256, each on one thread; one per core otherwise.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    threads: Option<u16>,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// No progress and no warnings.
    #[arg(long)]
    quiet: bool,
    /// The folder of prepared beds.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Let the campaign and its models read files below this folder too.
    #[arg(long = "allow-path", value_name = "DIR")]
    allow_paths: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let campaign = Campaign::load(&args.campaign, &args.allow_paths)?;
    let default = || Path::new("runs").join(&campaign.name);
    let folder = Folder::new(&args.out.clone().unwrap_or_else(default));
    if args.status {
        return show(args, &folder, &Results::read(&folder).map_err(of_folder)?);
    }
    let terminal = Terminal::new(args.quiet);
    let cache = runner::cache_folder(args.cache.as_deref());
    // A budget that overflows the clock sets no deadline.
    let deadline = args
        .budget
        .and_then(|budget| Duration::try_from_secs_f64(budget).ok())
        .and_then(|budget| Instant::now().checked_add(budget));
    let watch = Budgeted { terminal: &terminal, deadline };
    let workers = args.threads.and_then(|n| NonZero::new(usize::from(n)));
    let place = Place { cache: &cache, workers, watch: &watch, elsewhere: None };
    if let Some(point) = args.point {
        let only = only(&campaign, point, &folder, &args.allow_paths)?;
        return one(&only, &folder, &place, &terminal);
    }
    let planned = Planned::of(&campaign, &args.allow_paths)?;
    for warning in &planned.warnings {
        Watch::warn(&terminal, warning);
    }
    if args.plan {
        return plan(args, &folder, &planned, &place);
    }
    if let Some(scheduler) = args.on.scheduler() {
        return submit(args, &planned, &folder, &cache, scheduler);
    }
    refuse_too_large(&planned, place.n_workers())?;
    let ran = runner::campaign::run(&planned, &folder, &place);
    terminal.clear();
    let interrupted = match ran {
        Ok(()) => false,
        Err(SweepError::Campaign(CampaignError::Interrupted)) => true,
        Err(error) => return Err(of_sweep(error)),
    };
    let results = Results::read(&folder).map_err(of_folder)?;
    if interrupted && signals::is_asked_to_stop() {
        // Table and report of very many points take longer than a signal may.
        let Counts { points, done, failed, .. } = results.counts();
        let left =
            format!("{} of {points} points have ended; the same command goes on", done + failed);
        return Err(terminal.interrupted(&left));
    }
    let table = folder.path().join(TABLE);
    exchange::table::write_parquet(&table, &runner::campaign::columns(&results))
        .map_err(|error| CommandError::Failed(error.into()))?;
    report(&folder, &results, &terminal);
    show(args, &folder, &results)
}

/// The point of that number, counted from 1, in the plan that `folder` holds.
fn only(
    campaign: &Campaign,
    point: usize,
    folder: &Folder,
    allow_paths: &[PathBuf],
) -> Result<Planned, CommandError> {
    let plan = folder.plan().map_err(of_folder)?;
    let n = plan.points.len();
    let Some(index) = point.checked_sub(1).filter(|index| *index < n) else {
        return Err(CommandError::bad_input(format!(
            "the plan has the points 1 to {n}, not {point}"
        )));
    };
    let other = || FolderError::OtherPlan { folder: folder.path().to_owned() };
    Planned::of_point(campaign, plan, index, allow_paths)?.ok_or_else(|| of_folder(other()))
}

/// A task of a scheduler: its point, and nothing on stdout.
fn one(only: &Planned, folder: &Folder, place: &Place<'_>, terminal: &Terminal) -> CommandResult {
    match runner::campaign::run_one(only, folder, place) {
        Err(SweepError::Campaign(CampaignError::Interrupted)) => {
            Err(terminal.interrupted("the same command goes on from here"))
        }
        ended => ended.map_err(of_sweep),
    }
}

/// Gives the points that are not done to `scheduler`.
fn submit(
    args: &Args,
    planned: &Planned,
    folder: &Folder,
    cache: &Path,
    scheduler: Scheduler,
) -> CommandResult {
    let task = Task {
        program: std::env::current_exe().context("cannot find this program")?,
        campaign: args.campaign.clone(),
        cache: cache.to_owned(),
        allow_paths: args.allow_paths.clone(),
    };
    let submitted = runner::campaign::submit(scheduler, planned, folder, &task).map_err(
        |error| match error {
            SubmitError::Folder(error) => of_folder(error),
            SubmitError::Scheduler(error) => of_scheduler(error),
        },
    )?;
    let Counts { points, done, failed, .. } = Results::read(folder).map_err(of_folder)?.counts();
    if args.json {
        return output::json_to_stdout(&json!({
            "campaign": planned.plan.name,
            "points": points,
            "ended": done + failed,
            "submitted": submitted,
        }));
    }
    output::to_stdout(&format!(
        "{}: {submitted} of {points} points submitted; --status says how far they are, and the same \
         command without --on, once they have ended, makes table and report\n\n-> {}\n",
        planned.plan.name,
        folder.path().display()
    ))
}

/// Refuses points that do not fit into memory side by side.
fn refuse_too_large(planned: &Planned, n: usize) -> CommandResult {
    let needed = planned.memory(n);
    match available_memory_bytes() {
        Some(available) if needed as f64 > MEMORY_SHARE * available as f64 => {
            Err(CommandError::bad_input(format!(
                "{n} points at a time need about {}, and {} are free; --threads N runs fewer at a time",
                output::bytes(needed),
                output::bytes(available)
            )))
        }
        _ => Ok(()),
    }
}

/// Leaves the report; one that cannot be made is told, and fails nothing.
fn report(folder: &Folder, results: &Results, terminal: &Terminal) {
    let file = folder.path().join(reports::FILE);
    let written = match reports::of_campaign(results) {
        Ok(page) => {
            checkpoint::write_whole(&file, page.as_bytes()).map_err(|error| error.to_string())
        }
        Err(error) => Err(error.to_string()),
    };
    if let Err(why) = written {
        Watch::warn(terminal, &format!("{}: {why}", file.display()));
    }
}

/// What the campaign would run, and how long at most.
fn plan(args: &Args, folder: &Folder, planned: &Planned, place: &Place<'_>) -> CommandResult {
    let points = &planned.plan.points;
    let mut hashes = std::collections::BTreeSet::new();
    let mut beds = std::collections::BTreeSet::new();
    let (mut to_run, mut work, mut on_grains) = (0_usize, 0.0, None);
    for (index, point) in points.iter().enumerate() {
        if hashes.insert(&point.hash) && folder.done(&point.hash).map_err(of_folder)?.is_none() {
            let need = planned.needs[index];
            to_run += 1;
            work += need.work;
            if let Some(key) = need.bed {
                beds.insert(key);
                on_grains.get_or_insert(index);
            }
        }
    }
    let workers = place.n_workers() as f64;
    let pace = on_grains.map(|index| pace(planned, index, place)).transpose()?;
    let (rate, bed_time) = pace.unwrap_or((configs::estimate::RATE_PER_THREAD, None));
    let at_most = work / (rate * workers);
    // Beds are as many as there are workers at a time.
    let beds_time = bed_time.map(|time| time * (beds.len() as f64 / workers).ceil());
    let memory = planned.memory(place.n_workers());
    let object = json!({
        "campaign": planned.plan.name,
        "points": points.len(),
        "distinct": hashes.len(),
        "to_run": to_run,
        "beds": beds.len(),
        "cost": {
            "workers": place.n_workers(),
            "at_most_s": at_most.round(),
            "beds_s": beds_time.map(f64::round),
            "memory_bytes": memory,
        },
    });
    if args.json {
        return output::json_to_stdout(&object);
    }
    let mut text = format!(
        "{}: {} points, {} of them distinct, {to_run} to run on {} beds\n",
        planned.plan.name,
        points.len(),
        hashes.len(),
        beds.len()
    );
    let memory = match memory {
        0 => String::new(),
        bytes => format!(" and about {} of memory", output::bytes(bytes)),
    };
    let _ = writeln!(
        text,
        "  at most {at_most:.0} s with {} at a time{memory}, plus the time to prepare beds that are not in the cache{}",
        place.n_workers(),
        bed_time.map_or(String::new(), |time| format!(", {time:.1} s each"))
    );
    output::to_stdout(&text)
}

/// Grain-steps per second of one worker on the bed of the point at `index`, and the time (s) that one
/// takes to prepare it, if that can be measured.
fn pace(
    planned: &Planned,
    index: usize,
    place: &Place<'_>,
) -> Result<(f64, Option<f64>), CommandError> {
    let model = planned.load(index)?.model;
    let Some(grains) = model.grains() else {
        return Ok((configs::estimate::RATE_PER_THREAD, None));
    };
    let failed = |error: anyhow::Error| CommandError::Failed(error);
    let measured = with_threads(1, || Pace::of(grains, place.cache))
        .map_err(|error| failed(error.into()))?
        .map_err(|error| failed(error.into()))?;
    match measured {
        Some(pace) => Ok((pace.resting_per_s, Some(pace.preparation(grains.n_grains(), 1)))),
        None => Ok((place.rate(grains).map_err(|error| failed(error.into()))?, None)),
    }
}

fn show(args: &Args, folder: &Folder, results: &Results) -> CommandResult {
    let object = results.to_json();
    if args.json {
        return output::json_to_stdout(&object);
    }
    let Counts { points, done, failed, begun, waiting } = results.counts();
    let mut text = format!("{}: {points} points\n\n", results.plan.name);
    for (name, n) in [("done", done), ("failed", failed), ("begun", begun), ("waiting", waiting)] {
        let _ = writeln!(text, "  {name:<8}{n:>7}");
    }
    let failures = object["failures"].as_array().map_or(&[][..], Vec::as_slice);
    for failure in failures.iter().take(MOST_NAMED) {
        let why = failure["error"].as_str().unwrap_or_default();
        let _ = writeln!(text, "  point {} failed: {why}", failure["point"]);
    }
    if let Some(more @ 1..) = failures.len().checked_sub(MOST_NAMED) {
        let _ = writeln!(text, "  {more} more failed; the report lists all");
    }
    let _ = writeln!(text, "\n-> {}", folder.path().display());
    output::to_stdout(&text)
}

fn of_sweep(error: SweepError) -> CommandError {
    match error {
        SweepError::Folder(error) => of_folder(error),
        SweepError::Campaign(error) => error.into(),
    }
}

/// A folder that is not ours to use is bad input.
fn of_folder(error: FolderError) -> CommandError {
    match error {
        FolderError::Io { .. } | FolderError::Misunderstood { .. } => {
            CommandError::Failed(error.into())
        }
        error => CommandError::bad_input(error),
    }
}

/// A terminal with a time to stop.
struct Budgeted<'a> {
    terminal: &'a Terminal,
    deadline: Option<Instant>,
}

impl Budgeted<'_> {
    fn is_over(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl Watch for Budgeted<'_> {
    fn progress(&self, progress: &Progress) {
        Watch::progress(self.terminal, progress);
    }

    fn warn(&self, message: &str) {
        Watch::warn(self.terminal, message);
    }

    fn wants_to_stop(&self) -> bool {
        self.is_over() || Watch::wants_to_stop(self.terminal)
    }
}
