//! A track as a path in SI: order and clock of its readings, which way is down, units, and first contact.

use measurements::{Contact, Departure, Fall, Frame, Reading, Tip, median, stray_frames};

use super::axis;
use super::even::{undo_jitter, undo_rounding};
use super::fault::Fault;
use super::heading::Role;
use super::mixed;
use super::settings::Settings;
use super::track::{Sample, Track};
use super::units::Unit;

/// Fewest readings of a drop.
pub(super) const FEWEST: usize = 8;

/// Relative error of an acceleration up to which it tells units.
const TELLS: f64 = 0.1;

/// A path whose depths count downward, in the units of its table.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pub(super) track: Track,
    /// Times (s where a rate was given), depths and ways.
    pub(super) frames: Vec<Frame>,
    /// Which of them are not of the body.
    stray: Vec<bool>,
    /// 1 where the axis of the table counts downward, -1 upward.
    pub(super) sign: f64,
    fall: Option<Fall>,
}

impl Path {
    /// The path of a track.
    ///
    /// # Errors
    /// If its times repeat or run back, or it never moves.
    pub(super) fn of(mut track: Track, settings: &Settings<'_>) -> Result<Self, Fault> {
        let counts_rows = counts_rows(&track, settings);
        let samples = in_order(&mut track, settings, counts_rows)?;
        let clock = clock(&samples, &track, settings, counts_rows);
        let with = |sign: f64| -> Vec<Frame> {
            let frame = |(sample, t): (&Sample, &f64)| Frame {
                t: *t,
                z: sign * sample.z,
                x: sample.x,
                sigma: None,
            };
            samples.iter().zip(&clock).map(frame).collect()
        };
        let (down, up) = (with(1.0), with(-1.0));
        let stray = stray_frames(&down, measurements::reading_noise(&down));
        note_stray(&mut track, &samples, &stray);
        let falls = [&down, &up].map(|frames| Fall::of_frames(&but(frames, &stray)));
        let speed = |at: usize| falls[at].map_or(0.0, |fall| fall.velocity);
        let sign = settings.sign.unwrap_or(if speed(0) >= speed(1) { 1.0 } else { -1.0 });
        if settings.columns.of(Role::Vertical).is_none() {
            axis::refuse_other(&track, &down, falls)?;
        }
        if let Some(sign) = settings.sign {
            axis::refuse_other_way(&track, sign, falls)?;
        }
        let [down_fall, up_fall] = falls;
        let (frames, fall) = if sign > 0.0 { (down, down_fall) } else { (up, up_fall) };
        Ok(Self { track, frames, stray, sign, fall })
    }

    /// Those of `frames`, which are its own in other units, that are of the body.
    pub(super) fn of_the_body(&self, frames: &[Frame]) -> Vec<Frame> {
        but(frames, &self.stray)
    }

    /// Its acceleration before contact, if that is known well enough to tell units.
    pub(super) fn acceleration(&self) -> Option<f64> {
        let read = self.fall?.acceleration;
        (read.value > 0.0 && read.se < TELLS * read.value).then_some(read.value)
    }

    /// Whether its acceleration before contact, over what it should be, differs from 1 by more than `allowed` and than its error.
    pub(super) fn is_off(&self, ratio: f64, allowed: f64) -> bool {
        const CLEAR: f64 = 4.0;
        let relative = self.fall.map_or(0.0, |fall| fall.acceleration.se / fall.acceleration.value);
        (ratio - 1.0).abs() > allowed.max(CLEAR * relative * ratio)
    }

    /// Its acceleration before contact, if it falls.
    pub(super) fn fall(&self) -> Option<Reading> {
        Some(self.fall?.acceleration)
    }

    /// Error of one of its readings of a position, in its unit.
    pub(super) fn noise(&self) -> f64 {
        self.fall.map_or_else(|| measurements::reading_noise(&self.frames), |fall| fall.noise)
    }
}

/// `frames` without those that are `stray`.
fn but(frames: &[Frame], stray: &[bool]) -> Vec<Frame> {
    frames.iter().zip(stray).filter(|(_, stray)| !**stray).map(|(frame, _)| *frame).collect()
}

