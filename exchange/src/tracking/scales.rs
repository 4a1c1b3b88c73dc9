//! Units of paths: as tables and options say them, or as the fall before contact shows them.

use engine::units::Dimension;
use measurements::{Frame, Reading, median};

use super::fault::Fault;
use super::motion::Path;
use super::settings::Settings;
use super::track::Track;
use super::units::Unit;

/// Share of gravity by which the acceleration of a fall may be off: guides and air take some of it.
pub(super) const ALLOWED: f64 = 0.3;

/// Relative difference up to which a pixel may be a whole unit.
const WHOLE: f64 = 0.08;

/// Steps of time below this are of seconds, ways of a body below the first of metres, and below the second of centimetres, most
/// likely.
const SECONDS: f64 = 0.05;
const METRES: f64 = 1.0;
const CENTIMETRES: f64 = 20.0;

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

impl Scales {
    /// The acceleration before contact (m/s²) of `path`, if it falls.
    pub(super) fn fall(&self, path: &Path) -> Option<Reading> {
        let Reading { value, se } = path.fall()?;
        let size = self.length.1 / (self.time.1 * self.time.1);
        Some(Reading { value: size * value, se: size * se })
    }

    /// The frames of `path` in SI.
    pub(super) fn in_si(&self, path: &Path) -> Vec<Frame> {
        let of = |frame: &Frame| Frame {
            t: frame.t * self.time.1,
            z: frame.z * self.length.1,
            x: frame.x * self.way,
            sigma: None,
        };
        path.frames.iter().map(of).collect()
    }
}

impl Path {
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
                return Err(self.without_rate(length_unit, settings));
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
            if self.is_off(ratio, ALLOWED) {
                return Err(self.contradicts_gravity(ratio, time.1, settings));
            }
        }
        let way = self.track.forward.as_ref().and_then(|x| x.unit.si(Dimension::LENGTH));
        Ok(Scales { way: way.unwrap_or(length.1), time, length, is_read })
    }

    /// The usual time from row to row, in the unit of the table.
    fn step(&self) -> f64 {
        let steps = self.frames.windows(2).map(|pair| pair[1].t - pair[0].t);
        median(steps).unwrap_or(f64::INFINITY)
    }

    /// Whether another table counts the same.
    fn is_like(&self, other: &Self) -> bool {
        self.track.time == other.track.time && self.track.vertical.unit == other.track.vertical.unit
    }

    fn without_rate(&self, length_unit: &Unit, settings: &Settings<'_>) -> Fault {
        let length = match length_unit {
            Unit::Pixel => settings.scale,
            unit => unit.si(Dimension::LENGTH),
        };
        let right = match (self.acceleration(), length) {
            (Some(acceleration), Some(length)) => {
                let rate = (settings.gravity / (acceleration * length)).sqrt();
                format!(
                    "write --rate and what the camera makes a second; the fall before contact is that of {rate:.0}Hz"
                )
            }
            _ => "write --rate and what the camera makes a second, as in --rate 650Hz".to_owned(),
        };
        let name = &self.track.time.name;
        let what = format!("the column `{name}` counts frames, and nothing says how fast they are");
        Fault::new(&self.track.file, what, right)
    }

    fn without_scale(&self, times: &[(String, f64)], settings: &Settings<'_>) -> Fault {
        let right = match (self.acceleration(), times) {
            (Some(acceleration), [(_, time)]) => {
                let pixel = 1e3 * settings.gravity * time * time / acceleration;
                let whole = [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("inch", 25.4)];
                let unit = whole.iter().find(|(_, size)| (pixel / size - 1.0).abs() < WHOLE);
                unit.map_or_else(|| format!(
                    "write --scale {pixel:.3}mm/px, if you trust the fall before contact; better a scale on the picture"
                ), |(unit, _)| format!(
                    "the fall before contact is that of {unit}: if the picture was calibrated, write --length-unit {unit}; else the \
                     length of a pixel, --scale 0.21mm/px"
                ))
            }
            _ => "write --scale 0.21mm/px".to_owned(),
        };
        let what = format!(
            "the column `{}` is in pixels, whose length is not known",
            self.track.vertical.name
        );
        Fault::new(&self.track.file, what, right)
    }

    /// In which unit a drop would most likely have such numbers.
    fn length_unit(&self) -> &'static str {
        let [low, high] = [f64::min, f64::max]
            .map(|end| self.frames.iter().map(|frame| frame.z).reduce(end).unwrap_or_default());
        match high - low {
            way if way < METRES => "m",
            way if way < CENTIMETRES => "cm",
            _ => "mm",
        }
    }

    fn without_unit(&self, has_no_time: bool) -> Fault {
        let Track { vertical, time, file, .. } = &self.track;
        let (name, flag) = match has_no_time {
            true => (
                format!("`{}` and `{}`", time.name, vertical.name),
                match (self.step() < SECONDS, self.length_unit()) {
                    (true, length) => format!("--time-unit s --length-unit {length}"),
                    (false, length) => format!("--time-unit ms --length-unit {length}"),
                },
            ),
            false => {
                (format!("`{}`", vertical.name), format!("--length-unit {}", self.length_unit()))
            }
        };
        let what = format!(
            "the unit of {name} is not said, and too little of the fall is seen to find it"
        );
        Fault::new(
            file,
            what,
            format!("write {flag}, if that is it, or the unit in brackets behind the name"),
        )
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

    pub(super) fn contradicts_gravity(
        &self,
        ratio: f64,
        time: f64,
        settings: &Settings<'_>,
    ) -> Fault {
        let gravity = settings.gravity;
        let near = |factor: f64| (ratio * factor - 1.0).abs() <= ALLOWED;
        let guess = match () {
            () if settings.rate.is_some() || settings.scale.is_some() => {
                let [time, length] = [(1.0 / ratio).sqrt(), 1.0 / ratio].map(|factor| format!("{factor:.3}"));
                format!("the rate of frames times {time}, or the length of a pixel times {length}, would fit. ")
            }
            () if near(1e2) => {
                "is it a hundred times as large: cm for m? --length-unit says so. ".to_owned()
            }
            () if near(1e3) => {
                "is it a thousand times as large: mm for m? --length-unit says so. A clip played some 32 times as slow \
                 has this too: --rate 1000Hz counts frames instead. "
                    .to_owned()
            }
            () if near(1e1) => {
                "is it ten times as large: mm for cm? --length-unit says so. ".to_owned()
            }
            () if near(1e-6) || near(1e6) => {
                let unit = if ratio > 1.0 { "s" } else { "ms" };
                format!("the fall is right with times in {unit}: --time-unit {unit} says so. ")
            }
            () if near(1e-1) || near(1e-2) || near(1e-3) => {
                "is the unit of length smaller? --length-unit says so. ".to_owned()
            }
            () => {
                let slow = (1.0 / ratio).sqrt();
                let rows = 1.0 / (time * self.step());
                format!(
                    "a clip played {slow:.1} times as slow has this, and would be taken at some {:.0} frames a second: --rate and \
                     the rate of the camera counts frames instead. ",
                    rows * slow
                )
            }
        };
        let what = format!(
            "by its units the fall before contact accelerates at {:.4} m/s^2, not at {gravity}",
            ratio * gravity
        );
        let right = format!("{guess}If another fall than that of gravity is meant: --trust-units");
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
