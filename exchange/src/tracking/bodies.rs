//! What was dropped: by options, by columns of the tables, or by a table of bodies.

use std::path::Path;

use engine::units::{Dimension, dimension_of, parse};
use intruders::TipForm;

use super::called;
use super::called::words;
use super::density;
use super::fault::Fault;
use super::heading::Heading;
use super::inputs;
use super::options::flag;
use super::settings::Settings;
use super::shapes::{known, shape_of};
use super::sheet::Sheet;
use super::units::Unit;

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    pub(super) shape: String,
    /// (m)
    pub(super) diameter: f64,
    /// (kg)
    pub(super) mass: f64,
    /// (m)
    pub(super) height: Option<f64>,
    /// (deg)
    pub(super) apex: Option<f64>,
    /// Of what follows it into the bed (m).
    pub(super) shaft_diameter: Option<f64>,
}

impl Body {
    /// How deep its tip goes before a bed resists noticeably, at most (m).
    pub(super) fn soft_entry(&self) -> f64 {
        self.tip().map_or(0.0, |tip| tip.soft_entry * self.diameter)
    }

    /// Whether only a planar bed has such a body.
    pub(super) fn is_planar(&self) -> bool {
        intruders::find(&self.shape).is_some_and(|entry| !entry.spatial)
    }

    fn tip(&self) -> Option<&'static TipForm> {
        intruders::find(&self.shape)?.measured.tip.as_ref()
    }

    /// How far its lowest point is below its centre (m), where it has one centre that cameras track.
    pub(super) fn below_centre(&self) -> Option<f64> {
        (intruders::find(&self.shape)?.measured.centre)(self.diameter, self.height)
    }
}

