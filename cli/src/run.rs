//! `plunge run`: the impacts of a model, with their logs and summaries.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use configs::{Loaded, Model};
use reports::run::Course;
use runner::run::{
    BedSummary, CostSummary, Existing, IntrusionSummary, LinkSummary, ListSummary, Outcome, Places,
    Scatter, Summary,
};
use runner::{CampaignError, Stage, Workers};
use serde_json::{Value, json};

use crate::common::Common;
use crate::control::Terminal;
use crate::output::{self, CommandError, CommandResult};
use crate::report;
use crate::table_file;
use crate::view::Live;

/// Width of a curve in the text (characters).
const SPARKLINE: usize = 40;

/// Arguments of `plunge run`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// A model file, or the name of a shipped model.
    model: PathBuf,
    /// Show the page of the run to a browser on this machine while it goes on; PORT is 8792 unless stated.
    #[arg(long, value_name = "PORT", num_args = 0..=1, require_equals = true, default_missing_value = "8792")]
    live: Option<u16>,
    #[command(flatten)]
    common: Common,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let common = &args.common;
    table_file::refuse(&args.model)?;
    let loaded = common.load(&args.model)?;
    let model = &loaded.model;
    common.refuse_too_large(model)?;
    let places = places(common, model);
    let live = args.live.map(|port| Live::start(port, &places.out, common.quiet)).transpose()?;
    let mut terminal = Terminal::new(common.quiet);
    let outcome =
        common.on_threads(|| runner::run::run(model, &loaded.original, &places, &mut terminal))?;
    terminal.clear();
    let shown = match outcome.map_err(CommandError::from)? {
        Outcome::One(summary) => {
            let course = report::of_run(&places.out, &summary, common.quiet);
            show(common.json, &*summary, || one_as_text(&summary, course.as_ref(), &places.out))
        }
        Outcome::List(summary) => {
            report::of_list(&places.out, &summary, common.quiet);
            show(common.json, &*summary, || list_as_text(&summary, &places.out))
        }
        Outcome::Interrupted => return Err(terminal.interrupted(RESUMES)),
    };
    live.iter().for_each(Live::end);
    shown
}

/// Runs the model once with each of `variants`, further values of `--set`: `--threads` at a time, each on one
/// thread, into the folders `001`, `002` … of `--out`. No model is run before all have been read. Gives the
/// summaries; reports are left to `plunge report`.
pub(crate) fn many(args: &Args, variants: &[Vec<String>]) -> Result<Vec<Value>, CommandError> {
    let Args { model, common, .. } = args;
    table_file::refuse(model)?;
    let number = workers(common.threads);
    let mut loaded = Vec::with_capacity(variants.len());
    for sets in variants {
        let sets = [&common.sets[..], sets].concat();
        let one = Common { sets, ..common.clone() }.load(model)?;
        common.refuse_too_large_beside(&one.model, number.min(variants.len()) as u64)?;
        loaded.push(one);
    }
    let terminal = Terminal::new(common.quiet);
    let all: Vec<usize> = (0..loaded.len()).collect();
    let work = |_: &usize| 1.0;
    let ran = Workers { number, watch: &terminal }.side_by_side(
        Stage::Impacts,
        &all,
        (&work, 0),
        |at, control| {
            let Loaded { model, original, .. } = &loaded[at];
            let places = places(common, model);
            let places = Places { out: places.out.join(format!("{:03}", at + 1)), ..places };
            match runner::run::run(model, original, &places, control)? {
                Outcome::One(summary) => Ok(json!(summary)),
                Outcome::List(summary) => Ok(json!(summary)),
                Outcome::Interrupted => Err(CampaignError::Interrupted),
            }
        },
    );
    terminal.clear();
    ran.map_err(|error| match error {
        CampaignError::Interrupted => terminal.interrupted(RESUMES),
        error => error.into(),
    })
}

/// What is left of a run that was stopped.
const RESUMES: &str = "--resume goes on from here";

