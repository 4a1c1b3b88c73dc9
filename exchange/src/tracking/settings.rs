//! Options as numbers.

use engine::units::{Dimension, parse};

use super::fault::Fault;
use super::heading::Role;
use super::names::{Pattern, filled};
use super::options::{Options, flag};
use super::shapes::{known, shape_of};
use super::units::Unit;

/// Columns that the user names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Columns {
    t: Option<String>,
    z: Option<String>,
    x: Option<String>,
    run: Option<String>,
}

impl Columns {
    /// The column that has this role.
    pub(super) fn of(&self, role: Role) -> Option<&str> {
        match role {
            Role::Time | Role::Frame => self.t.as_deref(),
            Role::Vertical => self.z.as_deref(),
            Role::Forward => self.x.as_deref(),
            Role::Run => self.run.as_deref(),
        }
    }
}

/// The point of the body that was tracked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tracked {
    Lowest,
    Centre,
}

/// What the options say.
#[derive(Clone, Debug)]
pub(super) struct Settings<'a> {
    options: &'a Options,
    pub(super) columns: Columns,
    /// (m/s²)
    pub(super) gravity: f64,
    /// Length of a pixel (m).
    pub(super) scale: Option<f64>,
    /// Frames per second (1/s).
    pub(super) rate: Option<f64>,
    /// 1 where the axis counts downward, -1 upward.
    pub(super) sign: Option<f64>,
    /// `None` where the user does not say it.
    pub(super) tracked: Option<Tracked>,
    pub(super) pattern: Option<Pattern>,
    pub(super) length_unit: Option<Unit>,
    pub(super) time_unit: Option<Unit>,
    pub(super) trusts_units: bool,
    /// Names of runs, or patterns of names.
    pub(super) leave_out: Vec<glob::Pattern>,
}

impl<'a> Settings<'a> {
    /// Reads the options.
    ///
    /// # Errors
    /// Every option that is wrong.
    pub(super) fn of(options: &'a Options) -> Result<Self, Vec<Fault>> {
        let mut faults = Vec::new();
        let text = |key: &str| options.get(key).map(str::to_owned);
        let mut keep = |read: Result<Option<f64>, Fault>| {
            read.unwrap_or_else(|fault| {
                faults.push(fault);
                None
            })
        };
        let gravity = keep(quantity(options, "gravity", Dimension::ACCELERATION, &[]));
        let scale = keep(scale(options));
        let rate = keep(rate(options));
        let mut word = |key: &str, known: &[&'static str]| {
            let asked = options.get(key)?;
            let found = known.iter().find(|one| **one == asked).copied();
            if found.is_none() {
                let what = format!("\"{asked}\" is not known");
                faults.push(Fault::new(&flag(key), what, format!("known: {}", known.join(", "))));
            }
            found
        };
        let sign = word("counts", &["up", "down"]).map(|way| if way == "up" { -1.0 } else { 1.0 });
        let tracked = word("tracked", &["lowest", "centre"]);
        let tracked =
            tracked.map(|at| if at == "centre" { Tracked::Centre } else { Tracked::Lowest });
        if let Some(asked) = options.get("shape").filter(|asked| shape_of(asked).is_none()) {
            faults.push(Fault::new("--shape", format!("\"{asked}\" is not known"), known()));
        }
        let mut unit = |key: &str, dimension: Dimension, example: &str| {
            let asked = Unit::of(options.get(key)?);
            let is_unit = asked.si(dimension).is_some()
                || matches!((dimension, &asked), (Dimension::LENGTH, Unit::Pixel))
                || matches!((dimension, &asked), (Dimension::TIME, Unit::Frame));
            if !is_unit {
                let what = format!("\"{}\" is not the unit of {}", asked.word(), dimension.name());
                faults.push(Fault::new(&flag(key), what, format!("write {example}")));
            }
            is_unit.then_some(asked)
        };
        let length_unit = unit("length_unit", Dimension::LENGTH, "m, cm, mm, inch or px");
        let time_unit = unit("time_unit", Dimension::TIME, "s, ms, us or frames");
        let pattern = options.get("condition").and_then(|text| match Pattern::parse(text) {
            Ok(pattern) => Some(pattern),
            Err(what) => {
                let right =
                    "write for instance {body}_h{height}_r{repeat}, as the names of files are made";
                faults.push(Fault::new("--condition", format!("\"{text}\": {what}"), right));
                None
            }
        });
        if !faults.is_empty() {
            return Err(faults);
        }
        Ok(Self {
            options,
            columns: Columns {
                t: text("column_t"),
                z: text("column_z"),
                x: text("column_x"),
                run: text("column_run"),
            },
            gravity: gravity.unwrap_or(9.81),
            scale,
            rate,
            sign,
            tracked,
            pattern,
            length_unit,
            time_unit,
            trusts_units: options.get("trust_units") == Some("yes"),
            leave_out: options
                .get("leave_out")
                .map(|names| names.split(',').map(|name| pattern_of(name.trim())).collect())
                .unwrap_or_default(),
        })
    }

