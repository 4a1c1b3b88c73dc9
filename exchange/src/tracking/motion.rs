//! A track as a path in SI: order and clock of its readings, which way is down, units, and first contact.

use configs::engine::units::Dimension;
use measurements::{Contact, Departure, Fall, Frame};

use super::fault::Fault;
use super::settings::Settings;
use super::track::{Sample, Track};
use super::units::Unit;

/// Relative error of an acceleration up to which it tells units.
const TELLS: f64 = 0.1;

/// Share of gravity by which the acceleration of a fall may be off: guides and air take some of it.
const ALLOWED: f64 = 0.3;

/// A path whose depths count downward, in the units of its table.
#[derive(Clone, Debug)]
pub(super) struct Path {
    pub(super) track: Track,
    /// Times (s where a rate was given), depths and ways.
    pub(super) frames: Vec<Frame>,
    /// 1 where the axis of the table counts downward, -1 upward.
    pub(super) sign: f64,
    fall: Option<Fall>,
}

/// Units of a path, with their size in SI.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scales {
    pub(super) time: (String, f64),
    pub(super) length: (String, f64),
    /// Of the horizontal positions.
    pub(super) way: f64,
    /// Whether the fall told a unit.
    pub(super) is_read: bool,
}

impl Path {
    /// The path of a track.
    ///
    /// # Errors
    /// If its times repeat or run back, or it never moves.
    pub(super) fn of(mut track: Track, settings: &Settings<'_>) -> Result<Self, Fault> {
        let samples = in_order(&mut track, settings)?;
        let clock = clock(&samples, &track, settings);
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
        let falls = [Fall::of_frames(&down), Fall::of_frames(&up)];
        let speed = |at: usize| falls[at].map_or(0.0, |fall| fall.velocity);
        let sign = settings.sign.unwrap_or(if speed(0) >= speed(1) { 1.0 } else { -1.0 });
        let [down_fall, up_fall] = falls;
        let (frames, fall) = if sign > 0.0 { (down, down_fall) } else { (up, up_fall) };
        Ok(Self { track, frames, sign, fall })
    }

    /// Its acceleration before contact, if that is known well enough to tell units.
    fn acceleration(&self) -> Option<f64> {
        let read = self.fall?.acceleration;
        (read.value > 0.0 && read.se < TELLS * read.value).then_some(read.value)
    }

    /// Error of one of its readings of a position, in its unit.
    pub(super) fn noise(&self) -> f64 {
        self.fall.map_or_else(|| measurements::reading_noise(&self.frames), |fall| fall.noise)
    }

