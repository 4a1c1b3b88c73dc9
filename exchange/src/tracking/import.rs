//! From tables to a set.

use std::path::{Path as File, PathBuf};

use engine::units::Dimension;
use measurements::{Contact, Frame, Reading, Tip, median};

use super::begun::{Begun, begin, tracks};
use super::bodies::{Bodies, of_named_mass, set_aside};
use super::conditions::{self, Grouping, Member};
use super::fault::{Fault, TrackingError};
use super::lost::lost_from;
use super::motion::{self, Path};
use super::options::Options;
use super::run::Run;
use super::scales::Scales;
use super::set::{Set, Understood};
use super::settings::{Settings, Tracked};
use super::surface::{self, Level, Seen};
use super::tilt::{Flight, tilt, turned_back};
use super::track::{Track, deviation};
use super::{days, falls, import_file, inputs, written};

/// Reads `paths` under `options` into the set that is to stand in the folder `out`.
///
/// # Errors
/// Everything that is wrong with the options, else with the tables, else with the runs.
pub fn import(paths: &[PathBuf], options: &Options, out: &File) -> Result<Set, TrackingError> {
    let settings = Settings::of(options)?;
    // A folder of drops may hold the table of their bodies.
    let paths = inputs::expand(paths, options.get("bodies").map(File::new))?;
    let bodies = match options.get("bodies") {
        Some(path) => Bodies::read(File::new(path))?,
        None => Bodies::default(),
    };
    let (tracks, hashes) = tracks(&paths, &settings)?;
    let begun = begin(tracks, &bodies, &settings)?;
    let mut told = told(&begun);
    told.extend(falls::off_gravity(&begun, &settings).map_err(|fault| vec![fault])?);
    told.extend(falls::of_axes(&begun));
    told.extend(of_one_body(&begun));
    told.extend(begun.iter().find_map(|one| set_aside(&one.name, &one.labels, &settings)));
    told.extend(begun.iter().find_map(|one| of_named_mass(&one.name, &one.body)));
    let Finished { runs, understood, level, tilt, grouping, told: seen } =
        finish(begun, &settings)?;
    told.extend(seen);
    told.extend(tilt.map(of_tilt));
    told.extend(conditions::of_other_depths(&runs, &grouping));
    told.extend(days::told(&runs));
    told.extend(falls::off_their_names(&runs, settings.gravity));
    let mut notes = notes(&runs, &level, &grouping.manner, &settings);
    notes.append(&mut told);
    let known = written::Known { options, settings: &settings, level: &level, runs: &runs, out };
    let mut files = written::files(&known, &notes)?;
    files.push((import_file::IMPORT_FILE, import_file::text(&paths, &hashes, options, out)));
    Ok(Set { understood, notes, files })
}

/// Sentences about what is assumed of the tables, and what is left out of them.
fn told(begun: &[Begun]) -> Vec<String> {
    let tracks = || begun.iter().map(|one| &one.path.track);
    let mut files: Vec<&str> = tracks().map(|track| track.file.as_str()).collect();
    files.dedup();
    let mut all: Vec<String> = Vec::new();
    for file in files {
        let own = || tracks().filter(|track| track.file == file);
        let holes: usize = own().map(|track| track.holes).sum();
        let holes = match holes {
            0 => None,
            1 => Some("1 row without a time or a position is left out".to_owned()),
            n => Some(format!("{n} rows without a time or a position are left out")),
        };
        for note in own().flat_map(|track| &track.notes).chain(&holes) {
            let sentence = format!("{file}: {note}.");
            if !all.contains(&sentence) {
                all.push(sentence);
            }
        }
    }
    all
}

