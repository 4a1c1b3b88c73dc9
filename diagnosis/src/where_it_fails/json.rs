//! Force errors as one JSON object: cells, means of conditions, parts of covariates, and trends.

use measurements::Condition;
use serde::Serialize;

use super::WhereItFails;
use crate::misfit::covariate;
use crate::misfit::force_error::{ForceCell, ForceErrors, Group, Trend};
use crate::rounding::six_digits;

#[derive(Serialize)]
struct Report<'a> {
    set: &'a str,
    models: Vec<Model<'a>>,
}

#[derive(Serialize)]
struct Model<'a> {
    model: &'a str,
    cells: Vec<Cell<'a>>,
    conditions: Vec<Cell<'a>>,
    groups: Vec<Part>,
    trends: &'a [Trend],
    depends_on: Vec<&'static str>,
}

#[derive(Serialize)]
struct Cell<'a> {
    condition: &'a str,
    #[serde(serialize_with = "six_digits")]
    from_z_m: f64,
    #[serde(serialize_with = "six_digits")]
    to_z_m: f64,
    #[serde(serialize_with = "six_digits")]
    force_error: f64,
    #[serde(serialize_with = "six_digits")]
    se: f64,
    significant: bool,
}

#[derive(Serialize)]
struct Part {
    over: &'static str,
    unit: &'static str,
    #[serde(serialize_with = "six_digits")]
    from: f64,
    #[serde(serialize_with = "six_digits")]
    to: f64,
    #[serde(serialize_with = "six_digits")]
    force_error: f64,
    #[serde(serialize_with = "six_digits")]
    se: f64,
    significant: bool,
}

pub(super) fn text(found: &WhereItFails<'_>) -> serde_json::Result<String> {
    let conditions = &found.set.conditions;
    let models = found.models.iter();
    let models = models.map(|model| Model::of(&model.model, &model.force_errors, conditions));
    let report = Report { set: &found.set.id, models: models.collect() };
    Ok(format!("{}\n", serde_json::to_string_pretty(&report)?))
}

impl<'a> Model<'a> {
    fn of(model: &'a str, errors: &'a ForceErrors, conditions: &'a [Condition]) -> Self {
        let cells = |cells: &[ForceCell]| cells.iter().map(|c| Cell::of(c, conditions)).collect();
        Self {
            model,
            cells: cells(&errors.cells),
            conditions: cells(&errors.means),
            groups: errors.groups.iter().map(Part::of).collect(),
            trends: &errors.trends,
            depends_on: errors.depends_on(),
        }
    }
}

impl<'a> Cell<'a> {
    fn of(cell: &ForceCell, conditions: &'a [Condition]) -> Self {
        let ForceCell { from: from_z_m, to: to_z_m, force_error, se, significant, .. } = *cell;
        let condition = &conditions[cell.condition].id;
        Self { condition, from_z_m, to_z_m, force_error, se, significant }
    }
}

impl Part {
    fn of(group: &Group) -> Self {
        let over = group.error.over;
        Self {
            over,
            unit: covariate::named(over).map_or("1", |covariate| covariate.unit),
            from: group.error.from,
            to: group.error.to,
            force_error: group.error.force_error,
            se: group.error.se,
            significant: group.significant,
        }
    }
}
