//! `plunge compare RUN_A RUN_B`: a run against a run, of whatever media.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use diagnosis::runs::{Change, PathDifference, StopDifference, Track, TrackPoint, Values};
use exchange::read::{BodyStates, Keep, read_run};
use exchange::run_files::{RunFiles, is_log};
use reports::run::Course;
use runner::run::Summary;
use serde_json::{Map, Value, json};

use crate::output::{self, CommandError, CommandResult};
use crate::report;
use crate::text::{lines, table};
use crate::workbench::Flags;

/// The summary of a run, or of a list of them.
const SUMMARY: &str = "summary.json";

/// The log of a run.
const LOG: &str = "run.mcap";

/// Most sub-folders that a message names.
const NAMED: usize = 10;

/// What a path is to a comparison of runs.
pub(crate) enum Found {
    /// One finished run: its folder or its log.
    Run,
    /// Something about runs that cannot be compared, and why not.
    NoRun(String),
    /// Anything else.
    Other,
}

/// What `path` is to a comparison of runs.
pub(crate) fn what_is(path: &Path) -> Found {
    let shown = path.display();
    let holds = |name: &str| path.join(name).is_file();
    if RunFiles::of(path).are_there() {
        return Found::Run;
    }
    if path.is_file() && is_log(path) {
        let summary = RunFiles::of(path).summary;
        let missing = summary.display();
        return Found::NoRun(format!("{shown} is a log without a summary: {missing} is not there"));
    }
    let runs = runs_below(path);
    if !runs.is_empty() {
        let more = if runs.len() > NAMED { ", …" } else { "" };
        return Found::NoRun(format!(
            "{shown} holds the runs of several conditions; name one of them: {}{more}",
            runs[..runs.len().min(NAMED)].join(", ")
        ));
    }
    if holds(LOG) || holds(&format!("{LOG}.partial")) {
        return Found::NoRun(format!(
            "{shown} holds a run that is not finished; `plunge run --resume` goes on with it"
        ));
    }
    Found::Other
}

/// The finished runs in the folders of `path`, in order.
fn runs_below(path: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(path) else { return Vec::new() };
    let folders = entries.filter_map(Result::ok).map(|entry| entry.path());
    let finished = folders.filter(|one| one.is_dir() && RunFiles::of(one).are_there());
    let mut names: Vec<String> = finished.map(|one| one.display().to_string()).collect();
    names.sort();
    names
}

/// Compares two runs, each a folder or a log; writes nothing unless `--out` says where.
pub(crate) fn run(folders: [&Path; 2], flags: &Flags) -> CommandResult {
    if flags.change_models() {
        return Err(CommandError::bad_input("--set changes models; a run is what it is"));
    }
    match what_is(folders[1]) {
        Found::Run => {}
        Found::NoRun(why) => return Err(CommandError::bad_input(why)),
        Found::Other => {
            return Err(CommandError::bad_input(format!(
                "{} is no folder of a run, which holds {SUMMARY} and {LOG}",
                folders[1].display()
            )));
        }
    }
    let runs = [Run::read(folders[0])?, Run::read(folders[1])?];
    let [first, second] = &runs;
    let paths =
        PathDifference::between(&first.tracks, &second.tracks).map_err(CommandError::bad_input)?;
    let stops = StopDifference::between(&first.summary, &second.summary);
    let notes = notes(&runs, folders);
    flags.notes(&notes);
    let object = as_json(&runs, &notes, &paths, &stops);
    let results = flags.chosen_results(&inputs(folders)?)?;
    let mut told = "\nnothing was written; --out says where to\n".to_owned();
    if let Some(results) = &results {
        let files = files(&runs, folders, &object, flags.quiet)?;
        results.write(&files)?;
        told = results.told(&files);
    }
    if flags.json {
        return output::json_to_stdout(&object);
    }
    let mut text = as_text(&runs, &paths, &stops);
    text.push_str(&told);
    output::to_stdout(&text)
}

