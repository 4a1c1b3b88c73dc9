//! `plunge check SET`: what is understood of a measurement set.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use configs::{Color, Sources, document, limits, paths};
use measurements::{
    ContradictionKind, Curve, Held, Loaded, MeasurementSet, Outcome, Reading, Role, Run,
    RunContact, Severity, Zero,
};
use serde_json::{Value, json};

use crate::common::Common;
use crate::output::{self, CommandError, CommandResult, stderr_color};
use crate::workbench::{overruled_by, write_whole};

/// The file of a set, in its folder.
const SET: &str = "measurement.toml";

/// Whether `path` is a folder with a measurement.toml, that file, or another with its main table.
pub(crate) fn is_set(path: &Path) -> bool {
    if path.is_dir() {
        return path.join(SET).is_file();
    }
    path.is_file() && (path.ends_with(SET) || has_main_table(path))
}

/// Refuses a campaign, which another command checks.
///
/// # Errors
/// If the file at `path` is one.
pub(crate) fn refuse_campaign(path: &Path) -> CommandResult {
    match path.is_file() && has_table(path, "campaign") {
        false => Ok(()),
        true => {
            let shown = path.display();
            Err(CommandError::bad_input(format!(
                "{shown} is a campaign; `plunge sweep {shown} --plan` checks it, and says what it would take"
            )))
        }
    }
}

/// Whether the file at `path` has the table `[measurement]`.
fn has_main_table(path: &Path) -> bool {
    has_table(path, "measurement")
}

/// Whether the file at `path` has this table; what cannot be read has none.
fn has_table(path: &Path, table: &'static str) -> bool {
    let name = path.display().to_string();
    let bytes = paths::read_bounded(path, &name, limits::FILE_BYTES).ok();
    let Some(text) = bytes.and_then(|bytes| String::from_utf8(bytes).ok()) else {
        return false;
    };
    let mut sources = Sources::default();
    let id = sources.add(name, text);
    document::parse(&sources, id).is_ok_and(|root| root.has(table))
}

pub(crate) fn run(path: &Path, common: &Common) -> CommandResult {
    if !common.sets.is_empty() {
        return Err(CommandError::bad_input(
            "--set changes models; a measurement set is what it is",
        ));
    }
    let loaded = MeasurementSet::load(path)?;
    if !common.quiet {
        output::to_stderr(&loaded.render_warnings(stderr_color()));
    }
    if let Some(out) = &common.out {
        draw(&loaded, out, common.force)?;
    }
    match common.json {
        true => output::json_to_stdout(&as_json(&loaded))?,
        false => output::to_stdout(&as_text(&loaded, common.out.as_deref()))?,
    }
    match loaded.contradictions.is_empty() {
        true => Ok(()),
        false => Err(CommandError::BadInput(format!(
            "{}error: the set contradicts itself; in compare and diagnose, {}\n",
            loaded.render_contradictions(&ContradictionKind::ALL, stderr_color()),
            overruled_by(&loaded, &ContradictionKind::ALL)
        ))),
    }
}

/// Leaves the page of a set in the folder `out`.
fn draw(loaded: &Loaded, out: &Path, replace: bool) -> CommandResult {
    let file = out.join(reports::FILE);
    if file.exists() && !replace {
        return Err(CommandError::bad_input(format!(
            "{} exists already; choose another --out, or --force to replace it",
            file.display()
        )));
    }
    let page = reports::of_set(loaded).map_err(anyhow::Error::new)?;
    fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    write_whole(&file, &page)
}

/// Width of a path in the text (characters).
const SPARKLINE: usize = 32;

fn as_text(loaded: &Loaded, out: Option<&Path>) -> String {
    let mut text = loaded.describe();
    let moving = loaded.set.runs.iter().filter(|run| run.has_readings());
    let curve = loaded.set.kind.curve();
    let line = |run: &Run| curve.map_or_else(|| path(run), |curve| course(run, curve));
    let lines: Vec<String> = moving.map(line).collect();
    if !lines.is_empty() {
        let what = match curve {
            Some(curve) => format!("{} over {}", curve.value.name, curve.along.axis().name),
            None => "depth over time, from first contact".to_owned(),
        };
        text.push_str(&format!("\n{what}\n{}", lines.concat()));
    }
    let agreement = loaded.agreement.describe(&loaded.set);
    if !agreement.is_empty() {
        text.push_str(&format!("\n{agreement}"));
    }
    if let Some(out) = out {
        text.push_str(&format!("\n-> {}\n", out.join(reports::FILE).display()));
    }
    text
}