/// Says which readings are not of the body.
fn note_stray(track: &mut Track, samples: &[Sample], stray: &[bool]) {
    /// Lines that are listed.
    const LISTED: usize = 5;
    let lines = samples.iter().zip(stray).filter(|(_, stray)| **stray).map(|(one, _)| one.line);
    let lines: Vec<String> = lines.map(|line| line.to_string()).collect();
    let more = if lines.len() > LISTED { ", …" } else { "" };
    let listed = format!("{}{more}", lines[..lines.len().min(LISTED)].join(", "));
    match lines.len() {
        0 => {}
        1 => track.notes.push(format!(
            "the reading on line {listed} is not of the body; it is left out when the contact is sought"
        )),
        n => track.notes.push(format!(
            "{n} readings are not of the body (lines {listed}): the contact is sought without them"
        )),
    }
}

/// Whether the rows of one drop are out of order: no part of them goes back as far as a second drop would.
fn is_out_of_order(samples: &[Sample]) -> bool {
    let backs = (1..samples.len()).filter(|&at| samples[at].t < samples[at - 1].t);
    let backs: Vec<usize> = backs.collect();
    let ends = backs.iter().skip(1).copied().chain([samples.len()]);
    let begins_a_drop = |(&at, end): (&usize, usize)| {
        let passed = samples[..at].iter().rev().take_while(|one| one.t > samples[at].t).count();
        end - at >= FEWEST && passed >= FEWEST
    };
    !backs.is_empty() && !backs.iter().zip(ends).any(begins_a_drop)
}

/// Whether the clock goes back to its start before the reading `at`, and the body goes on as if nothing were: its steps there
/// are those around.
fn starts_again(samples: &[Sample], at: usize) -> bool {
    let step = |at: usize| Some((samples.get(at)?.z - samples.get(at.checked_sub(1)?)?.z).abs());
    let Some((here, [before, after])) =
        step(at).zip(step(at - 1).zip(step(at + 1)).map(<[f64; 2]>::from))
    else {
        return false;
    };
    samples[at].t < samples[at - 1].t && here <= 2.0 * before.max(after)
}

/// Whether the rate of frames tells the times of rows: those of the table are of a coarse clock.
fn counts_rows(track: &Track, settings: &Settings<'_>) -> bool {
    /// Fewest times of a coarse clock that repeat the one before, and their least share.
    const SEVERAL: usize = 3;
    const MANY: f64 = 0.05;
    let pairs = track.samples.windows(2);
    let repeated = pairs.filter(|pair| pair[0].t.total_cmp(&pair[1].t).is_eq()).count();
    let is_coarse = repeated >= SEVERAL && repeated as f64 > MANY * track.samples.len() as f64;
    settings.rate.is_some()
        && (track.time.unit == Unit::Clock || is_coarse && !counts_frames(track, settings))
}

/// Whether the clock of the table counts frames.
fn counts_frames(track: &Track, settings: &Settings<'_>) -> bool {
    settings.time_unit.as_ref().unwrap_or(&track.time.unit) == &Unit::Frame
}

/// Whether times that scatter around the rows were noise, and have become even.
fn is_made_even(track: &mut Track) -> bool {
    let Some(off) = undo_jitter(&mut track.samples) else { return false };
    let unit = in_words(&track.time.unit);
    track.notes.push(format!(
        "its times are off by {off:.2e}{unit}, by the path: its rows are evenly spaced"
    ));
    true
}

/// A unit behind a number, if it is stated.
fn in_words(unit: &Unit) -> String {
    match unit {
        Unit::Unstated => String::new(),
        unit => format!(" {}", unit.word()),
    }
}

/// Refuses readings of several bodies that take turns.
fn refuse_mixed(track: &Track) -> Result<(), Fault> {
    let Some(bodies) = mixed::bodies(&track.samples) else { return Ok(()) };
    let name = track.name.as_ref().unwrap_or(&track.stem);
    let what =
        format!("{name} has {bodies} positions per time: the rows of {bodies} bodies take turns");
    let right = format!(
        "add a column that labels the bodies (--column run=NAME), or go on without: --leave-out \"{name}\""
    );
    Err(Fault::new(&track.file, what, right))
}