/// Impacts at a time: as many as were `asked` for, else one per core.
fn workers(asked: Option<u16>) -> usize {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or(cores, usize::from)
}

fn places(common: &Common, model: &Model) -> Places {
    Places {
        out: common.out.clone().unwrap_or_else(|| Path::new("runs").join(&model.run.name)),
        cache: common.cache_folder(),
        existing: match (common.force, common.resume) {
            (true, _) => Existing::Replace,
            (false, true) => Existing::Resume,
            (false, false) => Existing::Keep,
        },
    }
}

fn show<T: serde::Serialize>(
    json: bool,
    summary: &T,
    text: impl FnOnce() -> String,
) -> CommandResult {
    if json { output::json_to_stdout(&json!(summary)) } else { output::to_stdout(&text()) }
}

fn one_as_text(summary: &Summary, course: Option<&Course>, out: &Path) -> String {
    let Summary { impact, stop, energy, cost, .. } = summary;
    let ground = match &summary.bed {
        Some(bed) => format!("onto {} grains", bed.grains),
        None => "into a resistive medium".to_owned(),
    };
    let mut text = format!(
        "{}: {} m/s at {} deg {ground}\n\n",
        summary.name, impact.speed_m_per_s, impact.angle_deg
    );
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<29}{value}");
    };
    let time = |time: Option<f64>| {
        time.map_or_else(|| "not reached".to_owned(), |time| format!("{time:.4} s"))
    };
    let is_pushed = summary.intrusion.is_some();
    if !is_pushed {
        let times = [stop.stopping_time_s, stop.stopping_time_z_s, stop.stopping_time_x_s];
        let [whole, vertical, horizontal] = times.map(time);
        line("stopping time", format!("{whole} (vertical {vertical}, horizontal {horizontal})"));
        line("at rest after", time(stop.rest_time_s));
    }
    line("depth", format!("{:.2} mm", 1e3 * stop.depth_m));
    line("range", format!("{:.2} mm", 1e3 * stop.range_m));
    if let Some([depth, speed]) = course.map(|course| course.sparklines(SPARKLINE)) {
        line("depth over time", depth);
        line("speed over time", speed);
    }
    if let Some(push) = &summary.intrusion {
        line("pushed to", push_as_text(push));
    }
    if let Some(bed) = &summary.bed {
        line("bed", bed_as_text(bed));
    }
    if let Some(forces) = summary.forces.as_ref().filter(|_| !is_pushed) {
        line("friction overtakes", time(forces.static_overtakes_s));
        let newton =
            |force: Option<f64>| force.map_or("-".to_owned(), |force| format!("{force:.4} N"));
        let (whole, friction) = (newton(forces.force_at_stop), newton(forces.static_at_stop));
        line("force at the stop", format!("{whole}, of which {friction} is friction"));
    }
    for (index, link) in summary.links.iter().enumerate() {
        line(&format!("link {}", index + 1), link_as_text(link));
    }
    let shares = energy.shares();
    let percent = |energy: f64| shares.percent(energy).unwrap_or(0.0);
    let sources: Vec<String> = shares
        .sources
        .iter()
        .map(|(name, energy)| format!("{:.1} % {name}", percent(*energy)))
        .collect();
    line("energy supplied", format!("{}: {}", joules(shares.supplied), sources.join(", ")));
    let missing = shares.unaccounted.map(|energy| ("unaccounted for".to_owned(), energy));
    for (name, energy) in shares.uses.iter().chain(&missing) {
        line(&format!("  {name}"), format!("{:8.2} %", percent(*energy)));
    }
    if let Some(closure) = energy.closure {
        let whole = if is_pushed { "given to the bed" } else { "at impact" };
        line(
            "closure",
            format!("{closure:.1e}: the most unaccounted for, over the energy {whole}"),
        );
    }
    line("cost", cost_as_text(cost));
    format!("{text}\n-> {}\n", out.display())
}

