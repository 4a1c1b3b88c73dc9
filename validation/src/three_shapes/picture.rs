//! The study as pictures.

use plots::{Area, Canvas, Drawn, PictureError, colour, svg};
use plotters::prelude::*;

use super::{Case, FRICTIONS, Outcome, RUBBED, SHAPES, SPEEDS, group, mean_and_error};

const SIZE: (u32, u32) = (560, 400);

/// Depth over the energy of the impact, a colour per shape, with the standard error over beds.
pub fn depths(results: &[(Case, Outcome)]) -> Result<String, PictureError> {
    svg(SIZE, |area| draw_depths(area, results))
}

fn draw_depths(area: &Area<'_>, results: &[(Case, Outcome)]) -> Drawn {
    let highest = |of: fn(&Outcome) -> f64| {
        results.iter().map(|(_, outcome)| of(outcome)).fold(0.0, f64::max)
    };
    let (right, top) =
        (1.05e3 * highest(|one| one.impact_energy_j), 1.1e3 * highest(|one| one.depth_m));
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..right, 0.0..top)?;
    chart
        .configure_mesh()
        .x_desc("energy of the impact (mJ)")
        .y_desc("depth (mm)")
        .max_light_lines(0)
        .draw()?;
    for (number, model) in SHAPES.into_iter().enumerate() {
        let colour = colour(number);
        let points: Vec<(f64, f64, f64)> = SPEEDS
            .into_iter()
            .map(|speed| group(results, model, speed, None))
            .filter(|outcomes| !outcomes.is_empty())
            .map(|outcomes| {
                let depths: Vec<f64> = outcomes.iter().map(|one| 1e3 * one.depth_m).collect();
                let (mean, error) = mean_and_error(&depths);
                (1e3 * outcomes[0].impact_energy_j, mean, error)
            })
            .collect();
        let line = points.iter().map(|&(energy, mean, _)| (energy, mean));
        chart
            .draw_series(LineSeries::new(line, colour.stroke_width(1)))?
            .label(model.trim_end_matches("-3d"))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        for &(energy, mean, error) in &points {
            let bar = vec![(energy, mean - error), (energy, mean + error)];
            chart.draw_series([PathElement::new(bar, colour.stroke_width(2))])?;
            chart.draw_series([Circle::new((energy, mean), 4, colour.filled())])?;
        }
    }
    key(&mut chart)
}

/// Speed of the hemisphere over time with and without friction, a colour per bed.
pub fn frictions(results: &[(Case, Outcome)]) -> Result<String, PictureError> {
    svg(SIZE, |area| draw_frictions(area, results))
}

fn draw_frictions(area: &Area<'_>, results: &[(Case, Outcome)]) -> Drawn {
    let (model, speed) = RUBBED;
    let runs = FRICTIONS.map(|friction| group(results, model, speed, Some(friction)));
    let longest =
        runs.iter().flatten().filter_map(|one| one.time_s.last()).fold(0.0, |a: f64, b| a.max(*b));
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..1e3 * longest, -0.1 * speed..1.05 * speed)?;
    chart.configure_mesh().x_desc("time (ms)").y_desc("speed (m/s)").max_light_lines(0).draw()?;
    for (number, (friction, runs)) in FRICTIONS.into_iter().zip(&runs).enumerate() {
        let colour = colour(number);
        for (bed, run) in runs.iter().enumerate() {
            let line = run.time_s.iter().zip(&run.down_m_per_s).map(|(t, v)| (1e3 * t, *v));
            let series = chart.draw_series(LineSeries::new(line, colour.stroke_width(1)))?;
            if bed == 0 {
                series.label(format!("friction {friction}")).legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2))
                });
            }
        }
    }
    key(&mut chart)
}

type Chart<'a, 'b> = ChartContext<
    'a,
    Canvas<'b>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

fn key<'b: 'a, 'a>(chart: &mut Chart<'a, 'b>) -> Drawn {
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE)
        .border_style(WHITE)
        .draw()
}