/// The readings in the order of time; copies of one are dropped.
fn in_order(
    track: &mut Track,
    settings: &Settings<'_>,
    counts_rows: bool,
) -> Result<Vec<Sample>, Fault> {
    let has_clock = !counts_rows && !counts_frames(track, settings);
    if !counts_rows && is_out_of_order(&track.samples) && !(has_clock && is_made_even(track)) {
        track.samples.sort_by(|a, b| a.t.total_cmp(&b.t));
        track.notes.push("its rows are sorted by time".to_owned());
    }
    refuse_mixed(track)?;
    if has_clock {
        match undo_rounding(&mut track.samples) {
            Some(quantum) => {
                let unit = in_words(&track.time.unit);
                track.notes.push(format!(
                    "its times are rounded to {quantum}{unit}: its rows are evenly spaced"
                ));
            }
            None => drop(is_made_even(track)),
        }
    }
    let (mut samples, copies) = in_turn(track, counts_rows)?;
    let repeated = without_repeated(&mut samples);
    if repeated > 0 {
        let (frames, repeat, are) = match repeated {
            1 => ("frame", "repeats", "is"),
            _ => ("frames", "repeat", "are"),
        };
        track.notes.push(format!(
            "{repeated} {frames} that {repeat} the position before, while the body moves, {are} left out"
        ));
    }
    if copies > 0 {
        track.notes.push(format!("{copies} readings that repeat the one before are left out"));
    }
    if samples.is_empty() {
        let what = format!(
            "no row has a time and a position in the columns `{}` and `{}`",
            track.time.name, track.vertical.name
        );
        let right = "name the columns that have them: --column t=NAME --column z=NAME";
        return Err(Fault::new(&track.file, what, right));
    }
    if samples.len() < FEWEST {
        let whose = track.name.as_ref().map_or(String::new(), |name| format!("the run {name}: "));
        let what = format!("{whose}{} readings are too few to see a drop in", samples.len());
        let right = format!("a drop takes {FEWEST} at least, some of them before contact");
        return Err(Fault::new(&track.file, what, right));
    }
    Ok(samples)
}

/// The readings of `track` as long as time goes on, and how many copies were dropped.
fn in_turn(track: &Track, counts_rows: bool) -> Result<(Vec<Sample>, usize), Fault> {
    let mut samples: Vec<Sample> = Vec::with_capacity(track.samples.len());
    let mut copies = 0;
    for (at, sample) in track.samples.iter().enumerate() {
        let Some(last) = samples.last() else {
            samples.push(*sample);
            continue;
        };
        let is_copy = same(sample.t, last.t) && same(sample.z, last.z) && same(sample.x, last.x);
        // A coarse clock repeats its times, and a body at rest repeats its positions; some trackers write the first frame twice.
        if sample.t > last.t {
            samples.push(*sample);
        } else if counts_rows && is_copy && samples.len() == 1 {
            samples[0] = *sample;
            copies += 1;
        } else if counts_rows && same(sample.t, last.t) {
            samples.push(*sample);
        } else if is_copy {
            copies += 1;
        } else if starts_again(&track.samples, at) {
            let step = (last.t - samples[0].t) / (samples.len() - 1) as f64;
            let what = format!("the clock starts again ({}, behind {})", sample.t, last.t);
            let lost = last.t + step - sample.t;
            let right = format!("add {lost:.4} to the times from here on");
            return Err(Fault::new(&track.file, what, right).at(sample.line));
        } else {
            return Err(out_of_turn(track, sample, last));
        }
    }
    Ok((samples, copies))
}

/// That `sample` is not later than the one that was the `last` before it.
fn out_of_turn(track: &Track, sample: &Sample, last: &Sample) -> Fault {
    let (what, right) = match (same(sample.t, last.t), &track.time.unit) {
        (true, Unit::Clock) => {
            ("a time is listed twice", "its clock is too coarse: --rate 240Hz counts rows instead")
        }
        (true, _) => (
            "a time is listed twice with other positions",
            "keep one of the rows; if times are rounded, --rate 650Hz counts rows instead",
        ),
        (false, _) if track.name.is_some() => {
            ("the time runs back", "sort the rows of the run by time")
        }
        (false, _) => (
            "the time runs back",
            "sort the rows of one drop by time; several drops in one table need a column `run`",
        ),
    };
    let what = format!("{what} ({}, behind {} on line {})", sample.t, last.t, last.line);
    Fault::new(&track.file, what, right).at(sample.line)
}