/// A row of the table of bodies: names of keys with what stands below them.
type Named = (String, Vec<(&'static str, String)>);

/// Bodies by their names.
#[derive(Clone, Debug, Default)]
pub(super) struct Bodies(Vec<Named>);

/// Names of columns of a table of bodies, and what they may be called.
const COLUMNS: [(&str, &[&str]); 7] = [
    ("diameter", &["diameter", "d", "dia", "ø", "⌀", "durchmesser", "diamètre"]),
    ("radius", &["radius", "r", "rayon"]),
    ("mass", &["mass", "m", "masse", "masa", "weight", "gewicht"]),
    ("shape", &["shape", "form", "forme"]),
    ("height", &["height", "h", "length"]),
    ("apex", &["apex", "apex_deg", "apex angle"]),
    ("shaft_diameter", &["shaft_diameter", "shaft diameter", "shaft"]),
];
const NAMES: [&str; 2] = ["name", "id"];
/// Those that labels of runs may have too.
const LABELS: [&str; 10] = [
    "body",
    "ball",
    "intruder",
    "projectile",
    "körper",
    "kugel",
    "corps",
    "bille",
    "cuerpo",
    "sphere",
];

/// Whether a column of this name says the body.
pub(super) fn is_body(stem: &str) -> bool {
    LABELS.contains(&stem)
}

impl Bodies {
    /// Reads a table of bodies.
    pub(super) fn read(path: &Path) -> Result<Self, Fault> {
        let sheets = inputs::sheets(path, &inputs::bytes(path)?)?;
        let sheet = &sheets[0];
        let headings: Vec<Heading> = sheet.rows[0].cells.iter().map(|name| heading(name)).collect();
        let column =
            |names: &[&str]| headings.iter().position(|one| names.contains(&one.stem.as_str()));
        let Some(name) = column(&LABELS).or_else(|| column(&NAMES)) else {
            let right = "write a line of names body,diameter (mm),mass (g),shape above the bodies";
            return Err(sheet
                .fault("a table of bodies has a column `body`", right)
                .at(sheet.rows[0].line));
        };
        let row = |row: &super::sheet::Row| {
            let value = |(key, names): &(&'static str, &[&str])| {
                let at = column(names)?;
                let cell = row.cell(at);
                let text = match headings[at].unit.word() {
                    _ if headings[at].unit == Unit::Unstated => cell.to_owned(),
                    unit => format!("{} {unit}", plain(sheet, cell)),
                };
                (!cell.is_empty()).then_some((*key, text))
            };
            (row.cell(name).to_owned(), COLUMNS.iter().filter_map(value).collect())
        };
        let bodies = Self(sheet.rows[1..].iter().map(row).collect());
        bodies.refuse_twice(sheet)?;
        Ok(bodies)
    }

    /// Refuses a body that the rows of `sheet` below its header list with several values.
    fn refuse_twice(&self, sheet: &Sheet) -> Result<(), Fault> {
        for (at, (name, values)) in self.0.iter().enumerate() {
            let before = self.0[..at].iter().position(|(other, _)| is_called(other, name));
            if let Some(first) = before.filter(|first| self.0[*first].1 != *values) {
                let [first, again] = [first, at].map(|at| sheet.rows[at + 1].line);
                let what = format!(
                    "the body `{name}` is listed on line {first} and again, with other values"
                );
                return Err(sheet
                    .fault(what, "keep one of the lines, or give each body its own name")
                    .at(again));
            }
        }
        Ok(())
    }

    /// The label of the one body of the table whose name stands in `called`, where no label says the body.
    pub(super) fn named_in(
        &self,
        called: &str,
        labels: &[(String, String)],
    ) -> Option<(String, String)> {
        if labels.iter().any(|(name, _)| is_body(name)) {
            return None;
        }
        let all = called::parts(called);
        let holds =
            |all: &[String], own: &[String]| all.windows(own.len().max(1)).any(|some| some == own);
        let names = self.0.iter().map(|(name, _)| (name, called::parts(name)));
        // The name of a run has numbers of its own: a body whose name is a number cannot be recognised in it.
        let is_word = |part: &String| part.contains(char::is_alphabetic);
        let found: Vec<(&String, Vec<String>)> =
            names.filter(|(_, own)| own.iter().any(is_word) && holds(&all, own)).collect();
        // `big_steel` is not `steel`.
        let is_part = |own: &[String]| {
            found.iter().any(|(_, other)| other.len() > own.len() && holds(other, own))
        };
        let mut whole = found.iter().filter(|(_, own)| !is_part(own));
        let (name, _) = whole.next()?;
        whole.next().is_none().then(|| ("body".to_owned(), (*name).clone()))
    }

    /// The names of all, for messages.
    fn names(&self) -> String {
        let names: Vec<&str> = self.0.iter().map(|(name, _)| name.as_str()).collect();
        configs::shorten(&names.join(", "))
    }

    /// What the table says of `body` below `key`.
    fn get(&self, body: &str, key: &str) -> Option<&str> {
        let (_, values) = self.0.iter().find(|(name, _)| is_called(name, body))?;
        values.iter().find(|(other, _)| *other == key).map(|(_, value)| value.as_str())
    }

    /// That nothing says the `key` of the body of `run`, which is called `name` if it has a name.
    fn unsaid(&self, run: &str, name: Option<&str>, (key, example): (&str, &str)) -> Fault {
        let right = match name.is_none() && !self.0.is_empty() {
            true => format!(
                "no name, folder or column `body` says which of {} it is; --condition \"{{body}}_{{repeat}}\" says where",
                self.names()
            ),
            false => format!(
                "write {} {example}; several bodies: --bodies bodies.csv with the columns body, diameter (mm), mass (g), and the \
                 body in names, folders or a column `body`",
                flag(key)
            ),
        };
        Fault::new(run, format!("no table says the {key} of the body"), right)
    }

    /// The body of a run with these labels, which messages call `run`.
    ///
    /// # Errors
    /// If nothing says its shape, size or mass, or one is not such a quantity.
    pub(super) fn of(
        &self,
        run: &str,
        labels: &[(String, String)],
        settings: &Settings<'_>,
    ) -> Result<Body, Fault> {
        let label = |key: &str| labelled(labels, key);
        let name = LABELS.iter().find_map(|key| label(key));
        if let Some(name) = name.filter(|_| !self.0.is_empty())
            && !self.0.iter().any(|(other, _)| is_called(other, name))
        {
            let what =
                format!("the run {run} is of the body `{name}`, which the table of bodies lacks");
            return Err(Fault::new(&flag("bodies"), what, format!("its bodies: {}", self.names())));
        }
        let said = |key: &str| {
            let of_table = || name.and_then(|name| self.get(name, key));
            // What the user says stands above a column of that name: trackers call a brightness mass.
            of_table().map(|text| (text, flag("bodies"))).or_else(|| {
                label(key)
                    .filter(|_| key != "height" && settings.text(key).is_none())
                    .map(|text| (text, format!("the column {key}")))
            })
        };
        let quantity = |key: &str, dimension: Dimension| match said(key) {
            Some((text, place)) => parse(text, dimension).map(Some).map_err(|error| {
                Fault::new(
                    &place,
                    format!("the {key} of {run}: {}", error.reason()),
                    error.advice(),
                )
            }),
            None => settings.quantity(key, dimension, labels),
        };
        let needed = |key: &str, dimension: Dimension, example: &str| {
            quantity(key, dimension)?.ok_or_else(|| self.unsaid(run, name, (key, example)))
        };
        let shape = said("shape").map(|(text, _)| text).or_else(|| settings.text("shape"));
        let word = shape.unwrap_or("sphere");
        let Some(shape) = shape_of(word) else {
            let what = format!("the shape of {run} is \"{word}\"");
            return Err(Fault::new(&flag("shape"), what, known()));
        };
        let radius = match said("radius") {
            Some(_) => quantity("radius", Dimension::LENGTH)?,
            None => None,
        };
        let diameter = match radius {
            Some(radius) => 2.0 * radius,
            None => needed("diameter", Dimension::LENGTH, "25.4mm")?,
        };
        let height = quantity("height", Dimension::LENGTH)?;
        let stated = quantity("apex", Dimension::ANGLE)?;
        let by_height = height.map(|height| 2.0 * libm::atan2(0.5 * diameter, height));
        // Where a pointed body is braked first depends much on its angle.
        let is_pointed = shape.measured.keys.contains(&"apex_deg");
        let apex = match stated.or(by_height) {
            None if is_pointed => Some(needed("apex", Dimension::ANGLE, "60deg")?),
            apex if is_pointed => apex,
            _ => stated,
        };
        let shaft_diameter = quantity("shaft_diameter", Dimension::LENGTH)?;
        if let Some(shaft) = shaft_diameter
            && shape.under_shaft.is_none()
        {
            let what = format!("{run} is a {} with a shaft of {:.1} mm", shape.name, 1e3 * shaft);
            let right = format!("{} may have one", intruders::with_shafts());
            return Err(Fault::new(&flag("shaft_diameter"), what, right));
        }
        let apex = apex.map(f64::to_degrees).map(|apex| (apex * 1e9).round() / 1e9);
        let body = Body {
            diameter,
            mass: needed("mass", Dimension::MASS, "\"67 g\"")?,
            shape: shape.name.to_owned(),
            height,
            apex,
            shaft_diameter,
        };
        let written = |key: &str, value: f64, unit: &str| match (said(key), settings.text(key)) {
            (Some((text, place)), _) => (text.to_owned(), place),
            (None, Some(text)) => (text.to_owned(), flag(key)),
            (None, None) => (format!("{:.4} {unit}", 1e3 * value), flag(key)),
        };
        if body.shape == "sphere" {
            let mass = body.mass;
            let [of_diameter, of_mass] =
                [written("diameter", diameter, "mm"), written("mass", mass, "g")];
            density::refuse((diameter, of_diameter), (mass, of_mass))?;
        }
        Ok(body)
    }
}

/// What a label called `key`, or as a column of bodies of that kind may be called, says. Single letters say too little.
fn labelled<'a>(labels: &'a [(String, String)], key: &str) -> Option<&'a str> {
    let others = COLUMNS.iter().find(|(own, _)| *own == key).map_or(&[][..], |(_, names)| names);
    let is_called = |name: &str| name == key || name.len() > 2 && others.contains(&name);
    labels.iter().find(|(name, _)| is_called(name)).map(|(_, value)| value.as_str())
}

