//! `plunge movie`: pictures of an impact, one after another or at times.

use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::ValueEnum;
use engine::units::{Dimension, parse};
use exchange::read::{Keep, ReadError, read_run};
use exchange::run_files::RunFiles;
use reports::movie::{Beside, Film, FilmFormat, MovieError, find_ffmpeg, size_for, write_png};
use reports::scene::{Forces, Impact, Look, Quantity, Scene, SceneError, View};
use runner::run::Summary;
use serde_json::json;

use crate::BEGINS_AGAIN;
use crate::control::stopped;
use crate::output::{self, CommandError, CommandResult};
use crate::signals;

/// Width of a picture without --size (pixels).
const WIDTH: u32 = 960;

/// How long a film without --per-second is to last (s), and how many pictures a second it may show.
const LASTS: f64 = 6.0;
const RATES: [f64; 2] = [5.0, 30.0];

/// Arguments of `plunge movie`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The folder of a run, or its log.
    run: PathBuf,
    /// The file to write: .mp4, .gif or .png (animated); with --at .svg or .png.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// How many frames of the log to show, evenly in time; all without it.
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// What grains are coloured by.
    #[arg(long, value_enum, value_name = "QUANTITY", default_value = "speed", alias = "color")]
    colour: Colour,
    /// From where: the side (a bed in space cut open through the axis of the impact), or above.
    #[arg(long, value_enum, value_name = "SIDE", default_value = "side")]
    from: From,
    /// How thick the slice of a bed in space is, such as 5mm; one and a half mean grain diameters without it.
    #[arg(long, value_name = "LENGTH")]
    slice: Option<String>,
    /// Show the whole bed, not the part around the impact.
    #[arg(long)]
    whole: bool,
    /// Width and height in pixels, such as 1280x720; without it, 960 wide and as high as the bed asks for.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Frames shown in a second; without it, so that the film lasts about 6 s.
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = clap::value_parser!(u32).range(1..=100))]
    per_second: Option<u32>,
    /// A clip of the measured impact to show on the right of an .mp4, at the same pace and with contact at the same moment.
    #[arg(long, value_name = "CLIP", conflicts_with = "at")]
    beside: Option<PathBuf>,
    /// When the body touches the bed in the clip, as it plays, such as 350ms; at its start without it.
    #[arg(long, value_name = "TIME", requires = "beside")]
    beside_contact: Option<String>,
    /// How many frames the camera took in a second, such as 1000Hz; without it the clip is taken to play at the pace of the impact.
    #[arg(long, value_name = "RATE", requires = "beside")]
    beside_rate: Option<String>,
    /// Single pictures at these times, such as 5ms,20ms; contact, greatest and rest are times too.
    #[arg(long, value_name = "TIMES", value_delimiter = ',')]
    at: Vec<String>,
    /// Replace what is there.
    #[arg(long)]
    force: bool,
    /// Print one JSON object to stdout.
    #[arg(long)]
    json: bool,
    /// Print nothing on success.
    #[arg(long)]
    quiet: bool,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum Colour {
    Speed,
    Force,
    Displacement,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
enum From {
    Side,
    Above,
}

/// What a file is by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Mp4,
    Gif,
    Png,
    Svg,
}

pub(crate) fn run(args: &Args) -> CommandResult {
    let kind = kind(args)?;
    let ffmpeg = match kind {
        Kind::Mp4 => {
            Some(find_ffmpeg(&std::env::var_os("PATH").unwrap_or_default()).ok_or_else(no_ffmpeg)?)
        }
        _ => None,
    };
    let slice = args.slice.as_deref().map(|text| quantity(text, "--slice", Dimension::LENGTH));
    let size = args.size.as_deref().map(size).transpose()?;
    let beside = beside(args, kind)?;
    signals::will_be_asked_for();
    let impact = impact(&args.run)?;
    let look = match args.from {
        From::Side => Look::Side,
        From::Above if impact.planar => {
            return Err(CommandError::bad_input(
                "a planar bed is seen from the side alone; leave --from out",
            ));
        }
        From::Above => Look::Above,
    };
    let view = View::of(&impact, look, slice.transpose()?);
    let window = if args.whole { view.whole } else { view.near };
    let frames = frames(args, &impact)?;
    let rate = (frames.len() as f64 / LASTS).clamp(RATES[0], RATES[1]).round() as u32;
    let film = Film {
        impact: &impact,
        window,
        quantity: match args.colour {
            Colour::Speed => Quantity::Speed,
            Colour::Force => Quantity::Force,
            Colour::Displacement => Quantity::Displacement,
        },
        size: size.unwrap_or_else(|| size_for(&window, WIDTH)),
        frames,
        per_second: args.per_second.unwrap_or(rate),
        view,
    };
    if !args.at.is_empty() {
        return stills(args, kind, &film);
    }
    refuse_to_replace(args, &args.out)?;
    let stop: exchange::Stop<'_> = &signals::is_asked_to_stop;
    whole(&args.out, |path| match &ffmpeg {
        Some(ffmpeg) => ffmpeg.write(&film, beside.as_ref(), path, stop),
        None => {
            let format = if kind == Kind::Gif { FilmFormat::Gif } else { FilmFormat::Png };
            let mut file = BufWriter::new(File::create(path)?);
            film.write(format, &mut file, stop)?;
            Ok(file.flush()?)
        }
    })?;
    let (w, h) = film.size;
    let n = film.frames.len();
    tell(
        args,
        &[(args.out.clone(), None)],
        &format!("{n} pictures of {w} x {h}, {} a second", film.per_second),
    )
}

