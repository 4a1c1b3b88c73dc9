//! Depth, distance and velocity over time.

use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, letters, svg};
use plotters::prelude::*;
use runner::run::Summary;

use super::Course;
use super::thin::places;
use exchange::read::{BodyState, BodyStates};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (470, 300);

/// Columns that say their values.
const COLUMNS: usize = 120;

/// A curve of one body.
struct Curve {
    name: String,
    sign: Sign,
    /// Dashed, along the horizontal motion.
    along: bool,
    points: Vec<(f64, f64)>,
}

/// One of the two panels.
struct Panel {
    axis: &'static str,
    unit: &'static str,
    curves: Vec<Curve>,
    /// Which way the axis runs.
    downward: bool,
}

/// The panels of `course`, the stop as `summary` has it.
pub(super) fn picture(course: &Course, summary: &Summary) -> Result<String, PictureError> {
    let moves_along = course.bodies.iter().any(moves_along);
    let panels = [
        Panel {
            axis: "position (mm)",
            unit: "mm",
            curves: curves(course, moves_along, |body, state, along| {
                let start = body.states.first().map_or(0.0, |first| first.position.x);
                1e3 * if along { state.position.x - start } else { state.depth }
            }),
            downward: true,
        },
        Panel {
            axis: "velocity (m/s)",
            unit: "m/s",
            curves: curves(course, moves_along, |_, state, along| {
                if along { state.velocity.x } else { -state.velocity.z }
            }),
            downward: false,
        },
    ];
    let rows: Vec<(Sign, String)> =
        panels[0].curves.iter().map(|curve| (curve.sign, curve.name.clone())).collect();
    let stop = summary.stop.stopping_time_s;
    svg((2 * PANEL.0, PANEL.1 + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(PANEL.1);
        for (panel, chart) in panels.iter().zip(charts.split_evenly((1, 2))) {
            panel.draw(&chart, stop)?;
        }
        legend::draw(&below, &rows)
    })
}

/// Whether a body goes anywhere but down: by more than a thousandth of its depth.
fn moves_along(body: &BodyStates) -> bool {
    let start = body.states.first().map_or(0.0, |first| first.position.x);
    let most = |of: &dyn Fn(&BodyState) -> f64| {
        body.states.iter().fold(0.0_f64, |most, state| most.max(of(state).abs()))
    };
    most(&|state| state.position.x - start) > 1e-3 * most(&|state| state.depth)
}

fn curves(
    course: &Course,
    moves_along: bool,
    value: impl Fn(&BodyStates, &BodyState, bool) -> f64,
) -> Vec<Curve> {
    let one = course.bodies.len() == 1;
    let mut curves = Vec::new();
    for (at, body) in course.bodies.iter().enumerate() {
        let directions = if moves_along { &[false, true][..] } else { &[false] };
        for &along in directions {
            let direction = if along { "along the surface" } else { "downward" };
            let points =
                body.states.iter().map(|state| (1e3 * state.time, value(body, state, along)));
            curves.push(Curve {
                name: if one {
                    direction.to_owned()
                } else {
                    format!("{}, {direction}", body.name)
                },
                sign: if along { Sign::Dashed(colour(at)) } else { Sign::Line(colour(at)) },
                along,
                points: points.collect(),
            });
        }
    }
    curves
}

impl Panel {
    fn draw(&self, area: &Area<'_>, stop: Option<f64>) -> Drawn {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let last = points().fold(0.0_f64, |last, point| last.max(point.0)).max(1e-9);
        let low = points().fold(0.0_f64, |low, point| low.min(point.1));
        let high = points().fold(1e-9_f64, |high, point| high.max(point.1));
        let pad = 0.06 * (high - low);
        let (low, high) = (if low < 0.0 { low - pad } else { low }, high + pad);
        let up = if self.downward { high..low } else { low..high };
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(56)
            .build_cartesian_2d(0.0..last, up)?;
        chart
            .configure_mesh()
            .x_labels(6)
            .y_labels(6)
            .x_desc("time (ms)")
            .y_desc(self.axis)
            .axis_desc_style(letters())
            .light_line_style(WHITE)
            .bold_line_style(plots::GREY)
            .draw()?;
        if let Some(stop) = stop.map(|stop| 1e3 * stop).filter(|stop| *stop <= last) {
            let line = [(stop, low), (stop, high)];
            chart.draw_series(DashedLineSeries::new(line, 4, 4, BLACK.stroke_width(1)))?;
        }
        for curve in &self.curves {
            let points = curve.points.iter().copied();
            let (Sign::Line(ink) | Sign::Dashed(ink)) = curve.sign else { continue };
            let style = ink.stroke_width(2);
            match curve.along {
                true => chart.draw_series(DashedLineSeries::new(points, 6, 4, style))?,
                false => chart.draw_series(LineSeries::new(points, style))?,
            };
        }
        chart.draw_series(
            self.columns(last)
                .into_iter()
                .map(|([from, to], text)| Hover::over([(from, low), (to, high)], text)),
        )?;
        Ok(())
    }

    /// Parts of the time up to `last` (ms) with the values in them.
    fn columns(&self, last: f64) -> Vec<([f64; 2], String)> {
        let Some(first) = self.curves.first() else { return Vec::new() };
        let times: Vec<f64> = first.points.iter().map(|point| point.0).collect();
        let kept = places(&times, COLUMNS);
        let middle = |a: usize, b: usize| 0.5 * (times[a] + times[b]);
        let column = |(at, &place): (usize, &usize)| {
            let from = at.checked_sub(1).map_or(0.0, |before| middle(kept[before], place));
            let to = kept.get(at + 1).map_or(last, |&after| middle(place, after));
            let mut text = format!("{:.2} ms", times[place]);
            for curve in &self.curves {
                if let Some((_, value)) = curve.points.get(place) {
                    text.push_str(&format!("\n{}: {value:.3} {}", curve.name, self.unit));
                }
            }
            ([from, to], text)
        };
        kept.iter().enumerate().map(column).collect()
    }
}