    /// Units and their sizes; those that nothing states are found from the fall, of `others` where its own does
    /// not tell.
    ///
    /// # Errors
    /// If a unit is not known, or contradicts the fall.
    pub(super) fn scales(&self, others: &[Self], settings: &Settings<'_>) -> Result<Scales, Fault> {
        let Track { time, vertical, file, .. } = &self.track;
        let time_unit = settings.time_unit.as_ref().unwrap_or(&time.unit);
        let length_unit = match (&settings.length_unit, &vertical.unit, settings.scale) {
            (Some(unit), ..) => unit,
            (None, Unit::Unstated, Some(_)) => &Unit::Pixel,
            (None, unit, _) => unit,
        };
        let times = match (settings.rate, time_unit) {
            (Some(_), _) => vec![("s".to_owned(), 1.0)],
            (None, Unit::Unstated) => vec![("s".to_owned(), 1.0), ("ms".to_owned(), 1e-3)],
            (None, Unit::Frame) => {
                let what = format!(
                    "the column `{}` counts frames, and nothing says how fast they are",
                    time.name
                );
                return Err(Fault::new(file, what, "write --rate 650Hz"));
            }
            (None, unit) => {
                vec![(unit.word().to_owned(), si(unit, Dimension::TIME, &time.name, file)?)]
            }
        };
        let lengths = match (length_unit, settings.scale) {
            (Unit::Pixel, Some(scale)) => vec![("px".to_owned(), scale)],
            (Unit::Pixel, None) => return Err(self.without_scale(&times, settings)),
            (Unit::Unstated, _) => [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)]
                .map(|(name, size)| (name.to_owned(), size))
                .into(),
            (unit, _) => {
                vec![(unit.word().to_owned(), si(unit, Dimension::LENGTH, &vertical.name, file)?)]
            }
        };
        let is_read = times.len() > 1 || lengths.len() > 1;
        let accelerations =
            std::iter::once(self).chain(others.iter().filter(|other| self.is_like(other)));
        let mut accelerations = accelerations.filter_map(Self::acceleration);
        let ratio = |acceleration: f64, time: f64, length: f64| {
            acceleration * length / (time * time) / settings.gravity
        };
        let (time, length) = match (is_read, accelerations.next()) {
            (false, _) => (times[0].clone(), lengths[0].clone()),
            (true, None) => return Err(self.without_unit(time_unit == &Unit::Unstated)),
            (true, Some(acceleration)) => {
                let all =
                    times.iter().flat_map(|time| lengths.iter().map(move |length| (time, length)));
                let fits = |(time, length): &(&(String, f64), &(String, f64))| {
                    (ratio(acceleration, time.1, length.1) - 1.0).abs() <= ALLOWED
                };
                let mut found =
                    all.filter(fits).map(|(time, length)| (time.clone(), length.clone()));
                found.next().ok_or_else(|| self.no_unit_fits(acceleration, settings))?
            }
        };
        if !is_read
            && !settings.trusts_units
            && let Some(acceleration) = self.acceleration()
        {
            let ratio = ratio(acceleration, time.1, length.1);
            if (ratio - 1.0).abs() > ALLOWED {
                return Err(self.contradicts_gravity(ratio, settings.gravity));
            }
        }
        let way = self.track.forward.as_ref().and_then(|x| x.unit.si(Dimension::LENGTH));
        Ok(Scales { way: way.unwrap_or(length.1), time, length, is_read })
    }

    /// Whether another table counts the same.
    fn is_like(&self, other: &Self) -> bool {
        self.track.time == other.track.time && self.track.vertical.unit == other.track.vertical.unit
    }

    /// The path in SI.
    pub(super) fn in_si(&self, scales: &Scales) -> Vec<Frame> {
        let of = |frame: &Frame| Frame {
            t: frame.t * scales.time.1,
            z: frame.z * scales.length.1,
            x: frame.x * scales.way,
            sigma: None,
        };
        self.frames.iter().map(of).collect()
    }

    fn without_scale(&self, times: &[(String, f64)], settings: &Settings<'_>) -> Fault {
        let right = match (self.acceleration(), times) {
            (Some(acceleration), [(_, time)]) => {
                let pixel = 1e3 * settings.gravity * time * time / acceleration;
                format!(
                    "write --scale {pixel:.3}mm/px, if you trust the fall before contact; better a scale on the picture"
                )
            }
            _ => "write --scale 0.21mm/px".to_owned(),
        };
        let what = format!(
            "the column `{}` is in pixels, whose length is not known",
            self.track.vertical.name
        );
        Fault::new(&self.track.file, what, right)
    }

    fn without_unit(&self, has_no_time: bool) -> Fault {
        let Track { vertical, time, file, .. } = &self.track;
        let (name, flag) = match has_no_time {
            true => (
                format!("`{}` and `{}`", time.name, vertical.name),
                "--time-unit ms --length-unit cm",
            ),
            false => (format!("`{}`", vertical.name), "--length-unit cm"),
        };
        let what = format!(
            "the unit of {name} is not said, and too little of the fall is seen to find it"
        );
        Fault::new(file, what, format!("write {flag}, or (cm) behind the name"))
    }

    fn no_unit_fits(&self, acceleration: f64, settings: &Settings<'_>) -> Fault {
        let pixel = match settings.rate {
            Some(_) => format!(
                "; in pixels, write --scale {:.3}mm/px",
                1e3 * settings.gravity / acceleration
            ),
            None => {
                "; frames are counted with --rate 650Hz, pixels with --scale 0.21mm/px".to_owned()
            }
        };
        let what = format!(
            "the unit of `{}` is not said, and its fall (acceleration {acceleration:.4}) is that of gravity in none \
             of m, cm and mm",
            self.track.vertical.name
        );
        Fault::new(&self.track.file, what, format!("write --length-unit cm{pixel}"))
    }

    fn contradicts_gravity(&self, ratio: f64, gravity: f64) -> Fault {
        let near = |factor: f64| (ratio * factor - 1.0).abs() <= ALLOWED;
        let guess = match () {
            () if near(1e2) => {
                "is it a hundred times as large: cm for m? --length-unit says so. ".to_owned()
            }
            () if near(1e3) => {
                "is it a thousand times as large: mm for m? --length-unit says so. ".to_owned()
            }
            () if near(1e1) => {
                "is it ten times as large: mm for cm? --length-unit says so. ".to_owned()
            }
            () if near(1e-1) || near(1e-2) || near(1e-3) => {
                "is the unit of length smaller? --length-unit says so. ".to_owned()
            }
            () => format!(
                "a clip played {:.1} times as slow has this: --rate 650Hz counts frames instead. ",
                (1.0 / ratio).sqrt()
            ),
        };
        let what = format!(
            "by its units the fall before contact accelerates at {:.4} m/s^2, not at {gravity}",
            ratio * gravity
        );
        let right = format!("{guess}A slower fall that is meant: --trust-units");
        Fault::new(&self.track.file, what, right)
    }
}