fn same(a: f64, b: f64) -> bool {
    a.total_cmp(&b).is_eq()
}

/// Share of the longest step between two readings above which a body moves.
const MOVES: f64 = 0.1;

/// Takes readings out that repeat the position before them where the body moves on both sides, and counts them: a video that
/// was stored at another rate shows some frames twice.
fn without_repeated(samples: &mut Vec<Sample>) -> usize {
    let step = |pair: &[Sample]| (pair[1].z - pair[0].z).abs();
    let steps = || samples.windows(2).map(step);
    let longest = steps().fold(0.0, f64::max);
    // A body that moves by less than a pixel per frame repeats positions too.
    let pixel = steps().filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let moves = |pair: &[Sample]| step(pair) > (MOVES * longest).max(2.0 * pixel);
    let is_repeated = |at: usize| match samples.get(at.wrapping_sub(2)..at + 2) {
        Some([earlier, before, here, next]) => {
            same(before.z, here.z)
                && same(before.x, here.x)
                && moves(&[*earlier, *before])
                && moves(&[*here, *next])
        }
        _ => false,
    };
    let kept: Vec<bool> = (0..samples.len()).map(|at| !is_repeated(at)).collect();
    let all = samples.len();
    let mut kept = kept.into_iter();
    samples.retain(|_| kept.next().unwrap_or(true));
    all - samples.len()
}

/// Times of the readings: in s where the rate of frames is given, else in the unit of the table.
fn clock(
    samples: &[Sample],
    track: &Track,
    settings: &Settings<'_>,
    counts_rows: bool,
) -> Vec<f64> {
    let Some(rate) = settings.rate else { return samples.iter().map(|one| one.t).collect() };
    match track.time.unit {
        Unit::Frame => samples.iter().map(|one| one.t / rate).collect(),
        _ if counts_rows => {
            // Rows without a reading are counted. Where drops alternate, the rows of one drop are several lines apart.
            let lines = || samples.iter().map(|one| one.line);
            let gaps = lines().zip(lines().skip(1)).map(|(one, next)| next.abs_diff(one));
            let apart = gaps.filter(|gap| *gap > 0).min().unwrap_or(1) as f64;
            let first = lines().next().unwrap_or(0);
            lines().map(|line| line.abs_diff(first) as f64 / apart / rate).collect()
        }
        _ => {
            // The clip counts time in another way: its steps are frames.
            let steps = samples.windows(2).map(|pair| pair[1].t - pair[0].t);
            let step = median(steps).unwrap_or(rate.recip());
            samples.iter().map(|one| ((one.t - samples[0].t) / step).round() / rate).collect()
        }
    }
}

/// First contact on a path in SI whose readings are good to `noise` (m), of a body with this `tip`. If the path is
/// known to begin above the surface (`sees_surface`), the frames need not show free fall.
///
/// # Errors
/// What its frames lack.
pub(super) fn contact(
    frames: &[Frame],
    (tip, noise): (Tip, f64),
    (gravity, sees_surface): (f64, bool),
) -> Result<Departure, &'static str> {
    let departure = Departure::of_frames(frames, tip, gravity, noise)
        .ok_or("too few frames are near the greatest speed to see a contact")?;
    let contact = &departure.contact;
    let end = &frames[frames.len().saturating_sub(6)..];
    let speed = match end {
        [first, .., last] => (last.z - first.z) / (last.t - first.t),
        _ => f64::INFINITY,
    };
    let behind = frames.iter().filter(|frame| frame.t > contact.time.value).count();
    let step = contact.step * (end.len().max(2) - 1) as f64;
    let error = libm::hypot(contact.falling.se, std::f64::consts::SQRT_2 * noise / step);
    // A clip may end where the bed hides the body, if it shows well that it is braked.
    let is_slower = behind >= SHOWN && speed < contact.falling.value - CLEARLY * error;
    let most = if is_slower { SLOWER } else { BRAKED };
    match () {
        () if speed > most * contact.falling.value => {
            Err("the body is never braked: the frames behind contact are missing")
        }
        () if !sees_surface && departure.is_braked_at_first > LIKELY => Err(
            "no free fall is seen before the body is braked: give more frames before contact, or, if it is not given, the reading of \
             the surface as --surface",
        ),
        () => Ok(departure),
    }
}

