//! Curves as they were measured: force over depth, a panel per condition.

use measurements::{Condition, Curve, MeasurementSet, Run};
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, fitting, letters, padded, short, svg};
use plotters::prelude::*;

use super::panel::framed;

/// Size of a panel (pixels), and panels side by side.
pub(super) const PANEL: (u32, u32) = (313, 220);
pub(super) const COLUMNS: usize = 3;

/// Most conditions with a panel of their own.
const CONDITIONS: usize = 24;

/// Every reading of every run; empty of a set without curves.
pub(super) fn curves(set: &MeasurementSet) -> Result<String, PictureError> {
    let Some(curve) = set.kind.curve() else { return Ok(String::new()) };
    a_panel_each(set, (curve.value.name, &[]), |panel, condition, runs| {
        draw(panel, curve, condition, runs)
    })
}

/// A panel for each of the first conditions, drawn by `draw` with the runs of the condition. Below them stands that there
/// is a line per run of `what`, with more `signs`.
pub(super) fn a_panel_each(
    set: &MeasurementSet,
    (what, signs): (&str, &[(Sign, String)]),
    draw: impl Fn(&Area<'_>, &Condition, &[&Run]) -> Drawn,
) -> Result<String, PictureError> {
    let n = set.conditions.len().min(CONDITIONS);
    let rows = n.div_ceil(COLUMNS).max(1);
    let what = format!("{what}, a line per run; {n} of {} conditions", set.conditions.len());
    let signs = [&[(Sign::Line(colour(0)), what)], signs].concat();
    let height = PANEL.1 * rows as u32;
    svg((PANEL.0 * COLUMNS as u32, height + legend::height(signs.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        let panels = charts.split_evenly((rows, COLUMNS));
        for (at, (condition, panel)) in set.conditions.iter().zip(&panels).take(n).enumerate() {
            let own: Vec<&Run> = set.runs.iter().filter(|run| run.condition == at).collect();
            draw(panel, condition, &own)?;
        }
        legend::draw(&below, &signs)
    })
}

fn draw(area: &Area<'_>, curve: &Curve, condition: &Condition, runs: &[&Run]) -> Drawn {
    let Condition { id, speed, diameter, .. } = condition;
    let (diameter, speed) = (short(1e3 * diameter), short(*speed));
    let title = format!("{id}: {diameter} mm, {speed} m/s, {} runs", runs.len());
    area.draw(&Text::new(fitting(&title, PANEL.0 - 60), (52, 5), letters()))?;
    let (along, value) = (curve.along.axis(), curve.value);
    let samples = || runs.iter().flat_map(|run| &run.samples);
    let ends = |numbers: &mut dyn Iterator<Item = f64>| {
        numbers.fold((0.0_f64, 1e-9_f64), |(least, most), x| (least.min(x), most.max(x)))
    };
    let across = ends(&mut samples().map(|one| along.scale * one.at));
    let up = ends(&mut samples().map(|one| value.scale * one.value));
    let mut chart = framed(
        area,
        [padded(across.0, across.1), padded(up.0, up.1)],
        [&along.label(), &value.label()],
    )?;
    for run in runs {
        let line = run.samples.iter().map(|one| (along.scale * one.at, value.scale * one.value));
        chart.draw_series(LineSeries::new(line.clone(), colour(0).stroke_width(1)))?;
        chart.draw_series(line.map(|(x, y)| {
            let text = format!("{}\n{x:.2} {}: {y:.3} {}", run.name, along.unit, value.unit);
            Hover::at((x, y), text)
        }))?;
    }
    Ok(())
}
