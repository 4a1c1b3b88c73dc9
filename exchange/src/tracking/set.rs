//! From files to a set.

use std::path::{Path as File, PathBuf};

use configs::engine::units::Dimension;
use measurements::{Frame, Reading};

use super::bodies::{Bodies, Body};
use super::conditions::{self, Member};
use super::fault::{Fault, TrackingError};
use super::motion::{self, Path, Scales};
use super::options::Options;
use super::run::{Run, Set, Understood};
use super::settings::{Settings, Tracked};
use super::surface::{self, Level, Seen, Touch};
use super::track::Track;
use super::{import_file, inputs, layouts, written};

/// Degrees from the vertical up to which a fall counts as vertical: cameras are not held straighter.
const UPRIGHT: f64 = 5.0;

/// A run whose path is known, and nothing of the others.
struct Begun {
    name: String,
    fields: Vec<(String, String)>,
    labels: Vec<(String, String)>,
    body: Body,
    path: Path,
}

/// Reads `paths` under `options` into the set that is to stand in the folder `out`.
///
/// # Errors
/// Everything that is wrong with the options, else with the tables, else with the runs.
pub fn import(paths: &[PathBuf], options: &Options, out: &File) -> Result<Set, TrackingError> {
    let settings = Settings::of(options)?;
    let paths = inputs::expand(paths)?;
    let bodies = match options.get("bodies") {
        Some(path) => Bodies::read(File::new(path))?,
        None => Bodies::default(),
    };
    let (tracks, hashes) = tracks(&paths, &settings)?;
    let begun = begin(tracks, &bodies, &settings)?;
    let (runs, understood, level) = finish(begun, &settings)?;
    let manner = manner(&runs, &settings);
    let notes = notes(&runs, &level, &manner, &settings);
    let known = written::Known { options, settings: &settings, level: &level, runs: &runs, out };
    let mut files = written::files(&known, &notes)?;
    files.push((import_file::IMPORT_FILE, import_file::text(&paths, &hashes, options, out)));
    Ok(Set { understood, notes, files })
}