/// A warning if two runs of one table keep their distance: two marks on one body are no repeats.
fn of_one_body(begun: &[Begun]) -> Option<String> {
    let keep_their_distance = |one: &Path, other: &Path| {
        /// Fewest readings on the same lines, and largest scatter of the distance in errors of a reading.
        const LEAST: usize = 20;
        const STEADY: f64 = 1.3;
        /// Least distance of two marks, in errors of a reading.
        const APART: f64 = 10.0;
        let apart: Vec<f64> =
            one.track.beside(&other.track).map(|[one, other]| one - other).collect();
        let noise = libm::hypot(one.noise(), other.noise());
        // Repeats that are let go together keep none.
        let is_apart = median(apart.iter().map(|one| one.abs())) > Some(APART * noise);
        apart.len() >= LEAST && is_apart && deviation(&apart) < STEADY * noise
    };
    let pairs = (0..begun.len()).flat_map(|at| begun[..at].iter().map(move |one| (one, at)));
    let mut pairs = pairs.map(|(one, at)| (one, &begun[at]));
    let is_one = |(one, other): &(&Begun, &Begun)| {
        let [a, b] = [one, other].map(|one| &one.path.track);
        a.file == b.file
            && a.time.name == b.time.name
            && keep_their_distance(&one.path, &other.path)
    };
    pairs.find(is_one).map(|(one, other)| {
        format!(
            "Warning: the runs {} and {} of {} keep their distance to within their noise. If they are two marks on one body, leave \
             one out: --leave-out \"{}\".",
            one.name,
            other.name,
            other.path.track.file,
            match &other.path.track.name {
                Some(name) if *name != other.name => format!("*{name}"),
                _ => other.name.clone(),
            }
        )
    })
}

/// A note about the point of bodies of several sizes that was tracked, if contacts show it.
fn of_the_point(tracked: Option<Tracked>) -> String {
    match tracked {
        Some(point) => {
            let point = if point == Tracked::Centre { "centre" } else { "lowest point" };
            format!(
                "Bodies differ in size. Their contacts lie at one level if the {point} was tracked, which is assumed. \
                 --tracked lowest or --tracked centre says it."
            )
        }
        None => "Warning: bodies differ in size, and their contacts do not show which point was tracked: the lowest is assumed. \
                 Say --tracked lowest or --tracked centre."
            .to_owned(),
    }
}

/// A note about a camera that was not level.
fn of_tilt(tilt: Reading) -> String {
    let [angle, se] = [tilt.value, tilt.se].map(|one| one.abs().to_degrees());
    format!(
        "The camera is tilted by {angle:.2} ± {se:.2} deg: before contact the bodies accelerate sideways in its picture. The paths \
         are turned back around their contacts."
    )
}

/// One run as its picture shows it.
struct Sight {
    seen: Seen,
    scales: Scales,
    /// Its path in SI.
    frames: Vec<Frame>,
    /// Error of one reading (m).
    noise: f64,
    /// A warning about a tracker that lost the body.
    lost: Option<String>,
    /// How far it rises above the surface again (m), if it does.
    rebound: Option<f64>,
}

/// How far the picture of a run is turned back, and around which place (way and depth in m).
struct Turn {
    tilt: f64,
    around: [f64; 2],
}

impl Sight {
    /// Around its contact, whose depth stays what it is.
    fn turn(&self, tilt: f64) -> Turn {
        let contact = &self.seen.departure.contact;
        let apart = |frame: &Frame| (frame.t - contact.time.value).abs();
        let nearest = self.frames.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        Turn { tilt, around: [nearest.map_or(0.0, |frame| frame.x), contact.depth.value] }
    }
}

/// All runs, and what they have in common.
struct Finished {
    runs: Vec<Run>,
    understood: Vec<Understood>,
    level: Level,
    /// That of the camera (rad), which is turned back.
    tilt: Option<Reading>,
    grouping: Grouping,
    /// Warnings.
    told: Vec<String>,
}

