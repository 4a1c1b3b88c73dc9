//! The header of a table: which column stands where.

use configs::{Diagnostic, Span, nearest, shorten};
use engine::units::{self, Dimension};

use crate::table::columns::{ColumnNames, ColumnSpec, Content, Renamed};
use crate::table::findings::Findings;
use crate::table::row::{Row, file_name};

/// Where a column stands, and how it is written.
pub(crate) struct Column {
    pub(crate) at: usize,
    pub(crate) name: String,
    pub(crate) unit: Option<String>,
    pub(crate) sign: f64,
    pub(crate) zero: f64,
}

impl Column {
    /// Its name with its unit, as the file has them.
    pub(crate) fn describe(&self, spec: &ColumnSpec) -> String {
        let unit = match (spec.content, &self.unit) {
            (Content::Quantity(dimension), None) => format!(" ({})", dimension.si_unit()),
            (_, Some(unit)) if self.sign < 0.0 => format!(" ({unit}, turned round)"),
            (_, Some(unit)) => format!(" ({unit})"),
            (Content::Name | Content::Count, None) => String::new(),
        };
        let zero = match spec.content {
            Content::Quantity(dimension) if self.zero != 0.0 => {
                format!(", counted from {}", units::format_si(self.zero, dimension))
            }
            _ => String::new(),
        };
        match self.name == spec.key {
            true => format!("{}{unit}{zero}", spec.key),
            false => format!("{} = {}{unit}{zero}", spec.key, self.name),
        }
    }
}

/// Finds the columns of `specs` in a header that was taken apart. `None` when one is missing or
/// stands twice; that is reported then.
pub(crate) fn read(
    row: &Row,
    specs: &[ColumnSpec],
    names: &ColumnNames,
    findings: &mut Findings,
) -> Option<Vec<Option<Column>>> {
    let found: Vec<String> = row.cells().map(str::to_owned).collect();
    let before = findings.errors();
    refuse_repeated(row, &found, findings);
    let columns: Vec<Option<Column>> = specs
        .iter()
        .map(|spec| {
            let column = find(spec, names, &found);
            if let Err(name) = &column {
                missing(name, spec, &found, row, findings);
            }
            column.ok().flatten()
        })
        .collect();
    note_ignored(row, &found, (specs, &columns), findings);
    (findings.errors() == before).then_some(columns)
}

fn refuse_repeated(row: &Row, found: &[String], findings: &mut Findings) {
    for (at, name) in found.iter().enumerate() {
        if let Some(first) = found[..at].iter().position(|other| other == name) {
            let again = findings.place(row, Some(at));
            let range = row.range(first);
            let first = Span { start: range.start, end: range.end, ..again };
            findings.report(
                Diagnostic::error(format!("the column `{}` is listed twice", shorten(name)))
                    .at(again, "again here")
                    .with(first, "first here"),
            );
        }
    }
}

/// The column of `spec`, if there is one; the error is the name of one that has to be there.
fn find<'a>(
    spec: &'a ColumnSpec,
    names: &'a ColumnNames,
    found: &[String],
) -> Result<Option<Column>, &'a str> {
    let renamed = names.of(spec.key);
    let position = |name: &str| found.iter().position(|found| found == name);
    let mut name = renamed.map_or(spec.key, |renamed| renamed.name.as_str());
    // Both tables have a column `run`, and perhaps only one calls it otherwise.
    if spec.key == "run" && position(name).is_none() && position(spec.key).is_some() {
        name = spec.key;
    }
    if spec.key == "session" && renamed.is_none() && position(name).is_none() {
        name = "day";
    }
    match position(name) {
        Some(at) => Ok(Some(Column {
            at,
            name: name.to_owned(),
            unit: renamed.or_else(|| shifted(spec, names)).and_then(|found| found.unit.clone()),
            sign: renamed.map_or(1.0, |renamed| renamed.sign),
            zero: renamed.map_or(0.0, |renamed| renamed.zero),
        })),
        None if spec.required || renamed.is_some() => Err(name),
        None => Ok(None),
    }
}