/// Refuses a path, of readings good to `noise` (m), with several falls of a body of this `diameter` (m)
/// under `gravity` (m/s²): they are drops that nothing tells apart.
///
/// # Errors
/// With how many there are.
pub(super) fn refuse_several(
    frames: &[Frame],
    (contact, noise): (&Contact, f64),
    (gravity, diameter): (f64, f64),
    track: &Track,
) -> Result<(), Fault> {
    /// Share of the speed at contact above which a body may fall, and of the way of the longest fall that is one.
    const FAST: f64 = 0.25;
    const WAY: f64 = 0.2;
    /// Standard errors of a velocity that are no fall.
    const CLEAR: f64 = 5.0;
    /// Share of gravity that a hand which lowers a body does not reach.
    const FREE: f64 = 0.5;
    /// Frames that a velocity is taken over.
    const OVER: usize = 4;
    let velocity = |part: &&[Frame]| (part[OVER].z - part[0].z) / (part[OVER].t - part[0].t);
    let fast = |part: &&[Frame]| {
        let error = std::f64::consts::SQRT_2 * noise / (part[OVER].t - part[0].t);
        // A hand that holds a body moves it by its diameter.
        let own = (gravity * diameter).sqrt();
        velocity(part) > (FAST * contact.falling.value).max(CLEAR * error).max(own)
    };
    let parts: Vec<&[Frame]> = frames.windows(OVER + 1).collect();
    let ends_of_fall = |fall: &[&[Frame]]| {
        let fastest = fall.iter().max_by(|a, b| velocity(a).total_cmp(&velocity(b)))?;
        let (first, last) = (fall.first()?, fall.last()?);
        let gained = velocity(fastest) - velocity(first);
        let is_free = gained >= FREE * gravity * (fastest[0].t - first[0].t);
        is_free.then(|| [first[0], last[OVER]])
    };
    let falls = parts.chunk_by(|a, b| fast(a) == fast(b)).filter(|chunk| fast(&chunk[0]));
    let ends: Vec<[Frame; 2]> = falls.filter_map(ends_of_fall).collect();
    let longest = ends.iter().map(|[from, to]| to.z - from.z).fold(0.0, f64::max);
    let (mut n, mut end) = (0, None::<Frame>);
    for [from, to] in ends.into_iter().filter(|[from, to]| to.z - from.z > WAY * longest) {
        // A fall that noise breaks into parts goes on where and when it was.
        let is_another = |end: Frame| from.t > end.t && from.z < end.z - 0.5 * (to.z - from.z);
        n += usize::from(end.is_none_or(is_another));
        end = Some(to);
    }
    if n < 2 {
        return Ok(());
    }
    let whose = track.name.as_ref().map_or(String::new(), |name| format!("the run {name}: "));
    let what = format!("{whose}it holds several drops, {n} at least");
    let right = "a run is one drop: name the column that tells drops apart, --column run=NAME, or give each drop a table";
    Err(Fault::new(&track.file, what, right))
}

/// Probability that the body is braked from the first frames on, above which no free fall counts as seen.
const LIKELY: f64 = 0.1;

/// Share of the speed at contact that is left at the end of a clip that shows the body braked.
const BRAKED: f64 = 0.7;

/// The same of a clip with so many frames behind contact and a speed lower by so many standard errors.
const SLOWER: f64 = 0.9;
const SHOWN: usize = 10;
const CLEARLY: f64 = 10.0;

/// Frames that are kept after the body has come to rest.
const AT_REST: usize = 10;

/// Distance (m) from its last place at which a body still moves, at least.
const STILL: f64 = 2e-4;

