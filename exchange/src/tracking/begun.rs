//! From files to runs whose paths are known, each by itself.

use std::path::{Path as File, PathBuf};

use super::bodies::{Bodies, Body};
use super::fault::Fault;
use super::grid::{NAMED_ROWS, NO_NUMBERS, NO_TIMES};
use super::motion::{FEWEST, Path};
use super::names::{SET, is_of_run};
use super::settings::Settings;
use super::track::Track;
use super::{inputs, layouts};

/// A run whose path is known, and nothing of the others.
pub(super) struct Begun {
    pub(super) name: String,
    /// Its name with what else tells it apart: folders, files and columns.
    pub(super) called: String,
    pub(super) fields: Vec<(String, String)>,
    pub(super) labels: Vec<(String, String)>,
    pub(super) body: Body,
    pub(super) path: Path,
}

/// Folders around a file that may be called like its body.
const AROUND: usize = 2;

/// The tracks of all files, with the hashes of the files.
pub(super) fn tracks(
    paths: &[PathBuf],
    settings: &Settings<'_>,
) -> Result<(Vec<Track>, Vec<String>), Vec<Fault>> {
    let (mut all, mut hashes, mut faults) = (Vec::new(), Vec::new(), Vec::new());
    let mut others = Vec::new();
    for path in paths {
        let bytes = match inputs::bytes(path) {
            Ok(bytes) => bytes,
            Err(fault) => {
                faults.push(fault);
                continue;
            }
        };
        hashes.push(blake3::hash(&bytes).to_hex().to_string());
        match of_file(path, &bytes, settings) {
            Ok(tracks) => all.extend(tracks),
            Err(fault)
                if [NO_TIMES, NAMED_ROWS].contains(&fault.what.as_str())
                    && Bodies::read(path).is_ok() =>
            {
                let what = "it is a table of bodies, for --bodies".to_owned();
                others.push(Fault { what, ..fault });
            }
            Err(fault) if [NO_NUMBERS, NAMED_ROWS].contains(&fault.what.as_str()) => {
                others.push(fault);
            }
            Err(fault) => faults.push(fault),
        }
    }
    match all.first_mut() {
        // Others beside the tables of drops in a folder.
        Some(first) => first.notes.extend(others.iter().map(left_out)),
        None => faults.append(&mut others),
    }
    leave_out_equal(&mut all);
    if faults.is_empty() { Ok((all, hashes)) } else { Err(faults) }
}

/// The tracks in the file `path` with this content.
fn of_file(path: &File, bytes: &[u8], settings: &Settings<'_>) -> Result<Vec<Track>, Fault> {
    let (mut tracks, mut faults) = (Vec::new(), Vec::new());
    for sheet in inputs::sheets(path, bytes)? {
        match layouts::tracks(&sheet, &settings.columns) {
            Ok(found) => {
                let found = without_short(found).into_iter();
                tracks.extend(found.map(|track| named(track, path)));
            }
            Err(fault) => faults.push(fault),
        }
    }
    // Beside sheets of drops there may be others in a workbook.
    match tracks.first_mut() {
        Some(first) => first.notes.extend(faults.iter().map(left_out)),
        None => faults.pop().map_or(Ok(()), Err)?,
    }
    Ok(tracks)
}

/// A table that is left out beside others, in words.
fn left_out(fault: &Fault) -> String {
    format!("{}: {}, left out", fault.place, fault.what)
}

/// Removes tracks whose positions are those of one before them, on whatever clock: no drop is measured twice.
fn leave_out_equal(tracks: &mut Vec<Track>) {
    let same = |one: &Track, other: &Track| {
        let pairs = || one.samples.iter().zip(&other.samples);
        let equal = |a: f64, b: f64| a.total_cmp(&b).is_eq();
        one.samples.len() == other.samples.len()
            && pairs().all(|(a, b)| equal(a.z, b.z) && equal(a.x, b.x))
    };
    let name = |track: &Track| track.name.as_ref().unwrap_or(&track.stem).clone();
    let mut at = 1;
    while at < tracks.len() {
        let first = tracks[..at].iter().position(|one| same(one, &tracks[at]));
        let Some(first) = first else {
            at += 1;
            continue;
        };
        let twice = tracks.remove(at);
        let of = name(&tracks[first]);
        let note = format!(
            "the readings of {} in {} are those of {of}, left out",
            name(&twice),
            twice.file
        );
        tracks[first].notes.push(note);
    }
}

