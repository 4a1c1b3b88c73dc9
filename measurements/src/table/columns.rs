//! The columns of the tables, and `[columns]`, which says how a file names and counts them.

use configs::reader::TableReader;
use configs::{Diagnostic, Span};
use engine::units::{self, Dimension};

use crate::keys;

/// What stands in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// A name.
    Name,
    /// A whole number.
    Count,
    /// A number with a unit.
    Quantity(Dimension),
}

/// A column that is understood.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColumnSpec {
    pub(crate) key: &'static str,
    pub(crate) content: Content,
    pub(crate) required: bool,
}

pub(crate) const fn column(key: &'static str, content: Content, required: bool) -> ColumnSpec {
    ColumnSpec { key, content, required }
}

const LENGTH: Content = Content::Quantity(Dimension::LENGTH);
const TIME: Content = Content::Quantity(Dimension::TIME);

/// The columns of `runs.csv`.
pub(crate) const RUNS: [ColumnSpec; 12] = [
    column("run", Content::Name, true),
    column("condition", Content::Name, true),
    column("repeat", Content::Count, false),
    column("order", Content::Count, false),
    column("session", Content::Name, false),
    column("stop_time", TIME, false),
    column("final_z", LENGTH, false),
    column("final_x", LENGTH, false),
    column("t_zero", TIME, false),
    column("z_zero", LENGTH, false),
    column("crater_depth", LENGTH, false),
    column("rim_diameter", LENGTH, false),
];

/// The columns of a table of trajectories, which has to have `run` and `x`, or not.
const fn trajectories(run: bool, x: bool) -> [ColumnSpec; 5] {
    [
        column("run", Content::Name, run),
        column("t", TIME, true),
        column("z", LENGTH, true),
        column("x", LENGTH, x),
        column("sigma_z", LENGTH, false),
    ]
}

/// The columns of `trajectories.csv`.
pub(crate) const TRAJECTORIES: [ColumnSpec; 5] = trajectories(true, true);
/// Where all impacts are vertical.
pub(crate) const VERTICAL: [ColumnSpec; 5] = trajectories(true, false);
/// Of a table of one run.
pub(crate) const OF_ONE_RUN: [ColumnSpec; 5] = trajectories(false, true);
/// Both.
pub(crate) const VERTICAL_OF_ONE_RUN: [ColumnSpec; 5] = trajectories(false, false);

/// The unit that a file may call `g` where it is one of acceleration.
const STANDARD_GRAVITY: &str = "gn";

/// How a file names and counts one column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Renamed {
    key: &'static str,
    pub(crate) name: String,
    /// `None` for names and whole numbers.
    pub(crate) unit: Option<String>,
    /// 1, or -1 where the file counts the other way.
    pub(crate) sign: f64,
    /// What the column reads (SI) where our count begins.
    pub(crate) zero: f64,
    /// Where the set says so.
    pub(crate) span: Option<Span>,
}

/// The table `[columns]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ColumnNames(Vec<Renamed>);

impl ColumnNames {
    /// What the file says of the column `key`.
    pub(crate) fn of(&self, key: &str) -> Option<&Renamed> {
        self.0.iter().find(|renamed| renamed.key == key)
    }

    /// Column `key`, in `unit` where the file names no other, counted the other way, as `[columns]` says it.
    pub(crate) fn turned(&self, key: &str, unit: &str) -> String {
        let known = self.of(key);
        let name = known.map_or(key, |one| one.name.as_str());
        let unit = match known.and_then(|one| one.unit.as_deref()).unwrap_or(unit) {
            STANDARD_GRAVITY => "g",
            unit => unit,
        };
        let is_turned = known.is_some_and(|one| one.sign < 0.0);
        let sign = if is_turned { 1 } else { -1 };
        format!("{key} = {{ name = \"{name}\", unit = \"{unit}\", sign = {sign} }}")
    }

    /// Reads `[columns]` of the table of runs and of one with these `readings`; faults are reported.
    pub(crate) fn read(table: TableReader<'_>, readings: &[ColumnSpec]) -> Self {
        let mut columns: Vec<Renamed> = Vec::new();
        for spec in RUNS.iter().chain(&readings[1..]) {
            if !table.has(spec.key) {
                continue;
            }
            let span = table.span_of(spec.key);
            if let Some(renamed) = renamed(table.table(spec.key, None), spec, span) {
                if let Some(other) = columns.iter().find(|other| other.name == renamed.name) {
                    let message = format!(
                        "`{}` and `{}` are the same column, `{}`",
                        other.key, spec.key, other.name
                    );
                    table.reader.report(Diagnostic::error(message).at(span, "here again"));
                }
                columns.push(renamed);
            }
        }
        table.finish();
        Self(columns)
    }
}

/// Whether the column `key` may have a zero: errors and zeros are differences, which have none.
fn may_have_zero(key: &str) -> bool {
    !key.starts_with("sigma_") && !key.ends_with("_zero")
}

fn renamed(table: TableReader<'_>, spec: &ColumnSpec, span: Option<Span>) -> Option<Renamed> {
    table.header()?;
    let name = table.text("name", Some(spec.key), spec.key, "the column's name in the file");
    let (unit, sign, zero) = match spec.content {
        Content::Name | Content::Count => (None, 1.0, 0.0),
        Content::Quantity(dimension) => {
            let example = dimension.si_unit();
            let mut unit = table.text("unit", None, &example, "the unit of the column")?;
            // Where an acceleration stands, no gram is meant.
            if dimension == Dimension::ACCELERATION && unit.value == "g" {
                STANDARD_GRAVITY.clone_into(&mut unit.value);
            }
            check_unit(&table, &unit.value, unit.span, dimension);
            let sign = table.number(&keys::SIGN)?;
            if sign.value.abs() < 1.0 {
                table.reader.report(
                    Diagnostic::error("`sign` is neither 1 nor -1")
                        .at(sign.span, "expected 1 or -1")
                        .help("the unit is the place for a factor"),
                );
            }
            let zero = match may_have_zero(spec.key) {
                true => table.number_in("zero", &unit.value, dimension)?,
                false => None,
            };
            (Some(unit.value), sign.value, zero.map_or(0.0, |zero| zero.value))
        }
    };
    table.finish();
    Some(Renamed { key: spec.key, name: name?.value, unit, sign, zero, span })
}

fn check_unit(table: &TableReader<'_>, unit: &str, span: Option<Span>, dimension: Dimension) {
    if let Err(error) = units::parse(&format!("1 {unit}"), dimension) {
        table.reader.report(
            Diagnostic::error(format!("`unit`: {}", error.reason()))
                .at(span, format!("expected the unit of {}", dimension.name()))
                .help(format!("write unit = \"{}\", or another unit of it", dimension.si_unit())),
        );
    }
}
