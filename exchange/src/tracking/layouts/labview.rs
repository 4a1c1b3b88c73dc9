//! LabVIEW measurement files (`.lvm`): headers that end in `***End_of_Header***`, then columns of channels.

use super::{Layout, first_row};
use crate::tracking::fault::Fault;
use crate::tracking::grid::{Grid, Places};
use crate::tracking::heading::Role;
use crate::tracking::settings::Columns;
use crate::tracking::sheet::{Number, Row, Sheet};
use crate::tracking::track::{Measure, Track};
use crate::tracking::units::Unit;

pub(super) const LAYOUT: Layout = Layout { fits, read };

const END: &str = "***End_of_Header***";

fn fits(sheet: &Sheet, _: &Columns) -> bool {
    first_row(sheet).starts_with("labview measurement")
}

fn read(sheet: &Sheet, columns: &Columns) -> Result<Vec<Track>, Fault> {
    let Some(end) = sheet.rows.iter().rposition(|row| row.cell(0) == END) else {
        let right = format!("a line {END} stands above the names of channels");
        return Err(sheet.fault("its header does not end", right).at(1));
    };
    let Some(names) = sheet.rows.get(end + 1).filter(|row| row.cell(0) == "X_Value") else {
        let right = "the line behind the header begins with X_Value";
        return Err(sheet
            .fault("the names of the channels are missing", right)
            .at(sheet.rows[end].line));
    };
    let first = sheet.rows[..end].iter().position(|row| row.cell(0) == END).map_or(0, |at| at + 1);
    let of = |key: &str| sheet.rows[first..end].iter().find(|row| row.cell(0) == key);
    let grid = Grid::below(sheet, end + 1, None);
    let channels: Vec<usize> = (1..names.cells.len())
        .filter(|at| !matches!(names.cell(*at), "" | "Comment" | "X_Value"))
        .collect();
    let vertical = |at: &&usize| grid.headings[**at].role() == Some(Role::Vertical);
    let z = match columns.of(Role::Vertical) {
        Some(asked) => grid.named(asked)?,
        None => match (&channels[..], channels.iter().find(vertical)) {
            ([only], _) | (_, Some(only)) => *only,
            ([], None) => {
                return Err(sheet.fault("it has no channel", "write at least one").at(names.line));
            }
            (_, None) => {
                let names: Vec<&str> = channels.iter().map(|at| names.cell(*at)).collect();
                let right = format!("say which: --column z=\"{}\"", names[0]);
                return Err(sheet.fault(
                    format!("each of its channels may be the position: {}", names.join(", ")),
                    right,
                ));
            }
        },
    };
    // Behind `X_Value` there may be nothing: times follow from the first and the step then.
    let times = (0..=z).rev().find(|at| names.cell(*at) == "X_Value").unwrap_or(0);
    let has_times = grid.rows.first().is_some_and(|row| !row.cell(times).is_empty());
    let places = Places { t: has_times.then_some(times), z, x: None };
    let mut track = grid.track("LabVIEW", places, grid.all_rows())?;
    let value = |row: Option<&Row>, at: usize| match row.map(|row| sheet.number(row.cell(at))) {
        Some(Number::Value(value)) => Some(value),
        _ => None,
    };
    if !has_times {
        // One column of `X_Value` for all channels stands in front of them.
        let Some(step) = value(of("Delta_X"), z).or_else(|| value(of("Delta_X"), 1)) else {
            let right = "a line Delta_X, or times in the column X_Value";
            return Err(sheet.fault("neither X_Value nor Delta_X tells the times", right));
        };
        let start = value(of("X0"), z).or_else(|| value(of("X0"), 1)).unwrap_or(0.0);
        track.samples.iter_mut().for_each(|sample| sample.t = start + step * sample.t);
    }
    track.time = Measure { name: "X_Value".to_owned(), unit: Unit::Known("s".to_owned()) };
    if let Some(unit) = of("Y_Unit_Label").map(|row| row.cell(z)).filter(|unit| !unit.is_empty()) {
        track.vertical.unit = match unit.to_lowercase().as_str() {
            "meters" | "meter" => Unit::of("m"),
            _ => Unit::of(unit),
        };
    }
    Ok(vec![track])
}