/// Names and texts of what is written.
fn files(
    runs: &[Run; 2],
    folders: [&Path; 2],
    object: &Value,
    quiet: bool,
) -> Result<Vec<(String, String)>, CommandError> {
    let courses = [Course::read(folders[0]), Course::read(folders[1])];
    let [first, second] = courses.map(|course| course.map_err(CommandError::bad_input));
    let (first, second) = (first?, second?);
    let [of_first, of_second] = labels(runs);
    let picture = reports::run::pair_picture([(&of_first, &first), (&of_second, &second)])
        .map_err(|error| CommandError::Failed(error.into()))?;
    let mut files = vec![
        ("comparison.json".to_owned(), format!("{object:#}\n")),
        ("paths.svg".to_owned(), picture),
    ];
    files.extend(report::of_results(&files, quiet));
    Ok(files)
}

/// A run as far as it is compared.
struct Run {
    name: String,
    /// The program that made it, if that is another one.
    simulated_by: Option<String>,
    summary: Summary,
    tracks: Vec<Track>,
    /// Whether the log is whole.
    complete: bool,
}

impl Run {
    fn read(run: &Path) -> Result<Self, CommandError> {
        let RunFiles { log, summary: path, .. } = RunFiles::of(run);
        let text = fs::read_to_string(&path).map_err(|error| unreadable(&path, &error))?;
        let summary = serde_json::from_str(&text).map_err(|error| unreadable(&path, &error))?;
        let log = read_run(&log, Keep::States).map_err(CommandError::bad_input)?;
        let tracks = log.bodies.iter().map(track).collect();
        Ok(Self {
            name: run.display().to_string(),
            simulated_by: log.metadata.get("simulated_by").cloned(),
            summary,
            tracks,
            complete: log.complete,
        })
    }
}

/// The names of `runs`, with the programs that made them if one of them is not of ours.
fn labels(runs: &[Run; 2]) -> [String; 2] {
    let ours = runs.iter().all(|run| run.simulated_by.is_none());
    runs.each_ref().map(|run| match &run.simulated_by {
        _ if ours => run.name.clone(),
        program => format!("{}, by {}", run.name, program.as_deref().unwrap_or("plunge")),
    })
}

fn unreadable(path: &Path, why: &dyn std::fmt::Display) -> CommandError {
    CommandError::bad_input(format!("{} is no summary of a run: {why}", path.display()))
}

/// The path of a body, whose horizontal distance counts from its first sample: each run has an origin
/// of its own.
fn track(body: &BodyStates) -> Track {
    let start = body.states.first().map_or(0.0, |state| state.position.x);
    let points = body.states.iter().map(|state| TrackPoint {
        time: state.time,
        values: Values {
            z: state.depth,
            x: state.position.x - start,
            speed: state.velocity.norm(),
        },
    });
    Track { points: points.collect() }
}

/// What the results follow from.
fn inputs(folders: [&Path; 2]) -> Result<blake3::Hash, CommandError> {
    let mut hash = blake3::Hasher::new();
    hash.update(concat!(env!("CARGO_PKG_VERSION"), " compare runs").as_bytes());
    for folder in folders {
        hash.update(folder.as_os_str().as_encoded_bytes());
        let RunFiles { log, summary, .. } = RunFiles::of(folder);
        for path in [summary, log] {
            let read = File::open(&path).and_then(|file| hash.update_reader(file).map(drop));
            read.with_context(|| format!("cannot read {}", path.display()))?;
        }
    }
    Ok(hash.finalize())
}

/// What is easily overlooked.
fn notes(runs: &[Run; 2], folders: [&Path; 2]) -> Vec<String> {
    let [first, second] = [&runs[0].summary, &runs[1].summary];
    let canonical =
        |folder: &Path| fs::canonicalize(folder).unwrap_or_else(|_| PathBuf::from(folder));
    let mut notes: Vec<String> = runs
        .iter()
        .filter(|run| !run.complete)
        .map(|run| {
            format!("the log of {} is cut; its path is compared as far as it goes", run.name)
        })
        .collect();
    if canonical(folders[0]) == canonical(folders[1]) {
        notes.push("both are the same run".to_owned());
    }
    let impact =
        |one: &Summary| format!("{} m/s at {} deg", one.impact.speed_m_per_s, one.impact.angle_deg);
    let [first, second] = [impact(first), impact(second)];
    if first != second {
        notes.push(format!("the runs are of different impacts: A {first}, B {second}"));
    }
    notes
}