/// Contacts, levels and conditions.
fn finish(begun: Vec<Begun>, settings: &Settings<'_>) -> Result<Finished, Vec<Fault>> {
    let paths: Vec<Path> = begun.iter().map(|one| one.path.clone()).collect();
    let mut sights = see_all(&begun, (&paths, &[]), settings)?;
    let tilt = tilt_of(&sights, &begun, settings.gravity);
    if let Some(tilt) = tilt {
        let turns: Vec<Turn> = sights.iter().map(|sight| sight.turn(tilt.value)).collect();
        sights = see_all(&begun, (&paths, &turns), settings)?;
    }
    let seen: Vec<Seen> = sights.iter().map(|sight| sight.seen.clone()).collect();
    let point = settings.tracked.or_else(|| surface::tracked_point(&seen));
    let (level, touches) =
        surface::touches(&seen, settings.gravity, point.unwrap_or(Tracked::Lowest))?;
    let mut runs = Vec::with_capacity(begun.len());
    let mut understood = Vec::with_capacity(begun.len());
    let mut told: Vec<String> = Vec::new();
    if settings.tracked.is_none() && surface::depends_on_the_point(&seen) {
        told.push(of_the_point(point));
    }
    let rebounds = sights.iter().zip(&begun);
    let rebounds = rebounds.filter_map(|(sight, one)| Some((one.name.clone(), sight.rebound?)));
    told.extend(of_rebounds(&rebounds.collect::<Vec<_>>()));
    for (begun, (sight, touch)) in begun.into_iter().zip(sights.iter().zip(touches)) {
        let Sight { seen, scales, frames, noise, lost, .. } = sight;
        told.extend(lost.clone());
        let (run, words) = Run::of(begun, (scales, frames, *noise), seen, touch);
        runs.push(run);
        understood.push(words);
    }
    told.extend(drop_heights(&mut runs, settings)?);
    let members: Vec<Member<'_>> = runs.iter().map(member).collect();
    let grouping =
        conditions::group(&members, settings.pattern.as_ref()).map_err(|fault| vec![fault])?;
    told.extend(conditions::of_no_repeats(&members, &grouping));
    for ((run, words), id) in runs.iter_mut().zip(&mut understood).zip(&grouping.ids) {
        words.speed = run.speed;
        words.condition.clone_from(id);
        run.condition.clone_from(id);
    }
    Ok(Finished { runs, understood, level, tilt, grouping, told })
}

/// What the runs show of themselves, their pictures turned back by `turns`, if there are any.
fn see_all(
    begun: &[Begun],
    (paths, turns): (&[Path], &[Turn]),
    settings: &Settings<'_>,
) -> Result<Vec<Sight>, Vec<Fault>> {
    let (mut faults, mut sights) = (Vec::new(), Vec::with_capacity(begun.len()));
    for (at, one) in begun.iter().enumerate() {
        match see(one, (paths, turns.get(at)), settings) {
            Ok(sight) => sights.push(sight),
            Err(fault) if faults.iter().any(|other: &Fault| other.what == fault.what) => {}
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(sights) } else { Err(faults) }
}

/// The tilt of the camera (rad), where runs have ways that show it.
fn tilt_of(sights: &[Sight], begun: &[Begun], gravity: f64) -> Option<Reading> {
    let with_ways = sights.iter().zip(begun).filter(|(_, one)| one.path.track.forward.is_some());
    let flight = |(sight, one): (&Sight, &Begun)| {
        let contact = &sight.seen.departure.contact;
        let frames = one.path.of_the_body(&sight.frames);
        (frames, [contact.first, contact.time.value - contact.step])
    };
    let flights: Vec<(Vec<Frame>, [f64; 2])> = with_ways.map(flight).collect();
    let flights = flights.iter().map(|(frames, between)| Flight { frames, between: *between });
    tilt(&flights.collect::<Vec<_>>(), gravity)
}

fn member(run: &Run) -> Member<'_> {
    let labels = if run.fields.is_empty() { &run.labels } else { &run.fields };
    let (name, called) = (&run.name, &run.called);
    Member { name, called, labels, body: &run.body, speed: run.speed, angle: run.angle.value }
}