/// Removes tracks that are too short to be drops, such as spots that a program follows for a few frames, or lines of sums. A
/// table that holds only short tracks keeps them, so that the message about them names the table.
fn without_short(mut tracks: Vec<Track>) -> Vec<Track> {
    let is_short = |track: &Track| track.samples.len() < FEWEST;
    if tracks.iter().all(is_short) {
        return tracks;
    }
    let name = |track: &Track| track.name.clone().unwrap_or_else(|| track.stem.clone());
    let short: Vec<String> = tracks.iter().filter(|one| is_short(one)).map(name).collect();
    tracks.retain(|track| !is_short(track));
    if !short.is_empty() {
        let names = short.join(", ");
        let note = format!("{names}: fewer than {FEWEST} readings, left out");
        tracks.iter_mut().take(1).for_each(|first| first.notes.push(note.clone()));
    }
    tracks
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
pub(super) fn begin(
    tracks: Vec<Track>,
    bodies: &Bodies,
    settings: &Settings<'_>,
) -> Result<Vec<Begun>, Vec<Fault>> {
    let names = names(&tracks);
    refuse_unknown(&settings.leave_out, &names)?;
    let (mut begun, mut faults) = (Vec::new(), Vec::new());
    let called = called(&tracks);
    for (track, (name, called)) in tracks.into_iter().zip(names.into_iter().zip(called)) {
        if settings.leave_out.iter().any(|pattern| pattern.matches(&name)) {
            continue;
        }
        let one = || -> Result<Begun, Fault> {
            let fields = fields(&track, &name, settings)?;
            let mut labels: Vec<_> = fields.iter().chain(&track.labels).cloned().collect();
            let around = within_folders(&track, AROUND);
            let named =
                [&called, &around].into_iter().find_map(|name| bodies.named_in(name, &labels));
            labels.extend(named);
            let body = bodies.of(&name, &labels, settings)?;
            Ok(Begun { path: Path::of(track, settings)?, name, called, fields, labels, body })
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

/// Refuses names of runs to leave out that no run has.
fn refuse_unknown(patterns: &[glob::Pattern], names: &[String]) -> Result<(), Vec<Fault>> {
    let fits = |pattern: &&glob::Pattern| names.iter().any(|name| pattern.matches(name));
    let unknown = patterns.iter().filter(|pattern| !fits(pattern));
    let fault = |pattern: &glob::Pattern| {
        let right = match configs::nearest(pattern.as_str(), names.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("runs: {}", configs::shorten(&names.join(", "))),
        };
        Fault::new("--leave-out", format!("no run is called `{pattern}`"), right)
    };
    let faults: Vec<Fault> = unknown.map(fault).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
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
            (None, _) => within_folders(track, 1).replace('/', "-"),
        };
        let name = name.trim().to_owned();
        let others = (2..).map(|nth| format!("{name}-{nth}"));
        let free = std::iter::once(name.clone()).chain(others).find(|one| !names.contains(one));
        names.extend(free);
    }
    names
}

/// Names of runs behind the folders, files and labels that not all of them have in common, parted by `/`.
fn called(tracks: &[Track]) -> Vec<String> {
    let mut parts: Vec<Vec<String>> = tracks.iter().map(folders_around).collect();
    let shared = |parts: &[Vec<String>]| {
        let first = parts.first().and_then(|own| own.first());
        first.is_some() && parts.iter().all(|own| own.first() == first)
    };
    while shared(&parts) {
        parts.iter_mut().for_each(|own| drop(own.remove(0)));
    }
    let has_files = tracks.iter().any(|track| track.file != tracks[0].file);
    for (track, own) in tracks.iter().zip(&mut parts) {
        if track.called.is_none() {
            own.extend(track.labels.iter().filter_map(|label| telling(label, tracks)));
        }
        match track.called.as_ref().or(track.name.as_ref()) {
            Some(name) if has_files && !name.starts_with(&track.stem) => {
                own.extend([track.stem.clone(), name.clone()])
            }
            Some(name) => own.push(name.clone()),
            None => own.push(track.stem.clone()),
        }
    }
    parts.iter().map(|own| own.join("/")).collect()
}

/// What a label says of the condition of its run: a word, or the number of a quantity that is set, which several of `tracks` have
/// and not all.
fn telling((stem, value): &(String, String), tracks: &[Track]) -> Option<String> {
    let has =
        |track: &&Track| track.labels.iter().any(|(own, other)| own == stem && other == value);
    let several = tracks.iter().filter(has).count();
    let is_number = value.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '.');
    let tells = several > 1 && several < tracks.len() && !is_of_run(stem);
    match is_number {
        _ if !tells => None,
        true => SET.contains(&stem.as_str()).then(|| format!("{stem}{value}").replace(' ', "_")),
        false => Some(value.clone()),
    }
}

/// The name of a run behind those of so many folders around its file, parted by `/`.
fn within_folders(track: &Track, folders: usize) -> String {
    let around = folders_around(track);
    let nearest = around[around.len().saturating_sub(folders)..].iter().map(String::as_str);
    let own = track.name.as_deref().unwrap_or(&track.stem);
    nearest.chain(std::iter::once(own)).collect::<Vec<_>>().join("/")
}

/// The names of the folders around the file of a track.
fn folders_around(track: &Track) -> Vec<String> {
    File::new(&track.file).parent().map_or(Vec::new(), |folder| {
        folder.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    })
}

/// What the pattern says of a run by its name, that of its file or those of the folders around it.
fn fields(
    track: &Track,
    name: &str,
    settings: &Settings<'_>,
) -> Result<Vec<(String, String)>, Fault> {
    let Some(pattern) = &settings.pattern else { return Ok(Vec::new()) };
    let within = within_folders(track, pattern.folders());
    let names = [track.name.as_deref().unwrap_or(name), name, &track.stem, &within];
    names.iter().find_map(|name| pattern.fields(name)).ok_or_else(|| {
        let what = format!("the name `{name}` does not fit {}", pattern.text());
        Fault::new(&track.file, what, "write --condition as the names of files or runs are made")
    })
}