/// The tracks of all files, with the hashes of the files.
fn tracks(
    paths: &[PathBuf],
    settings: &Settings<'_>,
) -> Result<(Vec<Track>, Vec<String>), Vec<Fault>> {
    let (mut all, mut hashes, mut faults) = (Vec::new(), Vec::new(), Vec::new());
    for path in paths {
        let read = || -> Result<(Vec<Track>, String), Fault> {
            let bytes = inputs::bytes(path)?;
            let mut tracks = Vec::new();
            for sheet in inputs::sheets(path, &bytes)? {
                let found = layouts::tracks(&sheet, &settings.columns)?;
                tracks.extend(found.into_iter().map(|track| named(track, path)));
            }
            Ok((tracks, blake3::hash(&bytes).to_hex().to_string()))
        };
        match read() {
            Ok((tracks, hash)) => {
                all.extend(tracks);
                hashes.push(hash);
            }
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok((all, hashes)) } else { Err(faults) }
}

/// A track of a sheet of its own is called by the file and the sheet.
fn named(track: Track, path: &File) -> Track {
    let stem = path.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    let is_sheet = track.stem != stem;
    match (&track.name, is_sheet) {
        (Some(name), true) => Track { name: Some(format!("{}-{name}", track.stem)), ..track },
        (None, true) => Track { name: Some(track.stem.clone()), ..track },
        (_, false) => track,
    }
}

/// Names, labels, bodies and paths of the runs.
fn begin(
    tracks: Vec<Track>,
    bodies: &Bodies,
    settings: &Settings<'_>,
) -> Result<Vec<Begun>, Vec<Fault>> {
    let names = names(&tracks);
    let (mut begun, mut faults) = (Vec::new(), Vec::new());
    for (track, name) in tracks.into_iter().zip(names) {
        if settings.leave_out.contains(&name) {
            continue;
        }
        let one = || -> Result<Begun, Fault> {
            let fields = fields(&track, &name, settings)?;
            let labels: Vec<_> = fields.iter().chain(&track.labels).cloned().collect();
            let body = bodies.of(&name, &labels, settings)?;
            Ok(Begun { path: Path::of(track, settings)?, name, fields, labels, body })
        };
        match one() {
            Ok(one) => begun.push(one),
            Err(fault) if faults.iter().any(|other: &Fault| other.what == fault.what) => {}
            Err(fault) => faults.push(fault),
        }
    }
    match (begun.is_empty(), faults.is_empty()) {
        (_, false) => Err(faults),
        (true, true) => Err(vec![Fault::new("--leave-out", "no run is left", "leave out fewer")]),
        (false, true) => Ok(begun),
    }
}

/// Names of runs: those of the tables where no two are alike, else behind the name of their file.
fn names(tracks: &[Track]) -> Vec<String> {
    let short: Vec<&str> =
        tracks.iter().map(|one| one.name.as_deref().unwrap_or(&one.stem)).collect();
    let count = |name: &str| short.iter().filter(|other| **other == name).count();
    let mut names: Vec<String> = Vec::new();
    for (track, short) in tracks.iter().zip(&short) {
        let name = match (&track.name, count(short)) {
            (_, 1) => (*short).to_owned(),
            (Some(name), _) => format!("{}-{name}", track.stem),
            (None, _) => track.stem.clone(),
        };
        let name = name.trim().to_owned();
        let same = names.iter().filter(|other| **other == name).count();
        names.push(if same == 0 { name } else { format!("{name}-{}", same + 1) });
    }
    names
}

/// What the pattern says of a run by its name or that of its file.
fn fields(
    track: &Track,
    name: &str,
    settings: &Settings<'_>,
) -> Result<Vec<(String, String)>, Fault> {
    let Some(pattern) = &settings.pattern else { return Ok(Vec::new()) };
    let names = [track.name.as_deref().unwrap_or(name), name, &track.stem];
    names.iter().find_map(|name| pattern.fields(name)).ok_or_else(|| {
        let what = format!("the name `{name}` does not fit {}", pattern.text());
        Fault::new(&track.file, what, "write --condition as the names of files or runs are made")
    })
}

/// Contacts, levels and conditions.
fn finish(
    begun: Vec<Begun>,
    settings: &Settings<'_>,
) -> Result<(Vec<Run>, Vec<Understood>, Level), Vec<Fault>> {
    let paths: Vec<Path> = begun.iter().map(|one| one.path.clone()).collect();
    let (mut faults, mut seen, mut ready) = (Vec::new(), Vec::new(), Vec::new());
    for one in begun {
        match see(&one, &paths, settings) {
            Ok((found, scales, frames, noise)) => {
                seen.push(found);
                ready.push((one, scales, frames, noise));
            }
            Err(fault) if faults.iter().any(|other: &Fault| other.what == fault.what) => {}
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let (level, touches) = surface::touches(&seen, settings.gravity)?;
    let mut runs = Vec::with_capacity(ready.len());
    let mut understood = Vec::with_capacity(ready.len());
    for ((begun, scales, frames, noise), (seen, touch)) in
        ready.into_iter().zip(seen.iter().zip(touches))
    {
        let (run, words) = run(begun, (&scales, &frames, noise), seen, touch);
        runs.push(run);
        understood.push(words);
    }
    drop_heights(&mut runs, settings)?;
    let members: Vec<Member<'_>> = runs.iter().map(member).collect();
    let ids =
        conditions::group(&members, settings.pattern.as_ref()).map_err(|fault| vec![fault])?;
    for ((run, words), id) in runs.iter_mut().zip(&mut understood).zip(ids) {
        words.speed = run.speed;
        words.condition.clone_from(&id);
        run.condition = id;
    }
    Ok((runs, understood, level))
}

fn member(run: &Run) -> Member<'_> {
    let labels = if run.fields.is_empty() { &run.labels } else { &run.fields };
    Member { name: &run.name, labels, body: &run.body, speed: run.speed, angle: run.angle }
}

fn manner(runs: &[Run], settings: &Settings<'_>) -> String {
    let members: Vec<Member<'_>> = runs.iter().map(member).collect();
    conditions::manner(&members, settings.pattern.as_ref())
}

/// What one run shows of itself: its contact, units, path in SI and noise.
fn see(
    one: &Begun,
    paths: &[Path],
    settings: &Settings<'_>,
) -> Result<(Seen, Scales, Vec<Frame>, f64), Fault> {
    let scales = one.path.scales(paths, settings)?;
    let frames = one.path.in_si(&scales);
    let noise = (one.path.noise() * scales.length.1).max(1e-6);
    let shape = one.body.shape.as_str();
    let departure = motion::contact(&frames, (shape, noise), settings.gravity).map_err(|why| {
        let what = format!("the run {}: {why}", one.name);
        Fault::new(
            &one.path.track.file,
            what,
            format!("--leave-out {} goes on without it", one.name),
        )
    })?;
    let below_centre = one.body.below_centre();
    let lift = match (settings.tracked, below_centre, settings.text("surface")) {
        (Tracked::Lowest, ..) | (_, _, None) => 0.0,
        (Tracked::Centre, Some(below), _) => below,
        (Tracked::Centre, None, _) => {
            let what =
                format!("how far the lowest point of a {shape} is below its centre is not known");
            return Err(Fault::new(
                "--tracked",
                what,
                "give the level of the tracked point at contact, or leave --surface out",
            ));
        }
    };
    let stated = settings.position("surface", &one.labels)?;
    let stated = stated.map(|level| one.path.sign * level - lift);
    Ok((Seen { name: one.name.clone(), departure, stated, below_centre }, scales, frames, noise))
}

fn run(
    begun: Begun,
    (scales, frames, noise): (&Scales, &[Frame], f64),
    seen: &Seen,
    touch: Touch,
) -> (Run, Understood) {
    let Begun { name, fields, labels, body, path } = begun;
    let kept = motion::kept(frames, &seen.departure.contact, noise);
    let forward = seen.departure.contact.forward;
    let has_x = path.track.forward.is_some();
    let from_vertical = libm::atan2(forward.value.abs(), touch.sinking.value).to_degrees();
    let is_oblique = has_x && from_vertical > UPRIGHT && forward.value.abs() > 4.0 * forward.se;
    let (way, speed) = match is_oblique {
        true => {
            let value = libm::hypot(touch.sinking.value, forward.value);
            let se =
                libm::hypot(touch.sinking.value * touch.sinking.se, forward.value * forward.se);
            (forward.value.signum(), Reading { value, se: se / value })
        }
        false => (0.0, touch.sinking),
    };
    let before: Vec<&Frame> =
        frames[kept.clone()].iter().filter(|frame| frame.t <= touch.time.value).collect();
    let start = |frame: &&&Frame| frame.x - forward.value * (frame.t - touch.time.value);
    let n = before.len().max(1) as f64;
    let origin = before.iter().map(|frame| start(&frame)).sum::<f64>() / n;
    let counted = |frame: &Frame| Frame {
        t: frame.t - touch.time.value,
        z: frame.z - touch.level.value,
        x: way * (frame.x - origin),
        sigma: None,
    };
    let rows = [path.frames.len(), kept.len()];
    let read = if scales.is_read { ", by the fall" } else { "" };
    let direction = if path.sign > 0.0 { "down" } else { "up" };
    let file = path.track.file.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    let understood = Understood {
        layout: path.track.layout.clone(),
        rows,
        time: format!("{} ({})", path.track.time.name, scales.time.0),
        axis: format!("{} ({}{read}), {direction}", path.track.vertical.name, scales.length.0),
        run: name.clone(),
        condition: String::new(),
        contact: touch.time,
        speed,
        file: file.clone(),
    };
    let run = Run {
        name,
        file,
        fields,
        labels,
        body,
        condition: String::new(),
        touch,
        speed,
        angle: if is_oblique { 90.0 - from_vertical } else { 90.0 },
        noise,
        step: seen.departure.contact.step,
        frames: frames[kept].iter().map(counted).collect(),
    };
    (run, understood)
}

/// Replaces speeds by those of stated heights of release.
fn drop_heights(runs: &mut [Run], settings: &Settings<'_>) -> Result<(), Vec<Fault>> {
    for run in runs {
        let height = settings.quantity("drop_height", Dimension::LENGTH, &run.labels);
        if let Some(height) = height.map_err(|fault| vec![fault])? {
            let value = (2.0 * settings.gravity * height).sqrt();
            let (seen, error) = (run.speed.value, 5.0 * run.speed.se);
            if (seen - value).abs() > error.max(0.12 * value) {
                let what = format!(
                    "the run {} meets the bed at {seen:.3} m/s by its frames, and from {height} m it would at {value:.3}",
                    run.name
                );
                let right = "give the height of the lowest point above the surface at release, or leave it out";
                return Err(vec![Fault::new("--drop-height", what, right)]);
            }
            run.speed = Reading { value, se: 0.0 };
        }
    }
    Ok(())
}

fn notes(runs: &[Run], level: &Level, manner: &str, settings: &Settings<'_>) -> Vec<String> {
    let mut notes = Vec::new();
    notes.push(match level {
        Level::Stated => "Surface: as --surface states it.".to_owned(),
        Level::Common(level) => format!(
            "Surface: one level for all runs, from their contacts, known to {:.2} mm.",
            1e3 * level.se
        ),
        Level::Own => "Surface: a level for each run, from its contact: those of the runs differ by more than their errors.".to_owned(),
    });
    notes.push(format!("Conditions: {manner}."));
    if runs.iter().any(|run| run.angle < 90.0) {
        notes.push(
            "Some impacts are oblique: their angles are those of the paths at contact.".to_owned(),
        );
    }
    if settings.rate.is_some() {
        notes.push("Times are counted by frames at the stated rate.".to_owned());
    }
    notes
}