/// A run as one line: its name, its path and how far that goes.
fn path(run: &Run) -> String {
    let frames = run.frames.iter().filter(|frame| frame.t >= 0.0);
    let points: Vec<(f64, f64)> = frames.map(|frame| (frame.t, frame.z.max(0.0))).collect();
    let deepest = points.iter().fold(0.0_f64, |most, point| most.max(point.1));
    let last = points.last().map_or(0.0, |point| point.0);
    let curve = reports::sparkline(&points, SPARKLINE);
    let (name, deepest, last) = (&run.name, 1e3 * deepest, 1e3 * last);
    format!("  {name:<12} {curve}  {deepest:.2} mm in {last:.1} ms\n")
}

/// A run of a curve as one line likewise: its reading farthest from zero, and how far it goes.
fn course(run: &Run, curve: &Curve) -> String {
    let farthest = run.samples.iter().map(|one| one.value);
    let farthest =
        farthest.fold(0.0_f64, |most, one| if one.abs() > most.abs() { one } else { most });
    let forward = |value: f64| (value * farthest.signum()).max(0.0);
    let points: Vec<(f64, f64)> =
        run.samples.iter().map(|one| (one.at, forward(one.value))).collect();
    let last = points.iter().fold(0.0_f64, |last, point| last.max(point.0));
    let line = reports::sparkline(&points, SPARKLINE);
    let (name, along, value) = (&run.name, curve.along.axis(), curve.value);
    format!(
        "  {name:<12} {line}  {:.2} {} in {:.1} {}\n",
        value.scale * farthest,
        value.unit,
        along.scale * last,
        along.unit
    )
}

fn as_json(loaded: &Loaded) -> Value {
    let set = &loaded.set;
    let with = |role: Role| set.conditions.iter().filter(|one| one.role == role).count();
    let warnings: Vec<String> =
        loaded.warnings.iter().map(|one| one.render(&loaded.sources, Color::Off)).collect();
    let contradictions: Vec<String> = loaded
        .contradictions
        .iter()
        .map(|one| one.diagnostic.render(&loaded.sources, Color::Off))
        .collect();
    json!({
        "set": set.id,
        "valid": loaded.contradictions.is_empty(),
        "conditions": set.conditions.len(),
        "runs": set.runs.len(),
        "fit": with(Role::Fit),
        "holdout": with(Role::Holdout),
        "notes": set.notes,
        "warnings": warnings,
        "zeros": zeros_as_json(loaded),
        "scalars": loaded.agreement.held.iter().map(held_as_json).collect::<Vec<_>>(),
        "contradictions": contradictions,
    })
}

fn zeros_as_json(loaded: &Loaded) -> Value {
    let (set, zeros) = (&loaded.set, &loaded.agreement.zeros);
    let reading = |one: Reading| json!({ "value": one.value, "se": one.se });
    let contacts: Vec<Value> = zeros
        .contacts
        .iter()
        .map(|RunContact { run, contact, is_off, is_slowed }| {
            json!({
                "run": set.runs[*run].name,
                "is_off": is_off,
                "is_slowed": is_slowed,
                "contact_time_s": reading(contact.time),
                "contact_time_between_s": contact.between.map(|t| t.is_finite().then_some(t)),
                "depth_at_zero_m": contact.depth_at_zero.map(reading),
                "depth_at_contact_m": reading(contact.depth),
            })
        })
        .collect();
    let offset = zeros.offset.map(|offset| {
        json!({
            "zero": match offset.zero {
                Zero::Depth => "depth",
                Zero::Clock => "clock",
                Zero::Both => "both",
            },
            "severity": severity(offset.severity),
            "is_common": offset.is_common,
            "contact_time_s": reading(offset.time),
            "surface_m": reading(offset.depth),
        })
    });
    let speeds: Vec<Value> = zeros
        .speeds
        .iter()
        .map(|one| {
            json!({
                "condition": set.conditions[one.condition].id,
                "measured_over_stated": reading(one.ratio),
                "severity": severity(one.severity),
            })
        })
        .collect();
    json!({ "offset": offset, "runs": contacts, "speeds": speeds })
}

fn severity(severity: Severity) -> &'static str {
    match severity {
        Severity::None => "none",
        Severity::Notable => "notable",
        Severity::Wrong => "wrong",
    }
}

fn held_as_json(held: &Held) -> Value {
    let misses: Vec<Value> = held
        .misses
        .iter()
        .map(|miss| {
            json!({
                "definition": miss.definition,
                "off_by": miss.mean.value,
                "se": miss.mean.se,
                "limit": miss.limit,
            })
        })
        .collect();
    json!({
        "number": held.scalar.key(),
        "is_stated": held.is_stated,
        "runs": held.runs,
        "outcome": held.outcome_key(),
        "follows": match held.outcome {
            Outcome::Follows => held.misses.first().map(|miss| miss.definition),
            Outcome::FollowsOther(other) => Some(other),
            _ => None,
        },
        "definitions": misses,
    })
}