fn kind(args: &Args) -> Result<Kind, CommandError> {
    let ending = args.out.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let stills = !args.at.is_empty();
    match (ending.to_lowercase().as_str(), stills) {
        ("mp4", false) => Ok(Kind::Mp4),
        ("gif", false) => Ok(Kind::Gif),
        ("png", _) => Ok(Kind::Png),
        ("svg", true) => Ok(Kind::Svg),
        ("svg", false) => Err(CommandError::bad_input(
            "an .svg is one picture; say when with --at, such as --at greatest or --at 5ms,20ms",
        )),
        (_, true) => Err(CommandError::bad_input(format!(
            "pictures at single times are .svg or .png, not {}",
            args.out.display()
        ))),
        (_, false) => Err(CommandError::bad_input(format!(
            "a film is .mp4, .gif or .png, not {}",
            args.out.display()
        ))),
    }
}

/// The clip beside the film.
fn beside(args: &Args, kind: Kind) -> Result<Option<Beside>, CommandError> {
    let Some(clip) = &args.beside else { return Ok(None) };
    if kind != Kind::Mp4 {
        return Err(CommandError::bad_input(
            "a clip stands beside an .mp4 alone; name the film so",
        ));
    }
    if !clip.is_file() {
        return Err(CommandError::bad_input(format!("--beside {}: no such file", clip.display())));
    }
    let contact = args.beside_contact.as_deref();
    let contact = contact.map(|text| quantity(text, "--beside-contact", Dimension::TIME));
    let rate = args.beside_rate.as_deref();
    let rate = rate.map(|text| quantity(text, "--beside-rate", Dimension::RATE)).transpose()?;
    if rate.is_some_and(|rate| rate <= 0.0 || !rate.is_finite()) {
        return Err(CommandError::bad_input("--beside-rate: a camera takes some frames a second"));
    }
    Ok(Some(Beside { clip: clip.clone(), contact: contact.transpose()?.unwrap_or(0.0), rate }))
}

fn no_ffmpeg() -> CommandError {
    CommandError::bad_input(
        "an .mp4 needs the program ffmpeg, which is not on the PATH; install it, or write a .gif or a \
         .png (animated), which need nothing",
    )
}

fn quantity(text: &str, of: &str, dimension: Dimension) -> Result<f64, CommandError> {
    parse(text, dimension).map_err(|error| CommandError::bad_input(format!("{of} {text}: {error}")))
}

fn size(text: &str) -> Result<(u32, u32), CommandError> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let fits = |side: u32| (64..=8192).contains(&side) && side.is_multiple_of(2);
    sides.filter(|(w, h)| fits(*w) && fits(*h)).ok_or_else(|| {
        CommandError::bad_input(format!(
            "--size {text}: expected two even numbers from 64 to 8192, such as 1280x720"
        ))
    })
}

/// What the logs of `run` tell.
fn impact(run: &Path) -> Result<Impact, CommandError> {
    let files = RunFiles::so_far(run);
    let bad = |error: SceneError| match error {
        SceneError::Read(error @ ReadError::Damaged { .. }) => CommandError::Failed(error.into()),
        error => CommandError::bad_input(error),
    };
    let log = read_run(&files.log, Keep::All).map_err(|error| bad(error.into()))?;
    if summary(&files.summary)?.is_some_and(|summary| summary.bed.is_none()) {
        return Err(bad(SceneError::NoGrains { path: run.to_owned() }));
    }
    Impact::read(run, Forces::of(&log.loads)).map_err(bad)
}

/// The summary at `path`; none of a run that has not ended.
fn summary(path: &Path) -> Result<Option<Summary>, CommandError> {
    let cannot = || format!("cannot read {}", path.display());
    let text = match std::fs::read(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        read => read.with_context(cannot)?,
    };
    Ok(Some(serde_json::from_slice(&text).with_context(cannot)?))
}

/// The frames to show.
fn frames(args: &Args, impact: &Impact) -> Result<Vec<usize>, CommandError> {
    let logged = impact.times.len();
    match args.frames {
        _ if !args.at.is_empty() => {
            let mut frames = times(args, impact)?;
            frames.sort_unstable();
            frames.dedup();
            Ok(frames)
        }
        Some(n) if n as usize > logged => Err(CommandError::bad_input(format!(
            "--frames {n}: the log holds {logged}; run the model again with more, such as --set \
             log.frames_per_s=1000"
        ))),
        Some(n) => Ok(impact.evenly(n as usize)),
        None => Ok((0..logged).collect()),
    }
}