fn push_as_text(push: &IntrusionSummary) -> String {
    let last = push.depth_m.last().zip(push.force_z.last()).zip(push.force_x.last());
    let force = last.map_or_else(String::new, |((depth, up), along)| {
        format!("; last {up:.4} N upward, {along:.4} N along x, {:.2} mm deep", 1e3 * depth)
    });
    format!("{:.2} mm, with {:.4e} J of the drive{force}", 1e3 * push.to_depth_m, push.work)
}

/// An energy in three digits, in the unit that fits it.
fn joules(energy: f64) -> String {
    let (factor, unit) = match energy.abs() {
        size if size >= 1.0 || size <= 0.0 => (1.0, "J"),
        size if size >= 1e-3 => (1e3, "mJ"),
        _ => (1e6, "\u{b5}J"),
    };
    format!("{:.1} {unit}", factor * energy)
}

fn bed_as_text(bed: &BedSummary) -> String {
    let origin = match bed.cache.as_str() {
        "hit" => "from the cache",
        "miss" => "prepared now",
        _ => "from its table",
    };
    format!(
        "packing fraction {:.4}, {:.4} m high, coordination {:.2} ({origin})",
        bed.packing_fraction, bed.height_m, bed.coordination
    )
}

fn link_as_text(link: &LinkSummary) -> String {
    let percent =
        |share: Option<f64>| share.map_or("-".to_owned(), |x| format!("{:.1} %", 100.0 * x));
    let stopped = link.stopping_time_s.map_or("does not stop".to_owned(), |time| {
        format!("stops {time:.4} s after its contact, {:.2} mm deep", 1e3 * link.depth_m)
    });
    format!(
        "{stopped}; gives {:.4e} J, {} of all; loses {} of its own in motion",
        link.given,
        percent(link.given_share),
        percent(link.kinetic_share)
    )
}

fn cost_as_text(cost: &CostSummary) -> String {
    let wall = cost.wall_s.unwrap_or(0.0);
    match (cost.dt_s, cost.grain_steps_per_s) {
        (Some(dt), Some(rate)) => format!(
            "{} steps of {dt:.3e} s in {wall:.1} s on {} threads, {:.1} million grain-steps/s",
            cost.steps,
            cost.threads.unwrap_or(1),
            1e-6 * rate
        ),
        _ => format!("{} steps of the solver in {:.0} ms", cost.steps, 1e3 * wall),
    }
}

fn list_as_text(summary: &ListSummary, out: &Path) -> String {
    let mut text = format!("{}: {} impacts\n\n", summary.name, summary.runs.len());
    let _ = writeln!(
        text,
        "  {:>9} {:>9} {:>3}  {:>17} {:>17} {:>24} {:>24}",
        "speed m/s", "angle deg", "n", "depth mm", "range mm", "stopping time s", "rest time s"
    );
    for group in &summary.groups {
        let _ = writeln!(
            text,
            "  {:>9} {:>9} {:>3}  {:>17} {:>17} {:>24} {:>24}",
            group.speed_m_per_s,
            group.angle_deg,
            group.n,
            scatter(group.depth_m, group.n, 1e3, 2),
            scatter(group.range_m, group.n, 1e3, 2),
            scatter(group.stopping_time_s, group.n, 1.0, 4),
            scatter(group.rest_time_s, group.n, 1.0, 4),
        );
    }
    format!("{text}\n-> {}\n", out.display())
}

/// `value` of a group of `n` impacts; says so if not all of them reached it.
fn scatter(value: Scatter, n: usize, scale: f64, digits: usize) -> String {
    let text = match (value.mean, value.sd) {
        (Some(mean), Some(sd)) => format!("{:.digits$} ± {:.digits$}", scale * mean, scale * sd),
        (Some(mean), None) => format!("{:.digits$}", scale * mean),
        (None, _) => return "not reached".to_owned(),
    };
    if value.n < n { format!("{text} ({} of {n})", value.n) } else { text }
}
