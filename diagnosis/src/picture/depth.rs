//! Force errors over depth, one column per condition, one panel per model.

use plots::axes::Frame;
use plots::{Area, Drawn, Hover, LETTER, PictureError, fitting, legend, letters, svg, upright};
use plotters::prelude::*;

use super::signed::{self, Scale};
use crate::misfit::force_error::ForceCell;
use crate::where_it_fails::{Failing, WhereItFails};

/// Height of the depths of one model (pixels).
const MAP: u32 = 240;

/// What stands above the depths, and at their left (pixels).
const ABOVE: u32 = 34;
const LEFT: u32 = 60;

/// Least and greatest width of a column, and least width of all (pixels).
const COLUMN: (u32, u32) = (18, 44);
const WIDTH: u32 = 660;

/// Room for the name of a condition (pixels).
const NAME: (u32, u32) = (30, 140);

pub(crate) fn depth(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let cells = || found.models.iter().flat_map(|model| &model.force_errors.cells);
    let mut conditions: Vec<usize> = cells().map(|cell| cell.condition).collect();
    let is_resolved = cells().any(|cell| cell.from > 0.0);
    conditions.sort_unstable();
    conditions.dedup();
    if conditions.is_empty() || !is_resolved {
        return Ok(None);
    }
    let names: Vec<String> = conditions
        .iter()
        .map(|&condition| fitting(&found.set.conditions[condition].id, NAME.1))
        .collect();
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let below = ((longest as f64 * LETTER) as u32 + 12).clamp(NAME.0, NAME.1);
    let n = conditions.len() as u32;
    let column = ((WIDTH - LEFT - 20) / n).clamp(COLUMN.0, COLUMN.1);
    let width = (LEFT + 20 + n * column).max(WIDTH);
    // A model without resolved errors has no map.
    let shown: Vec<&Failing> =
        found.models.iter().filter(|model| !model.force_errors.cells.is_empty()).collect();
    let height = (ABOVE + MAP + below) * shown.len() as u32;
    let scale = Scale::of(cells());
    svg((width, height + signed::HEIGHT), |area| {
        let (maps, legend) = area.split_vertically(height);
        let maps = maps.split_evenly((shown.len(), 1));
        for (model, map) in shown.iter().zip(&maps) {
            let (map, _) = map.split_horizontally(LEFT + 20 + n * column);
            draw_map(&map, model, (&conditions, &names), below, &scale)?;
        }
        scale.draw(&legend)
    })
    .map(Some)
}

fn draw_map(
    area: &Area<'_>,
    model: &Failing,
    (conditions, names): (&[usize], &[String]),
    below: u32,
    scale: &Scale,
) -> Drawn {
    area.draw(&Text::new(model.model.clone(), (LEFT as i32, 8), letters()))?;
    let cells = &model.force_errors.cells;
    let deepest = cells.iter().fold(0.0_f64, |deepest, cell| deepest.max(cell.to));
    let n = conditions.len();
    let chart = Frame {
        ranges: [0.0..n as f64, 1e3 * deepest..0.0],
        ticks: [0, 6],
        names: ["", "depth (mm)"],
        above: ABOVE,
        below,
        grid: true,
    }
    .draw(area)?;
    let plot = chart.plotting_area();
    let (inside, corner) = (plot.strip_coord_spec(), plot.get_base_pixel());
    let pixel = |x: f64, z: f64| {
        let (x, y) = plot.map_coordinate(&(x, 1e3 * z));
        (x - corner.0, y - corner.1)
    };
    let column = |cell: &ForceCell| conditions.iter().position(|&c| c == cell.condition);
    for (place, cell) in cells.iter().filter_map(|cell| Some((column(cell)? as f64, cell))) {
        let corners = [pixel(place + 0.08, cell.from), pixel(place + 0.92, cell.to)];
        let colour = scale.colour(cell.force_error, cell.se);
        inside.draw(&Rectangle::new(corners, colour.filled()))?;
        inside.draw(&Rectangle::new(corners, BLACK.stroke_width(1)))?;
        if cell.significant {
            legend::mark(&inside, pixel(place + 0.5, 0.5 * (cell.from + cell.to)))?;
        }
        let text = format!(
            "{}, {:.1} to {:.1} mm deep\n{}",
            names[place as usize],
            1e3 * cell.from,
            1e3 * cell.to,
            signed::in_words(cell)
        );
        inside.draw(&Hover::over(corners, text))?;
    }
    let bottom = (ABOVE + MAP + 6) as i32;
    for (place, name) in names.iter().enumerate() {
        let x = plot.map_coordinate(&(place as f64 + 0.5, 0.0)).0 - area.get_pixel_range().0.start;
        area.draw(&Text::new(name.clone(), (x, bottom), upright()))?;
    }
    Ok(())
}