fn as_json(
    runs: &[Run; 2],
    notes: &[String],
    paths: &PathDifference,
    stops: &StopDifference,
) -> Value {
    let dissipated: Map<String, Value> = channels(runs)
        .into_iter()
        .map(|channel| (channel.to_owned(), json!(dissipated(runs, channel))))
        .collect();
    json!({
        "runs": runs.each_ref().map(|run| &run.name),
        "labels": labels(runs),
        "notes": notes,
        "common": paths.common,
        "rms": paths.rms,
        "largest": paths.largest,
        "stop": stops,
        "energy": { "dissipated_J": dissipated, "closure": closures(runs) },
    })
}

/// The channels in which either of the runs dissipates.
fn channels(runs: &[Run; 2]) -> BTreeSet<&str> {
    runs.iter().flat_map(|run| run.summary.energy.dissipated.keys().map(String::as_str)).collect()
}

/// What each run dissipates in `channel` (J); none where its laws have no such channel.
fn dissipated(runs: &[Run; 2], channel: &str) -> [Option<f64>; 2] {
    runs.each_ref().map(|run| run.summary.energy.dissipated.get(channel).copied())
}

fn closures(runs: &[Run; 2]) -> [Option<f64>; 2] {
    runs.each_ref().map(|run| run.summary.energy.closure)
}

fn as_text(runs: &[Run; 2], paths: &PathDifference, stops: &StopDifference) -> String {
    let mut text = String::new();
    for (letter, (label, run)) in ["A", "B"].iter().zip(labels(runs).iter().zip(runs)) {
        let Summary { name, medium, impact, .. } = &run.summary;
        text.push_str(&format!(
            "{letter}  {label}: {name}, {} m/s at {} deg, {medium}\n",
            impact.speed_m_per_s, impact.angle_deg
        ));
    }
    let common = paths.common;
    text.push_str(&format!("\nB - A from {:.4} s to {:.4} s\n", common.from, common.to));
    text.push_str(&along_the_path(paths));
    text.push_str("\nat the stop\n");
    text.push_str(&at_the_stop(stops));
    text.push_str("\nenergy dissipated (J)\n");
    text.push_str(&energies(runs));
    text
}

fn along_the_path(paths: &PathDifference) -> String {
    let mut table = table(&["", "rms", "largest", "at (s)"]);
    let PathDifference { rms, largest, .. } = paths;
    let (most, at) = (largest.values, largest.at_s);
    for (name, rms, most, at) in [
        ("z (mm)", 1e3 * rms.z, 1e3 * most.z, at.z),
        ("x (mm)", 1e3 * rms.x, 1e3 * most.x, at.x),
        ("speed (m/s)", rms.speed, most.speed, at.speed),
    ] {
        table.add_row([
            name.to_owned(),
            format!("{rms:.4}"),
            format!("{most:+.4}"),
            format!("{at:.4}"),
        ]);
    }
    lines(&table)
}

fn at_the_stop(stops: &StopDifference) -> String {
    let mut table = table(&["", "A", "B", "B - A", "relative (%)"]);
    for (name, Change { values, difference, relative }, scale) in [
        ("stopping time (s)", stops.stopping_time, 1.0),
        ("depth (mm)", stops.depth, 1e3),
        ("range (mm)", stops.range, 1e3),
        ("at rest after (s)", stops.rest_time, 1.0),
    ] {
        let digits = if scale > 1.0 { 3 } else { 5 };
        let number = |value: Option<f64>| {
            value.map_or("not reached".to_owned(), |value| format!("{:.digits$}", scale * value))
        };
        let signed = |value: Option<f64>, scale: f64, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{:+.digits$}", scale * value))
        };
        let [first, second] = values.map(number);
        let (apart, share) = (signed(difference, scale, digits), signed(relative, 1e2, 2));
        table.add_row([name.to_owned(), first, second, apart, share]);
    }
    lines(&table)
}

fn energies(runs: &[Run; 2]) -> String {
    let mut table = table(&["", "A", "B"]);
    for channel in channels(runs) {
        let number =
            |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4e}"));
        let [first, second] = dissipated(runs, channel).map(number);
        table.add_row([channel.replace('_', "-"), first, second]);
    }
    let known =
        |closure: Option<f64>| closure.map_or("-".to_owned(), |closure| format!("{closure:.1e}"));
    let [first, second] = closures(runs).map(known);
    table.add_row(["closure (of the impact)".to_owned(), first, second]);
    lines(&table)
}