/// The column that `spec` has zeros of: these are in its unit.
fn shifted<'a>(spec: &ColumnSpec, names: &'a ColumnNames) -> Option<&'a Renamed> {
    names.of(spec.key.strip_suffix("_zero")?)
}

fn note_ignored(
    row: &Row,
    found: &[String],
    (specs, columns): (&[ColumnSpec], &[Option<Column>]),
    findings: &mut Findings,
) {
    let known = |at: usize| columns.iter().flatten().any(|column| column.at == at);
    let ignored: Vec<String> = (0..found.len())
        .filter(|at| !known(*at))
        .take(20)
        .map(|at| format!("`{}`", shorten(&found[at])))
        .collect();
    if !ignored.is_empty() {
        let (noun, verb) = if ignored.len() == 1 { ("column", "is") } else { ("columns", "are") };
        let table = file_name(&row.table);
        let meant = specs.iter().zip(columns).find_map(|(spec, column)| {
            let is_quantity = matches!(spec.content, Content::Quantity(_));
            let at = like(spec.key, found).filter(|at| column.is_none() && is_quantity && !known(*at))?;
            let name = shorten(&found[at]);
            Some(format!(
                "; if `{name}` is the quantity `{key}`, say it below [columns]: {key} = {{ name = \"{name}\" }}",
                key = spec.key
            ))
        });
        findings.note(format!(
            "In {table} the {noun} {} {verb} ignored{}.",
            ignored.join(", "),
            meant.unwrap_or_default()
        ));
    }
}

/// Reports that no column has the name `name`.
fn missing(name: &str, spec: &ColumnSpec, found: &[String], row: &Row, findings: &mut Findings) {
    let near = like(name, found);
    let other = near.map_or("…".to_owned(), |at| shorten(&found[at]));
    let entry = match spec.content {
        Content::Quantity(dimension) => {
            let unit = near.and_then(|at| unit_in(&found[at], dimension));
            let unit = unit.unwrap_or_else(|| dimension.si_unit());
            format!("{} = {{ name = \"{other}\", unit = \"{unit}\" }}", spec.key)
        }
        Content::Name | Content::Count => format!("{} = {{ name = \"{other}\" }}", spec.key),
    };
    let shown: Vec<String> = found.iter().take(20).map(|name| shorten(name)).collect();
    let first = found.first().map(|name| name.to_lowercase()).unwrap_or_default();
    let program = match () {
        () if first.starts_with("mass") => {
            "\nthis is a table of Tracker: plunge import makes a set of it"
        }
        () if found.iter().any(|name| name == "TRACK_ID") => {
            "\nthis is a table of TrackMate: plunge import makes a set of it"
        }
        () => "",
    };
    let span = findings.place(row, near);
    let label = if near.is_some() { "is it this one?" } else { "no column has this name" };
    findings.report(
        Diagnostic::error(format!("the column `{}` is missing", shorten(name)))
            .at(span, label)
            .help(format!(
                "found: {}\nwhere it has another name, say it below [columns]: {entry}{program}",
                shown.join(", ")
            )),
    );
}

/// The column that is likely meant by `name`: spelt nearly so, or with a unit behind the name.
fn like(name: &str, found: &[String]) -> Option<usize> {
    let stem = |found: &String| found.split(BEFORE_UNIT).next().unwrap_or_default().to_lowercase();
    match nearest(name, found.iter().map(String::as_str)) {
        Some(near) => found.iter().position(|found| found == near),
        None => found.iter().position(|found| stem(found) == name.to_lowercase()),
    }
}

/// What stands between a name and its unit in `z_mm`, `z (mm)`, `z/mm`.
const BEFORE_UNIT: [char; 5] = ['_', ' ', '(', '[', '/'];

/// The unit that a column has in its name.
fn unit_in(name: &str, dimension: Dimension) -> Option<String> {
    let unit = name.rsplit(BEFORE_UNIT).next()?.trim_end_matches([')', ']']);
    units::parse(&format!("1 {unit}"), dimension).ok().map(|_| unit.to_owned())
}
