//! The force that a model lacks over depth, with its band, a panel per condition.

use measurements::MeasurementSet;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, fitting, letters, padded, svg};
use plotters::prelude::*;

use super::panel::framed;
use crate::forward::NORMAL_95;
use crate::missing_force::{Component, Reading};

/// Size of a panel (pixels), and panels side by side.
const PANEL: (u32, u32) = (313, 200);
const COLUMNS: usize = 3;

/// Most conditions with a panel of their own.
const CONDITIONS: usize = 12;

/// One in so many moments says its numbers.
const HOVERS: usize = 4;

/// How much of the colour a band has.
const PALE: f64 = 0.25;

pub(crate) fn missing_force(
    set: &MeasurementSet,
    readings: &[Reading],
) -> Result<String, PictureError> {
    let mut conditions: Vec<usize> = readings.iter().map(|one| one.condition).collect();
    conditions.dedup();
    conditions.truncate(CONDITIONS);
    let rows = conditions.len().div_ceil(COLUMNS).max(1);
    let height = PANEL.1 * rows as u32;
    let mut signs = vec![
        (Sign::Line(colour(1)), "force that the model lacks, against the motion".to_owned()),
        (Sign::Square(pale(1)), "its band, 95 %".to_owned()),
    ];
    if readings.iter().any(|one| one.sideways.is_some()) {
        let normal = "normal to the motion, out of the bed where the body sinks".to_owned();
        signs.extend([
            (Sign::Line(colour(2)), normal),
            (Sign::Square(pale(2)), "its band, 95 %".to_owned()),
        ]);
    }
    svg((PANEL.0 * COLUMNS as u32, height + legend::height(signs.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        let panels = charts.split_evenly((rows, COLUMNS));
        for (&condition, panel) in conditions.iter().zip(&panels) {
            let own: Vec<&Reading> =
                readings.iter().filter(|one| one.condition == condition).collect();
            draw(panel, &set.conditions[condition].id, &own)?;
        }
        legend::draw(&below, &signs)
    })
}

/// The colour of the band of a line in colour `index`, on white.
fn pale(index: usize) -> RGBColor {
    let RGBColor(r, g, b) = colour(index);
    let towards = |end: u8| (255.0 + (f64::from(end) - 255.0) * PALE).round() as u8;
    RGBColor(towards(r), towards(g), towards(b))
}

fn draw(area: &Area<'_>, name: &str, readings: &[&Reading]) -> Drawn {
    area.draw(&Text::new(fitting(name, PANEL.0 - 60), (52, 5), letters()))?;
    let deepest = readings.iter().map(|one| 1e3 * one.depth).fold(1e-3, f64::max);
    let ends = |part: Component| [-1.0, 1.0].map(|side| part.force + side * NORMAL_95 * part.se);
    let all = readings.iter().flat_map(|one| one.components().into_iter().flatten().flat_map(ends));
    let (least, most) =
        all.fold((0.0_f64, 1e-9_f64), |(least, most), x| (least.min(x), most.max(x)));
    let mut chart =
        framed(area, [padded(0.0, deepest), padded(least, most)], ["depth (mm)", "force (N)"])?;
    let place = |one: &Reading| 1e3 * one.depth;
    let of = |component: usize| -> Vec<(f64, Component)> {
        let part = |one: &&Reading| Some((place(one), one.components()[component]?));
        readings.iter().filter_map(part).collect()
    };
    let both = [of(0), of(1)].into_iter().zip([colour(1), colour(2)]);
    let both: Vec<_> = both.filter(|(all, _)| !all.is_empty()).collect();
    for (all, colour) in &both {
        let lower = all.iter().map(|(depth, part)| (*depth, ends(*part)[0]));
        let upper = all.iter().rev().map(|(depth, part)| (*depth, ends(*part)[1]));
        let band: Vec<(f64, f64)> = lower.chain(upper).collect();
        chart.draw_series([Polygon::new(band, colour.mix(PALE).filled())])?;
    }
    for (all, colour) in &both {
        let line = all.iter().map(|(depth, part)| (*depth, part.force));
        chart.draw_series(LineSeries::new(line, colour.stroke_width(2)))?;
    }
    chart.draw_series(LineSeries::new([(0.0, 0.0), (deepest, 0.0)], BLACK.stroke_width(1)))?;
    chart.draw_series(readings.iter().step_by(HOVERS).map(|one| {
        let text = format!(
            "{:.1} mm deep, {:.2} m/s\n{:+.3} \u{b1} {:.3} N; the model: {:.3} N",
            place(one),
            one.speed,
            one.force,
            one.se,
            one.model
        );
        Hover::at((place(one), one.force), text)
    }))?;
    Ok(())
}
