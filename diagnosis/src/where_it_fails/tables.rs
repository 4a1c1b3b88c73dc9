//! The tables: one row per cell or number, keys with their units.

use serde::{Serialize, Serializer};

use super::WhereItFails;
use crate::rounding::{six_digits, six_digits_or_null};

#[derive(Serialize)]
struct CellRow<'a> {
    #[serde(serialize_with = "inert")]
    condition: &'a str,
    #[serde(serialize_with = "six_digits")]
    speed_m_per_s: f64,
    #[serde(serialize_with = "six_digits")]
    angle_deg: f64,
    shape: &'a str,
    #[serde(serialize_with = "six_digits")]
    diameter_m: f64,
    #[serde(serialize_with = "six_digits")]
    from_z_m: f64,
    #[serde(serialize_with = "six_digits")]
    to_z_m: f64,
    #[serde(serialize_with = "six_digits")]
    force_error: f64,
    #[serde(serialize_with = "six_digits")]
    se: f64,
    significant: bool,
    #[serde(serialize_with = "inert")]
    model: &'a str,
}

#[derive(Serialize)]
struct ResidualRow<'a> {
    #[serde(serialize_with = "inert")]
    condition: &'a str,
    observable: &'static str,
    #[serde(serialize_with = "six_digits_or_null")]
    time_s: Option<f64>,
    #[serde(serialize_with = "six_digits")]
    measured: f64,
    #[serde(serialize_with = "six_digits")]
    predicted: f64,
    #[serde(serialize_with = "six_digits")]
    standard_error: f64,
    #[serde(serialize_with = "inert")]
    model: &'a str,
    // A column of sets of forces alone: all of their numbers are at a depth.
    #[serde(serialize_with = "six_digits_or_null", skip_serializing_if = "Option::is_none")]
    depth_m: Option<f64>,
}

#[derive(Serialize)]
struct SignatureRow<'a> {
    #[serde(serialize_with = "inert")]
    condition: &'a str,
    observable: &'static str,
    #[serde(serialize_with = "six_digits_or_null")]
    time_s: Option<f64>,
    #[serde(serialize_with = "six_digits")]
    residual: f64,
    #[serde(serialize_with = "six_digits")]
    standard_error: f64,
    #[serde(serialize_with = "inert")]
    effect: &'a str,
    #[serde(serialize_with = "six_digits")]
    signature: f64,
    #[serde(serialize_with = "six_digits_or_null", skip_serializing_if = "Option::is_none")]
    depth_m: Option<f64>,
}

/// Force errors by model, condition and depth.
pub(super) fn force_errors(found: &WhereItFails<'_>) -> Result<String, csv::Error> {
    let models = found.models.iter();
    table(models.flat_map(|model| {
        model.force_errors.cells.iter().map(|cell| {
            let condition = &found.set.conditions[cell.condition];
            CellRow {
                condition: &condition.id,
                speed_m_per_s: condition.speed,
                angle_deg: condition.angle_deg,
                shape: &condition.shape,
                diameter_m: condition.diameter,
                from_z_m: cell.from,
                to_z_m: cell.to,
                force_error: cell.force_error,
                se: cell.se,
                significant: cell.significant,
                model: &model.model,
            }
        })
    }))
}

/// Every number by model, measured and predicted.
pub(super) fn residuals(found: &WhereItFails<'_>) -> Result<String, csv::Error> {
    let models = found.models.iter();
    table(models.flat_map(|model| {
        model.residuals.iter().map(|one| ResidualRow {
            condition: &found.set.conditions[one.condition].id,
            observable: one.observable.key(),
            time_s: one.time,
            measured: one.measured,
            predicted: one.predicted,
            standard_error: one.standard_error,
            model: &model.model,
            depth_m: one.depth,
        })
    }))
}

/// What the best candidates would do, beside what the first model leaves over; `None` without any.
pub(super) fn signatures(found: &WhereItFails<'_>) -> Result<Option<String>, csv::Error> {
    let Some(model) = found.models.first().filter(|_| !found.signatures.is_empty()) else {
        return Ok(None);
    };
    let rows = found.signatures.iter().flat_map(|signature| {
        model.residuals.iter().zip(&signature.change).map(|(one, change)| SignatureRow {
            condition: &found.set.conditions[one.condition].id,
            observable: one.observable.key(),
            time_s: one.time,
            residual: one.measured - one.predicted,
            standard_error: one.standard_error,
            effect: &signature.effect,
            signature: *change,
            depth_m: one.depth,
        })
    });
    table(rows).map(Some)
}

fn table(rows: impl Iterator<Item = impl Serialize>) -> Result<String, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        table.serialize(row)?;
    }
    let bytes = table.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    // Every field was a string or a number.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A name behind an apostrophe where a spreadsheet would run it as a formula.
fn inert<S: Serializer>(name: &&str, serializer: S) -> Result<S::Ok, S::Error> {
    let runs = name.starts_with(['=', '+', '-', '@', '\t', '\r']) && name.parse::<f64>().is_err();
    match runs {
        true => serializer.serialize_str(&format!("'{name}")),
        false => serializer.serialize_str(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Named<'a> {
        #[serde(serialize_with = "inert")]
        name: &'a str,
    }

    #[test]
    fn names_that_a_spreadsheet_would_run_stand_behind_an_apostrophe() {
        let names = ["=HYPERLINK(\"http://x\")", "@a", "-1+2", "-1.5", "c01"];
        let written = table(names.iter().map(|name| Named { name })).expect("a table");
        let lines: Vec<&str> = written.lines().collect();
        let wanted = ["name", "\"'=HYPERLINK(\"\"http://x\"\")\"", "'@a", "'-1+2", "-1.5", "c01"];
        assert_eq!(lines, wanted);
    }
}