/// What one run shows of itself, its picture turned back by `turn`.
fn see(
    one: &Begun,
    (paths, turn): (&[Path], Option<&Turn>),
    settings: &Settings<'_>,
) -> Result<Sight, Fault> {
    let scales = one.path.scales(paths, settings)?;
    let mut frames = scales.in_si(&one.path);
    if let Some(Turn { tilt, around }) = turn {
        frames = turned_back(&frames, *tilt, *around);
    }
    let lost = lost_from(&frames).map(|(at, speed)| {
        frames.truncate(at);
        format!(
            "Warning: the tracker loses the body of {} at {speed:.1} m/s: from one frame on its position never changes. The readings \
             from there are left out, and no final depth is read.",
            one.name
        )
    });
    let noise = (one.path.noise() * scales.length.1).max(1e-6);
    let shape = one.body.shape.as_str();
    let of_the_body = one.path.of_the_body(&frames);
    refuse_far(&of_the_body, one, &scales)?;
    let below_centre = one.body.below_centre();
    let lift = match (settings.tracked, below_centre, settings.text("surface")) {
        (Some(Tracked::Centre), Some(below), Some(_)) => below,
        (Some(Tracked::Centre), None, Some(_)) => {
            let what =
                format!("how far the lowest point of a {shape} is below its centre is not known");
            return Err(Fault::new(
                "--tracked",
                what,
                "give the level of the tracked point at contact, or leave --surface out",
            ));
        }
        _ => 0.0,
    };
    let stated = settings.position("surface", &one.labels)?;
    let stated = stated.map(|level| one.path.sign * level - lift);
    let sees_surface = stated.is_some_and(|level| of_the_body[0].z < level);
    let departure = motion::contact(
        &of_the_body,
        (Tip::new(&one.body.shape, one.body.diameter, one.body.apex), noise),
        (settings.gravity, sees_surface),
    )
    .map_err(|why| {
        let tracker = if lost.is_some() {
            " (the tracker loses the body: from one frame on its position never changes)"
        } else {
            ""
        };
        let what = format!("the run {}: {why}{tracker}", one.name);
        let name = match one.name.contains(' ') {
            true => format!("\"{}\"", one.name),
            false => one.name.clone(),
        };
        let by_hand = match why.starts_with("no free fall") {
            true => {
                "; a set of data from contact on is written by hand: `plunge new --list` shows some"
            }
            false => "",
        };
        let right = format!("--leave-out {name} goes on without it{by_hand}");
        Fault::new(&one.path.track.file, what, right)
    })?;
    refuse_shallow(&of_the_body, departure.contact.depth.value, one, &scales)?;
    let fall = (settings.gravity, one.body.diameter);
    motion::refuse_several(&of_the_body, (&departure.contact, noise), fall, &one.path.track)?;
    let soft = one.body.soft_entry();
    let diameter = one.body.diameter;
    let rebound =
        rebound(&of_the_body, &departure.contact, REBOUND.0 * diameter + REBOUND.1 * noise);
    let seen = Seen { name: one.name.clone(), departure, stated, soft, diameter, below_centre };
    Ok(Sight { seen, scales, frames, noise, lost, rebound })
}

/// Diameters, and errors of a reading, from which a body that rises has left the bed.
const REBOUND: (f64, f64) = (0.25, 10.0);

/// How far the body rises above its `contact` after it (m), if by more than `least`.
fn rebound(frames: &[Frame], contact: &Contact, least: f64) -> Option<f64> {
    let behind = frames.iter().filter(|frame| frame.t > contact.time.value);
    let rise = contact.depth.value - behind.map(|frame| frame.z).fold(f64::INFINITY, f64::min);
    Some(rise).filter(|rise| *rise > least)
}

/// A warning about bodies that leave the bed again: their runs with how far (m).
fn of_rebounds(runs: &[(String, f64)]) -> Option<String> {
    let each: Vec<String> =
        runs.iter().map(|(name, rise)| format!("{name} ({:.1} mm)", 1e3 * rise)).collect();
    (!each.is_empty()).then(|| {
        format!(
            "Warning: after contact the body rises above the surface again in {}. No force law here throws a body out: end these \
             clips where it leaves the bed, or leave the runs out.",
            configs::shorten(&each.join(", "))
        )
    })
}

/// Refuses units in which the body moves implausibly far.
fn refuse_far(frames: &[Frame], one: &Begun, scales: &Scales) -> Result<(), Fault> {
    /// Longest path, in diameters.
    const FAR: f64 = 400.0;
    let ends = frames.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], frame| {
        [low.min(frame.z), high.max(frame.z)]
    });
    let (way, diameter) = (ends[1] - ends[0], one.body.diameter);
    if way <= FAR * diameter {
        return Ok(());
    }
    let what = format!(
        "in {} and {} the body of {:.4} mm moves {way:.1} m",
        scales.length.0,
        scales.time.0,
        1e3 * diameter
    );
    let right = "is the clip played slowly? --rate 1000Hz counts frames; else --length-unit, --time-unit, --diameter";
    Err(Fault::new(&one.path.track.file, what, right))
}

