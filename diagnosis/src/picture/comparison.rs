//! A comparison as one picture: measured numbers with their errors, and what each revision predicts.

use measurements::{MeasurementSet, Role};
use plots::axes::Frame;
use plots::{Area, COLOURS, Drawn, Hover, PictureError, letters, short, svg};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use crate::compare::Comparison;
use crate::forward::observable::Observable;

/// Size of one panel (pixels).
const PANEL: (u32, u32) = (420, 330);

/// Dashes of the revisions, in pixels on and off.
const DASHES: [(u32, u32); 4] = [(4, 3), (1, 0), (9, 3), (2, 2)];

/// A number of one condition, measured and predicted.
struct Point {
    condition: String,
    angle_deg: f64,
    speed: f64,
    measured: f64,
    error: f64,
    held_out: bool,
    predicted: Vec<f64>,
}

/// A panel: its title, what its numbers are multiplied with, and the numbers.
struct Panel {
    title: &'static str,
    scale: f64,
    points: Vec<Point>,
}

impl Panel {
    /// The numbers of `point`, as whoever points at it reads them; `names` are those of the revisions.
    fn says(&self, point: &Point, names: &[&str]) -> String {
        let shown = |value: f64| short(self.scale * value);
        let mut text = format!(
            "{}: {} m/s, {}\u{b0}\n{}\nmeasured {} \u{b1} {}",
            point.condition,
            point.speed,
            point.angle_deg,
            self.title,
            shown(point.measured),
            shown(point.error)
        );
        for (name, predicted) in names.iter().zip(&point.predicted) {
            text.push_str(&format!("\n{name}: {}", shown(*predicted)));
        }
        text
    }
}

/// Scalars over speed, a colour per angle and a dash per revision, as SVG; `None` where a set has
/// trajectories alone.
pub fn comparison(
    set: &MeasurementSet,
    comparison: &Comparison,
) -> Result<Option<String>, PictureError> {
    let panels = panels(set, comparison);
    if panels.is_empty() {
        return Ok(None);
    }
    let names: Vec<&str> = comparison.models.iter().map(|model| model.model.as_str()).collect();
    let size = (PANEL.0 * panels.len() as u32, PANEL.1 + 22 * (1 + names.len() as u32));
    svg(size, |area| draw(area, &panels, &names)).map(Some)
}

fn panels(set: &MeasurementSet, comparison: &Comparison) -> Vec<Panel> {
    let kinds = [
        (Observable::StopTime, "stopping time (ms)", 1e3),
        (Observable::FinalDepth, "final depth (mm)", 1e3),
        (Observable::FinalRange, "final range (mm)", 1e3),
    ];
    let Some(first) = comparison.models.first() else { return Vec::new() };
    let mut panels: Vec<Panel> =
        kinds.iter().map(|&(_, title, scale)| Panel { title, scale, points: Vec::new() }).collect();
    for (place, number) in first.failing.residuals.iter().enumerate() {
        let Some(panel) = kinds.iter().position(|(kind, ..)| *kind == number.observable) else {
            continue;
        };
        let condition = &set.conditions[number.condition];
        panels[panel].points.push(Point {
            condition: condition.id.clone(),
            angle_deg: condition.angle_deg,
            speed: condition.speed,
            measured: number.measured,
            error: number.standard_error,
            held_out: condition.role == Role::Holdout,
            predicted: comparison
                .models
                .iter()
                .map(|model| model.failing.residuals[place].predicted)
                .collect(),
        });
    }
    panels.retain(|panel| !panel.points.is_empty());
    panels
}

fn draw(area: &Area<'_>, panels: &[Panel], names: &[&str]) -> Drawn {
    let (charts, legend) = area.split_vertically(PANEL.1);
    for (panel, chart) in panels.iter().zip(charts.split_evenly((1, panels.len()))) {
        draw_panel(&chart, panel, names)?;
    }
    let font = ("sans-serif", 14).into_font();
    for (row, name) in names.iter().enumerate() {
        let y = 12 + 20 * row as i32;
        let line = vec![(20, y), (70, y)];
        let (on, off) = DASHES[row % DASHES.len()];
        let line = DashedPathElement::new(line, on, off, BLACK.stroke_width(2));
        legend.draw(&line)?;
        legend.draw(&Text::new((*name).to_owned(), (80, y - 7), font.clone()))?;
    }
    let y = 12 + 20 * names.len() as i32;
    legend.draw(&Circle::new((45, y), 4, BLACK.filled()))?;
    let note = "measured, with its error; open: held out. Colour: angle from the horizontal";
    legend.draw(&Text::new(note, (80, y - 7), font))
}

fn draw_panel(area: &Area<'_>, panel: &Panel, names: &[&str]) -> Drawn {
    let mut angles: Vec<f64> = panel.points.iter().map(|point| point.angle_deg).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let highest = |of: fn(&Point) -> f64| panel.points.iter().map(of).fold(0.0_f64, f64::max);
    let top = highest(|point| {
        point.predicted.iter().copied().fold(point.measured + point.error, f64::max)
    });
    let right = 1.05 * highest(|point| point.speed);
    area.draw(&Text::new(panel.title, (52, 8), letters()))?;
    let mut chart = Frame {
        ranges: [0.0..right, 0.0..1.1 * top * panel.scale],
        ticks: [8, 8],
        names: ["impact speed (m/s)", ""],
        above: 30,
        below: 0,
        grid: true,
    }
    .draw(area)?;
    for (number, angle) in angles.iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        let mut points: Vec<&Point> = panel
            .points
            .iter()
            .filter(|point| point.angle_deg.to_bits() == angle.to_bits())
            .collect();
        points.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        for revision in 0..points.first().map_or(0, |point| point.predicted.len()) {
            let (on, off) = DASHES[revision % DASHES.len()];
            let line =
                points.iter().map(|point| (point.speed, panel.scale * point.predicted[revision]));
            chart.draw_series(DashedLineSeries::new(line, on, off, colour.stroke_width(2)))?;
        }
        for point in &points {
            let at = |value: f64| (point.speed, panel.scale * value);
            let bar = vec![at(point.measured - point.error), at(point.measured + point.error)];
            chart.draw_series([PathElement::new(bar, colour.stroke_width(1))])?;
            let fill = if point.held_out { WHITE.filled() } else { colour.filled() };
            chart.draw_series([Circle::new(at(point.measured), 4, fill)])?;
            chart.draw_series([Circle::new(at(point.measured), 4, colour.stroke_width(1))])?;
            let hover = Hover::at(at(point.measured), panel.says(point, names));
            chart.draw_series([hover])?;
        }
        if angles.len() > 1
            && let Some(last) = points.last()
        {
            let label = format!("{angle}\u{b0}");
            let style = ("sans-serif", 12).into_font().color(&colour);
            let place = (last.speed * 1.01, panel.scale * last.measured);
            chart.draw_series([Text::new(label, place, style)])?;
        }
    }
    Ok(())
}