/// A warning if an option says of the body of `run` what one of its columns says otherwise.
pub(super) fn set_aside(
    run: &str,
    labels: &[(String, String)],
    settings: &Settings<'_>,
) -> Option<String> {
    let sizes = [("diameter", Dimension::LENGTH), ("mass", Dimension::MASS)];
    sizes.into_iter().find_map(|(key, dimension)| {
        let column = labelled(labels, key)?;
        let stated = settings.quantity(key, dimension, labels).ok()??;
        // Trackers call a brightness mass, too: it has no unit.
        let value = parse(column, dimension).ok().filter(|_| column.contains(char::is_alphabetic))?;
        ((value / stated - 1.0).abs() > 1e-3).then(|| {
            format!(
                "Warning: {} {} is taken for all runs, though a column has {column} for {run}: leave {} out if the column is right.",
                flag(key),
                settings.text(key).unwrap_or_default(),
                flag(key)
            )
        })
    })
}

/// A warning if the name of the run `run` states another mass than that of its `body`, as `h10_33g` does.
pub(super) fn of_named_mass(run: &str, body: &Body) -> Option<String> {
    /// Largest relative difference of a rounded mass.
    const ROUNDED: f64 = 0.1;
    let mut stated = words(run).filter(|word| {
        let unit = word.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        unit.len() < word.len() && ["g", "kg", "mg"].contains(&unit)
    });
    let word = stated.find(|word| {
        let value = parse(word, Dimension::MASS).ok();
        value.is_some_and(|value| (value / body.mass - 1.0).abs() > ROUNDED)
    })?;
    Some(format!(
        "Warning: the run {run} has {word} in its name, and its body is taken to weigh {:.5} g. If bodies differ, give a table of \
         them with --bodies, and leave --mass out.",
        1e3 * body.mass
    ))
}

/// Whether two names of bodies are one, but for capitals.
fn is_called(one: &str, other: &str) -> bool {
    one.to_lowercase() == other.to_lowercase()
}

/// The name of a column, taken apart; units of masses stand behind `_` too.
fn heading(name: &str) -> Heading {
    let heading = Heading::of(name);
    let is_known = COLUMNS.iter().any(|(_, names)| names.contains(&heading.stem.as_str()));
    match heading.stem.rsplit_once('_') {
        Some((stem, unit))
            if !is_known && heading.unit == Unit::Unstated && dimension_of(unit).is_some() =>
        {
            Heading { stem: stem.to_owned(), unit: Unit::Unknown(unit.to_owned()), ..heading }
        }
        _ => heading,
    }
}

/// A number with a decimal point.
fn plain(sheet: &Sheet, cell: &str) -> String {
    match sheet.number(cell) {
        super::sheet::Number::Value(value) => format!("{value:?}"),
        _ => cell.to_owned(),
    }
}
