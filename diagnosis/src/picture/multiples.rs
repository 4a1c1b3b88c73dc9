//! Small panels of numbers along a path, each with its band of noise.

use measurements::Axis;
use plots::axes::Frame;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, GREY, Hover, PictureError, fitting, letters, padded, short, svg};
use plotters::prelude::*;

use crate::forward::NORMAL_95;
use crate::forward::observable::Observable;
use crate::misfit::residual::Residual;
use crate::where_it_fails::WhereItFails;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (270, 200);

/// One kind of number along the path of one condition.
pub(super) struct Track {
    /// Index of the condition in the set.
    condition: usize,
    observable: Observable,
    /// Places among the residuals, in the order of time or depth.
    pub(super) places: Vec<usize>,
}

/// A track with what is drawn of it.
pub(super) struct Panel {
    pub(super) title: String,
    /// What its numbers lie along, and what they are.
    pub(super) axes: [Axis; 2],
    /// Place and standard error (SI).
    pub(super) band: Vec<(f64, f64)>,
    /// Place and number (SI).
    pub(super) points: Vec<(f64, f64)>,
    /// Likewise, each in a colour.
    pub(super) lines: Vec<(RGBColor, Vec<(f64, f64)>)>,
}

/// The tracks among `residuals`.
pub(super) fn tracks(residuals: &[Residual]) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    for (place, one) in residuals.iter().enumerate().filter(|(_, one)| one.place().is_some()) {
        let Residual { condition, observable, .. } = *one;
        let of =
            |track: &&mut Track| (track.condition, track.observable) == (condition, observable);
        match tracks.iter_mut().find(of) {
            Some(track) => track.places.push(place),
            None => tracks.push(Track { condition, observable, places: vec![place] }),
        }
    }
    tracks
}

impl Track {
    /// What it is and under which condition.
    pub(super) fn title(&self, found: &WhereItFails<'_>) -> String {
        let condition = &found.set.conditions[self.condition];
        let axis = match self.observable {
            Observable::Depth => "z",
            Observable::Force => "force",
            Observable::Acceleration => "acceleration",
            Observable::Velocity => "velocity",
            Observable::Spin => "spin",
            _ => "x",
        };
        let (id, speed, angle) =
            (&condition.id, short(condition.speed), short(condition.angle_deg));
        format!("{axis}, {id}: {speed} m/s, {angle}\u{b0}")
    }

    /// What its numbers lie along, what they are, and their change along the way.
    pub(super) fn axes(&self) -> [Axis; 3] {
        self.observable.axes()
    }

    /// Root mean square of the residuals in standard errors.
    pub(super) fn misfit(&self, residuals: &[Residual]) -> f64 {
        let square = |one: &Residual| ((one.measured - one.predicted) / one.standard_error).powi(2);
        let sum: f64 = self.places.iter().map(|&place| square(&residuals[place])).sum();
        (sum / self.places.len() as f64).sqrt()
    }

    /// Standard errors along the path.
    pub(super) fn band(&self, residuals: &[Residual]) -> Vec<(f64, f64)> {
        self.along(residuals, |_, one| one.standard_error)
    }

    /// What `of` a place is, along the path (SI).
    pub(super) fn along(
        &self,
        residuals: &[Residual],
        of: impl Fn(usize, &Residual) -> f64,
    ) -> Vec<(f64, f64)> {
        let numbers = self.places.iter().map(|&place| (place, &residuals[place]));
        numbers.filter_map(|(place, one)| Some((one.place()?, of(place, one)))).collect()
    }
}

/// `panels` in `columns`, with what their lines mean.
pub(super) fn picture(
    panels: &[Panel],
    columns: usize,
    rows: &[(Sign, String)],
) -> Result<String, PictureError> {
    let columns = columns.min(panels.len()).max(2);
    let height = PANEL.1 * panels.len().div_ceil(columns) as u32;
    svg((PANEL.0 * columns as u32, height + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        let charts = charts.split_evenly((panels.len().div_ceil(columns), columns));
        for (panel, chart) in panels.iter().zip(&charts) {
            draw_panel(chart, panel)?;
        }
        legend::draw(&below, rows)
    })
}

fn draw_panel(area: &Area<'_>, panel: &Panel) -> Drawn {
    let title = fitting(&panel.title, PANEL.0 - 50);
    area.draw(&Text::new(title, (46, 5), letters()))?;
    let numbers = panel.lines.iter().flat_map(|(_, line)| line).chain(&panel.points);
    let band = panel.band.iter().map(|(t, se)| (*t, NORMAL_95 * se));
    let most =
        numbers.copied().chain(band.clone()).fold(1e-6, |most: f64, (_, y)| most.max(y.abs()));
    let [across, up] = panel.axes;
    let times = panel.band.iter().map(|(t, _)| across.scale * t);
    let (first, last) = (times.clone().fold(0.0, f64::min), times.fold(0.0, f64::max));
    let mut chart = Frame {
        ranges: [padded(first, last), padded(-up.scale * most, up.scale * most)],
        ticks: [5, 5],
        names: [&across.label(), &format!("({})", up.unit)],
        above: 24,
        below: 0,
        grid: false,
    }
    .draw(area)?;
    let outline: Vec<(f64, f64)> = band
        .clone()
        .map(|(t, half)| (across.scale * t, up.scale * half))
        .chain(band.rev().map(|(t, half)| (across.scale * t, -up.scale * half)))
        .collect();
    chart.draw_series([Polygon::new(outline, GREY.filled())])?;
    let range = [(first, 0.0), (last, 0.0)];
    chart.draw_series([PathElement::new(range, BLACK.stroke_width(1))])?;
    for (colour, line) in &panel.lines {
        let line = line.iter().map(|(t, y)| (across.scale * t, up.scale * y));
        chart.draw_series(LineSeries::new(line, colour.stroke_width(2)))?;
    }
    let points = panel.points.iter().map(|(t, y)| (across.scale * t, up.scale * y));
    chart.draw_series(points.map(|place| Circle::new(place, 2, BLACK.filled())))?;
    chart.draw_series(panel.values().map(|(place, text)| Hover::at(place, text)))?;
    Ok(())
}

impl Panel {
    /// Places (as drawn) with what they say.
    fn values(&self) -> impl Iterator<Item = ((f64, f64), String)> {
        let lines = self.lines.iter().flat_map(|(_, line)| line);
        let noise = |t: f64| self.band.iter().find(|(at, _)| at.to_bits() == t.to_bits());
        lines.chain(&self.points).map(move |&(t, y)| {
            let [across, up] = self.axes;
            let place = (across.scale * t, up.scale * y);
            let se =
                noise(t).map_or(String::new(), |(_, se)| format!(" \u{b1} {:.3}", up.scale * se));
            let ((x, y), title) = (place, &self.title);
            (place, format!("{title}\n{x:.1} {}: {y:+.3}{se} {}", across.unit, up.unit))
        })
    }
}