fn si(unit: &Unit, dimension: Dimension, name: &str, file: &str) -> Result<f64, Fault> {
    unit.si(dimension).ok_or_else(|| {
        let (flag, wanted) = match dimension == Dimension::TIME {
            true => ("--time-unit", "s, ms, us or frames"),
            false => ("--length-unit", "m, cm, mm, inch or px"),
        };
        let what =
            format!("`{}` is not the unit of {} (column `{name}`)", unit.word(), dimension.name());
        Fault::new(file, what, format!("write {flag} and one of {wanted}"))
    })
}

/// The readings in the order of time; copies of one are dropped.
fn in_order(track: &mut Track, settings: &Settings<'_>) -> Result<Vec<Sample>, Fault> {
    let mut samples: Vec<Sample> = Vec::with_capacity(track.samples.len());
    let mut copies = 0;
    for sample in &track.samples {
        let Some(last) = samples.last() else {
            samples.push(*sample);
            continue;
        };
        if sample.t > last.t {
            samples.push(*sample);
            continue;
        }
        let same = |a: f64, b: f64| a.total_cmp(&b).is_eq();
        // Trackers write the first frame twice; a coarse clock repeats its times.
        if same(sample.t, last.t) && same(sample.z, last.z) && same(sample.x, last.x) {
            copies += 1;
            continue;
        }
        if track.time.unit == Unit::Clock && settings.rate.is_some() {
            samples.push(*sample);
            continue;
        }
        let (what, right) = match (same(sample.t, last.t), &track.time.unit) {
            (true, Unit::Clock) => (
                "a time is listed twice",
                "its clock is too coarse: --rate 240Hz counts rows instead",
            ),
            (true, _) => ("a time is listed twice with other positions", "keep one of the rows"),
            (false, _) => ("the time runs back", "several drops in one table need a column `run`"),
        };
        let what = format!("{what} ({}, behind {} on line {})", sample.t, last.t, last.line);
        return Err(Fault::new(&track.file, what, right).at(sample.line));
    }
    if copies > 0 {
        track.notes.push(format!("{copies} readings that repeat the one before are left out"));
    }
    if samples.len() < 8 {
        let what = format!("{} readings are too few to see a drop in", samples.len());
        return Err(Fault::new(
            &track.file,
            what,
            "a drop takes 8 at least, some of them before contact",
        ));
    }
    Ok(samples)
}

/// Times of the readings: in s where the rate of frames is given, else in the unit of the table.
fn clock(samples: &[Sample], track: &Track, settings: &Settings<'_>) -> Vec<f64> {
    let Some(rate) = settings.rate else { return samples.iter().map(|one| one.t).collect() };
    match track.time.unit {
        Unit::Frame => samples.iter().map(|one| one.t / rate).collect(),
        Unit::Clock => (0..samples.len()).map(|row| row as f64 / rate).collect(),
        _ => {
            // The clip counts time in another way: its steps are frames.
            let mut steps: Vec<f64> =
                samples.windows(2).map(|pair| pair[1].t - pair[0].t).collect();
            steps.sort_by(f64::total_cmp);
            let step = steps[steps.len() / 2];
            samples.iter().map(|one| ((one.t - samples[0].t) / step).round() / rate).collect()
        }
    }
}

/// First contact on a path in SI whose readings are good to `noise` (m), of a body of this `shape`.
///
/// # Errors
/// What its frames lack.
pub(super) fn contact(
    frames: &[Frame],
    (shape, noise): (&str, f64),
    gravity: f64,
) -> Result<Departure, &'static str> {
    let departure = Departure::of_frames(frames, shape, gravity, noise)
        .ok_or("too few frames are near the greatest speed to see a contact")?;
    let contact = &departure.contact;
    let time = contact.time;
    let end = &frames[frames.len().saturating_sub(6)..];
    let speed = match end {
        [first, .., last] => (last.z - first.z) / (last.t - first.t),
        _ => f64::INFINITY,
    };
    let error = (2.0 * time.se).max(2.0 * contact.step);
    match () {
        () if speed > BRAKED * contact.falling.value => {
            Err("the body is never braked: the frames behind contact are missing")
        }
        () if time.value - error < contact.first => Err(
            "no free fall is seen before the body is braked: the frames before contact are missing",
        ),
        () => Ok(departure),
    }
}

/// Share of the speed at contact that is left at the end of a clip that shows the body braked.
const BRAKED: f64 = 0.7;

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