/// Refuses units that the fall told and in which the body hardly goes into the bed, whose surface is at the depth `surface` (m):
/// a clip that is played slowly falls as one of a far smaller world does.
fn refuse_shallow(
    frames: &[Frame],
    surface: f64,
    one: &Begun,
    scales: &Scales,
) -> Result<(), Fault> {
    /// Least depth, in diameters.
    const SHALLOW: f64 = 0.02;
    let deepest = frames.iter().map(|frame| frame.z).fold(f64::NEG_INFINITY, f64::max) - surface;
    if !scales.is_read || deepest >= SHALLOW * one.body.diameter {
        return Ok(());
    }
    let Track { time, vertical, file, .. } = &one.path.track;
    let what = format!(
        "nothing states the units of `{}` and `{}`; in {} and {}, which the fall before contact allows, the body of {:.4} mm goes \
         {:.2} mm into the bed",
        time.name,
        vertical.name,
        scales.time.0,
        scales.length.0,
        1e3 * one.body.diameter,
        1e3 * deepest
    );
    let right = "is the clip played slowly? --rate 1000Hz, the rate that it was taken at, counts frames; else --time-unit and \
                 --length-unit";
    Err(Fault::new(file, what, right))
}

/// Error of a height of release (m).
const READ: f64 = 1e-3;

/// Replaces speeds by those of stated heights of release.
fn drop_heights(runs: &mut [Run], settings: &Settings<'_>) -> Result<Option<String>, Vec<Fault>> {
    /// Standard errors, and share of the speed, beyond which the frames say another height.
    const CLEAR: (f64, f64) = (3.0, 0.02);
    let mut warning = None;
    for run in runs {
        let height = settings.quantity("drop_height", Dimension::LENGTH, &run.labels);
        if let Some(height) = height.map_err(|fault| vec![fault])? {
            let value = (2.0 * settings.gravity * height).sqrt();
            let Reading { value: seen, se } = run.speed;
            let (off, error) =
                ((seen - value).abs(), CLEAR.0 * libm::hypot(se, settings.gravity * READ / value));
            let both = || {
                format!(
                    "the run {} meets the bed at {seen:.3} ± {se:.3} m/s by its frames, and from {height} m it would at {value:.3}",
                    run.name
                )
            };
            if off > error.max(0.12 * value) {
                let right = "give the height of the lowest point above the surface at release, or leave it out";
                return Err(vec![Fault::new("--drop-height", both(), right)]);
            }
            if off > error.max(CLEAR.1 * value) && warning.is_none() {
                warning = Some(format!(
                    "Warning: {}, which is taken. Is it the height of the lowest point? Without --drop-height the frames tell.",
                    both()
                ));
            }
            run.speed = Reading { value, se: settings.gravity * READ / value };
        }
    }
    Ok(warning)
}

fn notes(runs: &[Run], level: &Level, manner: &str, settings: &Settings<'_>) -> Vec<String> {
    let mut notes = Vec::new();
    notes.push(match level {
        Level::Stated(error) if *error > surface::STATED => format!(
            "Surface: as --surface states it. The bodies are braked up to {:.2} mm from there, which is taken for its error.",
            1e3 * error
        ),
        Level::Stated(_) => "Surface: as --surface states it.".to_owned(),
        Level::Common(level) => {
            let of = match runs.len() {
                1 => "from the contact",
                _ => "one level for all runs, from their contacts",
            };
            format!("Surface: {of}, known to {:.2} mm.", 1e3 * level.se)
        }
        Level::Own(shared) => format!(
            "Surface: a level for each run, from its contact: those of the runs differ by more than their errors. All may be off \
             by {:.2} mm together.",
            1e3 * shared
        ),
    });
    notes.push(format!("Conditions: {manner}."));
    if runs.iter().any(|run| run.angle.value < 90.0) {
        notes.push(
            "Some impacts are oblique: their angles are those of the paths at contact.".to_owned(),
        );
    }
    if settings.rate.is_some() {
        notes.push("Times are counted by frames at the stated rate.".to_owned());
    }
    notes
}
