//! The numbers that say at a glance how near the article our impacts come, angle by angle.

use super::curves::Quantity;
use super::matrix::{self, Cell, READINGS};
use crate::published::row::Table;

/// Mean absolute deviations of `quantities` from their published curves, a line per angle and one of their means.
pub fn table(quantities: [&Quantity; 2], cells: &[Cell]) -> Table {
    let goals = quantities.map(|one| format!("{:.0} % of the {}", one.goal.half, one.name));
    let caption = format!(
        "Oblique impacts of a disc: mean absolute deviation of our means over positions from the article's published curves, \
         1 to 4 m/s (%), by angle, for both readings of its contact law. Asked: {}.",
        goals.join(" and ")
    );
    let mut table = Table::new(&caption, &["angle (deg)", "impacts"]);
    for quantity in quantities {
        let heads = READINGS.iter().map(|reading| format!("{}, {}", quantity.name, reading.name));
        table.head.extend(heads);
    }
    let mut columns = vec![Vec::new(); 2 * READINGS.len()];
    let shown = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.1}"));
    for angle in matrix::angles(cells) {
        let own = READINGS.iter().flat_map(|reading| matrix::of(cells, reading, angle));
        let impacts: usize = own.map(|cell| cell.records.len()).sum();
        let mut line = vec![format!("{angle}"), impacts.to_string()];
        let each = quantities.into_iter().flat_map(|quantity| {
            READINGS.iter().map(move |reading| quantity.deviation(cells, reading, angle))
        });
        for (column, deviation) in columns.iter_mut().zip(each) {
            column.extend(deviation);
            line.push(shown(deviation));
        }
        table.rows.push(line);
    }
    let impacts: usize = cells.iter().map(|cell| cell.records.len()).sum();
    let mut means = vec!["mean".to_owned(), impacts.to_string()];
    means.extend(columns.iter().map(|column| {
        let n = column.len() as f64;
        shown((n > 0.0).then(|| column.iter().sum::<f64>() / n))
    }));
    table.rows.push(means);
    table
}