    /// The quantity of an option (SI) for a run with these labels.
    ///
    /// # Errors
    /// If the text is not a quantity of `dimension`.
    pub(super) fn quantity(
        &self,
        key: &str,
        dimension: Dimension,
        labels: &[(String, String)],
    ) -> Result<Option<f64>, Fault> {
        quantity(self.options, key, dimension, labels)
    }

    /// A position on the axis of the table (m, or px times the scale) for a run with these labels.
    ///
    /// # Errors
    /// If it is not a length, or pixels without a scale.
    pub(super) fn position(
        &self,
        key: &str,
        labels: &[(String, String)],
    ) -> Result<Option<f64>, Fault> {
        let Some(text) = self.options.get(key) else { return Ok(None) };
        let Some(pixels) = text.trim().strip_suffix("px") else {
            return self.quantity(key, Dimension::LENGTH, labels);
        };
        let number = pixels.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        match (number, self.scale) {
            (Some(number), Some(scale)) => Ok(Some(number * scale)),
            (Some(_), None) => {
                let right = "write --scale 0.21mm/px, or the level as a length";
                Err(Fault::new(
                    &flag(key),
                    format!("\"{text}\" is in pixels, whose length is not known"),
                    right,
                ))
            }
            (None, _) => Err(Fault::new(
                &flag(key),
                format!("\"{text}\" is not a number of pixels"),
                "write 812px",
            )),
        }
    }

    /// The option as it was typed.
    pub(super) fn text(&self, key: &str) -> Option<&'a str> {
        self.options.get(key)
    }
}

/// `name` as a pattern of names. A name that is not a valid pattern matches itself alone.
fn pattern_of(name: &str) -> glob::Pattern {
    glob::Pattern::new(name)
        .or_else(|_| glob::Pattern::new(&glob::Pattern::escape(name)))
        .unwrap_or_default()
}

fn quantity(
    options: &Options,
    key: &str,
    dimension: Dimension,
    labels: &[(String, String)],
) -> Result<Option<f64>, Fault> {
    let Some(text) = options.get(key) else { return Ok(None) };
    let text = filled(text, labels).map_err(|field| {
        let known: Vec<&str> = labels.iter().map(|(name, _)| name.as_str()).collect();
        let right = match known.is_empty() {
            true => format!("--condition says where {{{field}}} stands in the names of files"),
            false => format!("known of this run: {}", known.join(", ")),
        };
        Fault::new(&flag(key), format!("{{{field}}} has no value"), right)
    })?;
    let value = parse(&text, dimension)
        .map_err(|error| Fault::new(&flag(key), error.reason(), error.advice()))?;
    let may_be_any = matches!(key, "surface");
    match value > 0.0 || may_be_any {
        true => Ok(Some(value)),
        false => Err(Fault::new(
            &flag(key),
            format!("\"{text}\" is not above 0"),
            "write a positive number",
        )),
    }
}

/// Metres per pixel of `0.21mm/px`.
fn scale(options: &Options) -> Result<Option<f64>, Fault> {
    let Some(text) = options.get("scale") else { return Ok(None) };
    let fault = |what: String| {
        Fault::new("--scale", what, "write the length of a pixel, such as 0.21mm/px")
    };
    let length = ["/px", "/pixel"].iter().find_map(|per| text.trim().strip_suffix(per));
    let length = length.ok_or_else(|| fault(format!("\"{text}\" is not a length per pixel")))?;
    let value = parse(length, Dimension::LENGTH).map_err(|error| fault(error.reason()))?;
    match value > 0.0 {
        true => Ok(Some(value)),
        false => Err(fault(format!("\"{text}\" is not above 0"))),
    }
}

/// Frames per second (1/s) of `650Hz` or `650 fps`.
fn rate(options: &Options) -> Result<Option<f64>, Fault> {
    let Some(text) = options.get("rate") else { return Ok(None) };
    let text = text.trim();
    let read = match text.strip_suffix("fps") {
        Some(number) => parse(&format!("{number} Hz"), Dimension::RATE),
        None => parse(text, Dimension::RATE),
    };
    match read {
        Ok(value) if value > 0.0 => Ok(Some(value)),
        _ => Err(Fault::new(
            "--rate",
            format!("\"{text}\" is not a frame rate"),
            "write 650Hz or 650fps",
        )),
    }
}