/// The frame of each --at.
fn times(args: &Args, impact: &Impact) -> Result<Vec<usize>, CommandError> {
    let [contact, greatest, rest] = impact.moments();
    let last = impact.times.last().copied().unwrap_or(0.0);
    let time = |text: &String| match text.trim() {
        "contact" => Ok(contact),
        "greatest" => Ok(greatest),
        "rest" => Ok(rest),
        text => {
            let time = quantity(text, "--at", Dimension::TIME)?;
            match (0.0..=last).contains(&time) {
                true => Ok(impact.frame_at(time)),
                false => Err(CommandError::bad_input(format!(
                    "--at {text}: the log goes from 0 to {:.1} ms",
                    1e3 * last
                ))),
            }
        }
    };
    args.at.iter().map(time).collect()
}

fn stills(args: &Args, kind: Kind, film: &Film<'_>) -> CommandResult {
    let wanted = times(args, film.impact)?;
    let scenes = film.scenes().map_err(failed)?;
    let mut written = Vec::new();
    for (at, text) in args.at.iter().enumerate() {
        let name = still_name(args, text);
        if args.at[..at].iter().any(|other| still_name(args, other) == name) {
            return Err(CommandError::bad_input(format!("--at names {text} twice")));
        }
        refuse_to_replace(args, &name)?;
    }
    for (text, frame) in args.at.iter().zip(&wanted) {
        let Some(scene) = scenes.iter().find(|scene| scene.frame == *frame) else { continue };
        let out = still_name(args, text);
        whole(&out, |path| still(kind, film, scene, path))?;
        written.push((out, Some(scene.time)));
    }
    tell(args, &written, "")
}

fn still(kind: Kind, film: &Film<'_>, scene: &Scene, path: &Path) -> Result<(), MovieError> {
    let sheet = film.sheet(scene);
    match kind {
        Kind::Svg => Ok(std::fs::write(path, sheet.svg())?),
        _ => {
            let mut file = BufWriter::new(File::create(path)?);
            write_png(&sheet.pixels(film.size)?, &mut file)?;
            Ok(file.flush()?)
        }
    }
}

/// `impact.png` at one time; of several, `impact-5ms.png` and so on.
fn still_name(args: &Args, time: &str) -> PathBuf {
    if args.at.len() == 1 {
        return args.out.clone();
    }
    let stem = args.out.file_stem().unwrap_or_default().to_string_lossy();
    let ending = args.out.extension().unwrap_or_default().to_string_lossy();
    let time: String = time.chars().filter(|letter| !letter.is_whitespace()).collect();
    args.out.with_file_name(format!("{stem}-{time}.{ending}"))
}

fn refuse_to_replace(args: &Args, out: &Path) -> CommandResult {
    match out.exists() && !args.force {
        true => Err(CommandError::bad_input(format!(
            "{} exists; choose another --out, or --force to replace it",
            out.display()
        ))),
        false => Ok(()),
    }
}

/// Lets `write` write a file that gets its name once it is whole.
fn whole(out: &Path, write: impl FnOnce(&Path) -> Result<(), MovieError>) -> CommandResult {
    let mut name = out.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    let partial = out.with_file_name(name);
    let written =
        write(&partial).and_then(|()| Ok(std::fs::rename(&partial, out)?)).map_err(|error| {
            match error {
                MovieError::Write(error) => {
                    let shown = format!("cannot write {}", out.display());
                    CommandError::Failed(anyhow::Error::new(error).context(shown))
                }
                error => failed(error),
            }
        });
    if written.is_err() {
        // What could not be written may not be there at all.
        let _ = std::fs::remove_file(&partial);
    }
    written
}

fn failed(error: MovieError) -> CommandError {
    match error {
        MovieError::Stopped => stopped(BEGINS_AGAIN),
        MovieError::TooLarge(..) => CommandError::bad_input(error),
        error => CommandError::Failed(error.into()),
    }
}

/// Says what was written: the files, of a still with the time of its frame.
fn tell(args: &Args, files: &[(PathBuf, Option<f64>)], what: &str) -> CommandResult {
    if args.json {
        let files = files.iter().map(|(path, time)| match time {
            Some(time) => json!({ "file": path.to_string_lossy(), "time_s": time }),
            None => json!({ "file": path.to_string_lossy() }),
        });
        return output::json_to_stdout(&json!({ "files": files.collect::<Vec<_>>() }));
    }
    if args.quiet {
        return Ok(());
    }
    let line = |(path, time): &(PathBuf, Option<f64>)| match time {
        Some(time) => format!("{}: the frame at {:.2} ms\n", path.display(), 1e3 * time),
        None => format!("{}: {what}\n", path.display()),
    };
    output::to_stdout(&files.iter().map(line).collect::<String>())
}
