//! Force errors of conditions over speed and angle, one panel per intruder and model.

use measurements::Condition;
use plots::axes::Frame;
use plots::{Area, Drawn, Hover, PictureError, fitting, legend, letters, padded, short, svg};
use plotters::prelude::*;

use super::signed::{self, Scale};
use crate::misfit::force_error::ForceCell;
use crate::where_it_fails::WhereItFails;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (330, 270);

/// Height of a panel of one angle (pixels).
const ROW: u32 = 150;

/// Most panels side by side.
const COLUMNS: usize = 4;

/// Least and greatest edge of a cell (pixels).
const EDGES: (f64, f64) = (8.0, 26.0);

struct Panel<'a> {
    titles: [String; 2],
    cells: Vec<(&'a Condition, &'a ForceCell)>,
}

pub(crate) fn speed_angle(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let (panels, intruders) = panels(found);
    if panels.is_empty() {
        return Ok(None);
    }
    let scale = Scale::of(found.models.iter().flat_map(|model| &model.force_errors.means));
    let columns = intruders.min(COLUMNS);
    let rows = panels.len().div_ceil(columns);
    let one_angle = |panel: &Panel<'_>| values(panel, |condition| condition.angle_deg).len() == 1;
    let height = if panels.iter().all(one_angle) { ROW } else { PANEL.1 } * rows as u32;
    let width = (PANEL.0 * columns as u32).max(2 * PANEL.0);
    svg((width, height + signed::HEIGHT), |area| {
        let (maps, below) = area.split_vertically(height);
        let (maps, _) = maps.split_horizontally(PANEL.0 * columns as u32);
        for (panel, map) in panels.iter().zip(maps.split_evenly((rows, columns))) {
            draw_panel(&map, panel, &scale)?;
        }
        scale.draw(&below)
    })
    .map(Some)
}

/// Model by model, intruder by intruder, those with anything in them, and how many intruders there are.
fn panels<'a>(found: &'a WhereItFails<'_>) -> (Vec<Panel<'a>>, usize) {
    let mut intruders: Vec<String> = Vec::new();
    let mut panels = Vec::new();
    let condition = |cell: &ForceCell| &found.set.conditions[cell.condition];
    for cell in found.models.iter().flat_map(|model| &model.force_errors.means) {
        let name = intruder(condition(cell));
        if !intruders.contains(&name) {
            intruders.push(name);
        }
    }
    for model in &found.models {
        for name in &intruders {
            let own = model.force_errors.means.iter().map(|cell| (condition(cell), cell));
            let cells: Vec<_> = own.filter(|(condition, _)| intruder(condition) == *name).collect();
            if !cells.is_empty() {
                panels.push(Panel { titles: [model.model.clone(), name.clone()], cells });
            }
        }
    }
    (panels, intruders.len())
}

fn intruder(condition: &Condition) -> String {
    let diameter = format!("{}, {} mm", condition.shape, short(1e3 * condition.diameter));
    // Of a body that is pushed no mass is stated.
    match condition.mass > 0.0 {
        true => format!("{diameter}, {} g", short(1e3 * condition.mass)),
        false => diameter,
    }
}

fn draw_panel(area: &Area<'_>, panel: &Panel<'_>, scale: &Scale) -> Drawn {
    for (row, title) in panel.titles.iter().enumerate() {
        let place = (56, 6 + 17 * row as i32);
        area.draw(&Text::new(fitting(title, PANEL.0 - 60), place, letters()))?;
    }
    let speeds = values(panel, |condition| condition.speed);
    let angles = values(panel, |condition| condition.angle_deg);
    let (Some(slowest), Some(fastest)) = (speeds.first(), speeds.last()) else { return Ok(()) };
    let (Some(flattest), Some(steepest)) = (angles.first(), angles.last()) else { return Ok(()) };
    let (across, up) = (padded(*slowest, *fastest), padded(*flattest, *steepest));
    // Along a single value there is no axis.
    let (speed, angle) =
        (format!("{} m/s", short(*slowest)), format!("{}\u{b0}", short(*flattest)));
    let [speeds_along, angles_along] = [&speeds, &angles].map(|values| values.len() > 1);
    let chart = Frame {
        ranges: [across.clone(), up.clone()],
        ticks: [if speeds_along { 6 } else { 0 }, if angles_along { 6 } else { 0 }],
        names: [
            if speeds_along { "impact speed (m/s)" } else { &speed },
            if angles_along { "angle (deg)" } else { &angle },
        ],
        above: 42,
        below: 0,
        grid: true,
    }
    .draw(area)?;
    let plot = chart.plotting_area();
    let (wide, high) = plot.dim_in_pixel();
    let edge = |values: &[f64], range: std::ops::Range<f64>, pixels: u32| {
        let gap = values.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let pixels = 0.9 * gap / (range.end - range.start) * f64::from(pixels);
        (0.5 * pixels.clamp(EDGES.0, EDGES.1)) as i32
    };
    let (w, h) = (edge(&speeds, across, wide), edge(&angles, up, high));
    let inside = plot.strip_coord_spec();
    let corner = plot.get_base_pixel();
    for (condition, cell) in &panel.cells {
        let (x, y) = plot.map_coordinate(&(condition.speed, condition.angle_deg));
        let (x, y) = (x - corner.0, y - corner.1);
        let place = [(x - w, y - h), (x + w, y + h)];
        let colour = scale.colour(cell.force_error, cell.se);
        inside.draw(&Rectangle::new(place, colour.filled()))?;
        inside.draw(&Rectangle::new(place, BLACK.stroke_width(1)))?;
        if cell.significant {
            legend::mark(&inside, (x, y))?;
        }
        let Condition { id, speed, angle_deg, .. } = condition;
        let text = format!("{id}: {speed} m/s, {angle_deg}\u{b0}\n{}", signed::in_words(cell));
        inside.draw(&Hover::over(place, text))?;
    }
    Ok(())
}

fn values(panel: &Panel<'_>, of: impl Fn(&Condition) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = panel.cells.iter().map(|(condition, _)| of(condition)).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
