//! A run over a run.

use exchange::read::BodyState;
use plotters::prelude::*;
use serde_json::Value;
use validation::picture::legend::{self, Sign};
use validation::picture::{Area, Drawn, GREY, Hover, PictureError, colour, letters, svg};

use super::Course;
use super::thin::places;
use crate::figure::figure;
use crate::numbers::{four_digits, list, texts};
use crate::page::{Number, Page, Part, Section, Table};
use crate::{ReportError, Texts};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (470, 300);

/// Places of a curve that say their values.
const PLACES: usize = 80;

/// A panel: the title of its axis, whether it runs downward, and its value of a state.
type Panel = (&'static str, bool, fn(&BodyState) -> f64);

const PANELS: [Panel; 2] = [
    ("depth (mm)", true, |state| 1e3 * state.depth),
    ("speed (m/s)", false, |state| state.velocity.norm()),
];

/// Depth and speed over time of two runs under their names.
///
/// # Errors
/// If the drawing fails.
pub fn picture(runs: [(&str, &Course); 2]) -> Result<String, PictureError> {
    let rows: Vec<(Sign, String)> = runs
        .iter()
        .enumerate()
        .map(|(at, (name, _))| (Sign::Line(colour(at)), (*name).to_owned()))
        .collect();
    svg((2 * PANEL.0, PANEL.1 + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(PANEL.1);
        for (panel, chart) in PANELS.iter().zip(charts.split_evenly((1, 2))) {
            draw(&chart, panel, &runs)?;
        }
        legend::draw(&below, &rows)
    })
}

fn draw(area: &Area<'_>, &(title, downward, value): &Panel, runs: &[(&str, &Course); 2]) -> Drawn {
    let curve = |course: &Course, body: usize| -> Vec<(f64, f64)> {
        course.bodies[body].states.iter().map(|one| (1e3 * one.time, value(one))).collect()
    };
    let curves: Vec<(usize, Vec<(f64, f64)>)> = runs
        .iter()
        .enumerate()
        .flat_map(|(at, (_, course))| {
            (0..course.bodies.len()).map(move |body| (at, curve(course, body)))
        })
        .collect();
    let points = || curves.iter().flat_map(|(_, points)| points);
    let last = points().fold(1e-9_f64, |last, point| last.max(point.0));
    let low = points().fold(0.0_f64, |low, point| low.min(point.1));
    let high = 1.06 * points().fold(1e-9_f64, |high, point| high.max(point.1));
    let up = if downward { high..low } else { low..high };
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
        .y_desc(title)
        .axis_desc_style(letters())
        .light_line_style(WHITE)
        .bold_line_style(GREY)
        .draw()?;
    for (at, points) in &curves {
        let style = colour(*at).stroke_width(2);
        chart.draw_series(LineSeries::new(points.iter().copied(), style))?;
        let times: Vec<f64> = points.iter().map(|point| point.0).collect();
        let name = runs[*at].0;
        chart.draw_series(places(&times, PLACES).into_iter().map(|place| {
            let (t, y) = points[place];
            Hover::at((t, y), format!("{name}\n{t:.2} ms\n{title}: {y:.3}"))
        }))?;
    }
    Ok(())
}

/// The page of `comparison`, a run against a run.
pub(crate) fn page(texts: &Texts, comparison: &Value) -> Result<String, ReportError> {
    let names = self::texts(&comparison["runs"]);
    let caption = "Depth and speed of both runs over time.";
    let paths: Vec<Part> =
        texts.get("paths.svg").map(|svg| figure(svg, caption)).into_iter().collect();
    let millimetres = |key: &str| match comparison["rms"][key].as_f64() {
        Some(value) => format!("{:.4} mm", 1e3 * value),
        None => "\u{2013}".to_owned(),
    };
    let page = Page {
        title: names.join(" and "),
        kind: "comparison of runs",
        lead: "How far two runs lie apart.".to_owned(),
        headline: vec![
            Number::new("depth", millimetres("z_m"), "root mean square along the path"),
            Number::new("range", millimetres("x_m"), "root mean square along the path"),
        ],
        sections: [
            Section::new("Paths", paths),
            Section::new("At the stop", vec![Part::Table(stops(&comparison["stop"]))]),
            Section::new("Energy dissipated", vec![Part::Table(energies(comparison))]),
        ]
        .into_iter()
        .flatten()
        .collect(),
        origin: vec![("plunge", env!("CARGO_PKG_VERSION").to_owned())],
    };
    page.html()
}

fn stops(stops: &Value) -> Table {
    let mut table = Table::new(&["", "A", "B", "B \u{2212} A", "relative"]);
    for (key, change) in stops.as_object().into_iter().flatten() {
        let [first, second] = [0, 1].map(|at| four_digits(&change["values"][at]));
        let (difference, relative) = (&change["difference"], &change["relative"]);
        let row = [key.clone(), first, second, four_digits(difference), four_digits(relative)];
        table.rows.push(row.into());
    }
    table
}

fn energies(comparison: &Value) -> Table {
    let mut table = Table::new(&["channel (J)", "A", "B"]);
    let channels = comparison["energy"]["dissipated_J"].as_object();
    for (name, values) in channels.into_iter().flatten() {
        let of = |at: usize| list(values).get(at).map_or(String::new(), four_digits);
        table.rows.push(vec![name.replace('_', " "), of(0), of(1)]);
    }
    table
}