/// The part of a path from the fall before its contact to a little after its rest, as indices.
pub(super) fn kept(frames: &[Frame], contact: &Contact, noise: f64) -> std::ops::Range<usize> {
    let first = frames.iter().position(|frame| frame.t >= contact.first).unwrap_or(0);
    let hit = frames.iter().position(|frame| frame.t >= contact.time.value).unwrap_or(first);
    let behind = &frames[hit..];
    let mut last: Vec<f64> = behind
        [behind.len() - (behind.len() / 5).clamp(1, 25).min(behind.len())..]
        .iter()
        .map(|frame| frame.z)
        .collect();
    last.sort_by(f64::total_cmp);
    let place = last[last.len() / 2];
    let moves = |frame: &Frame| (frame.z - place).abs() > (4.0 * noise).max(STILL);
    let end = behind.iter().rposition(moves).map_or(hit, |at| hit + at);
    first..(end + 1 + AT_REST).min(frames.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracking::layouts;
    use crate::tracking::options::Options;
    use crate::tracking::settings::Columns;
    use crate::tracking::text;

    /// Times of the readings of `text` at 100 frames per second.
    fn times(text: &str) -> Result<Vec<f64>, Fault> {
        let sheet = text::read("a.csv", "a", text.as_bytes())?;
        let mut track = layouts::tracks(&sheet, &Columns::default())?.remove(0);
        let mut options = Options::default();
        options.set("rate", "100Hz");
        let settings = Settings::of(&options).expect("options");
        let counts_rows = counts_rows(&track, &settings);
        let samples = in_order(&mut track, &settings, counts_rows)?;
        Ok(clock(&samples, &track, &settings, counts_rows))
    }

    #[test]
    fn rows_of_a_coarse_clock_are_counted_by_their_place_in_the_table() {
        // The body rests in the last rows, and one row has no reading.
        let row = |k: u32| match k {
            4 => "0.1,\n".to_owned(),
            _ => format!("{:.1},{}\n", f64::from(k / 4) / 10.0, 30 - k.min(10)),
        };
        let text: String = (0..16).map(row).collect();
        let found = times(&format!("t (s),y (cm)\n{text}")).expect("a clock");
        let expected: Vec<f64> =
            (0..16).filter(|k| *k != 4).map(|k| f64::from(k) / 100.0).collect();
        assert_eq!(found.len(), expected.len());
        let off = found.iter().zip(&expected).map(|(found, expected)| (found - expected).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{found:?}");
    }

    #[test]
    fn one_time_that_is_listed_twice_makes_no_clock_coarse() {
        let row = |k: u32| format!("{},{}\n", if k == 20 { 19 } else { k }, 90 - k);
        let text: String = (0..40).map(row).collect();
        assert!(times(&format!("t (s),y (cm)\n{text}")).is_err());
    }

    #[test]
    fn frames_that_a_video_shows_twice_are_left_out_and_a_slow_body_keeps_its_readings() {
        let at = |k: u64, z: f64| Sample { line: k, t: k as f64, z, x: 0.0 };
        let fall = |k: u64| 0.5 * (k * k) as f64;
        let mut twice: Vec<Sample> =
            (0..20).map(|k| at(k, fall(if k % 5 == 4 { k - 1 } else { k }))).collect();
        // The first lies where the body is slow, and no reading follows the last.
        assert_eq!(without_repeated(&mut twice), 2);
        assert!(twice.iter().all(|one| ![9, 14].contains(&one.line)));
        let mut pixels: Vec<Sample> = (0..40).map(|k| at(k, (0.02 * fall(k)).round())).collect();
        assert_eq!(without_repeated(&mut pixels), 0);
    }

    #[test]
    fn a_clip_may_end_while_the_body_is_braked_if_it_shows_that_well() {
        let (speed, rate, gravity) = (2.0, 5000.0, 9.81);
        let frames = |behind: i32, resistance: f64| -> Vec<Frame> {
            let depth = |t: f64| {
                let braked = if t > 0.0 { resistance * t.powi(3) } else { 0.0 };
                speed * t + 0.5 * gravity * t * t - braked
            };
            (-300..behind)
                .map(|k| f64::from(k) / rate)
                .map(|t| Frame { t, z: depth(t), x: 0.0, sigma: None })
                .collect()
        };
        let tip = Tip::new("sphere", 0.0254, None);
        let seen = |frames: &[Frame]| contact(frames, (tip, 1e-5), (gravity, false)).map(|_| ());
        // At the last frame it has 2.0 + 0.196 − 0.6 m/s.
        assert_eq!(seen(&frames(100, 500.0)), Ok(()));
        assert!(seen(&frames(100, 20.0)).is_err_and(|why| why.contains("never braked")));
    }
}
