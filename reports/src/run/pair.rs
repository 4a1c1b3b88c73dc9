//! A run over a run.

use exchange::read::BodyState;
use plots::axes;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, svg};
use plotters::prelude::*;
use serde_json::Value;

use super::Course;
use super::thin::places;
use crate::figure::figure;
use crate::numbers::{fixed, list, prefix_of, texts, with_prefix};
use crate::page::{Number, Page, Part, Section};
use crate::tables::Table;
use crate::{ReportError, Texts};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (470, 300);

/// Places of a curve that say their values.
const PLACES: usize = 40;

/// What is shown of a run: a curve over time (s) for each of its bodies, or one.
type Curves = Vec<Vec<(f64, f64)>>;

/// A panel: what its axis says, in which unit, and whether it runs downward.
struct Panel {
    title: &'static str,
    unit: &'static str,
    downward: bool,
    of: fn(&Course) -> Curves,
}

const PANELS: [Panel; 4] = [
    Panel {
        title: "depth",
        unit: "m",
        downward: true,
        of: |course| of_states(course, |state| state.depth),
    },
    Panel {
        title: "speed",
        unit: "m/s",
        downward: false,
        of: |course| of_states(course, |state| state.velocity.norm()),
    },
    Panel {
        title: "given away by the intruder",
        unit: "J",
        downward: false,
        of: |course| of_energies(course, ["kinetic_intruder", "potential_intruder"], -1.0),
    },
    Panel {
        title: "grains in motion and height",
        unit: "J",
        downward: false,
        of: |course| of_energies(course, ["kinetic_grains", "potential_grains"], 1.0),
    },
];

fn of_states(course: &Course, value: fn(&BodyState) -> f64) -> Curves {
    let of_body = |states: &[BodyState]| states.iter().map(|one| (one.time, value(one))).collect();
    course.bodies.iter().map(|body| of_body(&body.states)).collect()
}

/// The sum of the energies (J) whose names start with one of `kinds`, since the start, times
/// `sign`; none of a run that has no such energies.
fn of_energies(course: &Course, kinds: [&str; 2], sign: f64) -> Curves {
    let Some(energy) = &course.energy else { return Vec::new() };
    let terms = energy.terms.iter().zip(&energy.values);
    let of_kinds: Vec<&Vec<f64>> = terms
        .filter(|(term, _)| kinds.iter().any(|kind| term.starts_with(kind)))
        .map(|(_, values)| values)
        .collect();
    if of_kinds.is_empty() {
        return Vec::new();
    }
    let since_start =
        |place: usize| of_kinds.iter().map(|values| values[place] - values[0]).sum::<f64>();
    let times = energy.time.iter().enumerate();
    vec![times.map(|(place, time)| (*time, sign * since_start(place))).collect()]
}

/// What the runs are called in tables.
const SIDES: [&str; 2] = ["A", "B"];

/// How the first body of a run comes in; nothing without one.
fn contact(course: &Course) -> String {
    let Some(state) = course.bodies.first().and_then(|body| body.states.first()) else {
        return String::new();
    };
    let angle = libm::atan2(-state.velocity.z, state.velocity.x.abs()).to_degrees();
    format!(", {} m/s at {angle:.0}\u{b0} at contact", plots::short(state.velocity.norm()))
}

/// Depth, speed and energies over time of two runs under their names: of the energies those that
/// every program tells.
pub fn picture(runs: [(&str, &Course); 2]) -> Result<String, PictureError> {
    let rows: Vec<(Sign, String)> = runs
        .iter()
        .enumerate()
        .map(|(at, (name, course))| {
            let text = format!("{}: {name}{}", SIDES[at], contact(course));
            (Sign::Line(colour(at)), text)
        })
        .collect();
    let panels: Vec<(&Panel, [Curves; 2])> = PANELS
        .iter()
        .map(|panel| (panel, runs.map(|(_, course)| (panel.of)(course))))
        .filter(|(_, of_runs)| of_runs.iter().any(|curves| !curves.is_empty()))
        .collect();
    let lines = panels.len().div_ceil(2);
    let height = lines as u32 * PANEL.1;
    svg((2 * PANEL.0, height + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        for ((panel, of_runs), chart) in panels.iter().zip(charts.split_evenly((lines, 2))) {
            draw(&chart, panel, of_runs, runs.map(|(name, _)| name))?;
        }
        legend::draw(&below, &rows)
    })
}

fn draw(area: &Area<'_>, panel: &Panel, of_runs: &[Curves; 2], names: [&str; 2]) -> Drawn {
    let points = || of_runs.iter().flatten().flatten();
    let most = points().fold(0.0_f64, |most, point| most.max(point.1.abs()));
    let (factor, prefix) = match panel.unit {
        // A depth in millimetres, as in the tables.
        "m" => (1e3, "m"),
        "J" => prefix_of(most),
        _ => (1.0, ""),
    };
    let title = format!("{} ({prefix}{})", panel.title, panel.unit);
    let last = 1e3 * points().fold(1e-12_f64, |last, point| last.max(point.0));
    let low = 1.06 * factor * points().fold(0.0_f64, |low, point| low.min(point.1));
    let high = 1.06 * factor * points().fold(1e-12_f64, |high, point| high.max(point.1));
    let up = if panel.downward { high..low } else { low..high };
    let mut chart = axes::chart(area, [0.0..last, up], 6, ["time (ms)", &title])?;
    for (at, curves) in of_runs.iter().enumerate() {
        for curve in curves {
            let points: Vec<(f64, f64)> =
                curve.iter().map(|(t, y)| (1e3 * t, factor * y)).collect();
            let style = colour(at).stroke_width(2);
            chart.draw_series(LineSeries::new(points.iter().copied(), style))?;
            let times: Vec<f64> = points.iter().map(|point| point.0).collect();
            let name = names[at];
            chart.draw_series(places(&times, PLACES).into_iter().map(|place| {
                let (t, y) = points[place];
                Hover::at((t, y), format!("{name}\n{t:.2} ms\n{title}: {y:.3}"))
            }))?;
        }
    }
    Ok(())
}

/// The page of `comparison`, a run against a run.
pub(crate) fn page(texts: &Texts, comparison: &Value) -> Result<String, ReportError> {
    // A comparison of before has names alone.
    let names = self::texts(comparison.get("labels").unwrap_or(&comparison["runs"]));
    let caption = "Depth and speed of both runs over time, what the intruder has given away of its energy of motion \
                   and height, and what grains have of that since the start.";
    let paths: Vec<Part> =
        texts.get("paths.svg").map(|svg| figure(svg, caption)).into_iter().collect();
    let millimetres = |key: &str| match comparison["rms"][key].as_f64() {
        Some(value) => format!("{:.2} mm", 1e3 * value),
        None => "\u{2013}".to_owned(),
    };
    let page = Page {
        title: names.join(" and "),
        kind: "comparison of runs",
        lead: lead(&names, &self::texts(&comparison["notes"])),
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

/// What is compared, and what is easily overlooked of it.
fn lead(names: &[String], notes: &[String]) -> String {
    let mut lead = match names {
        [a, b] => format!("How far two runs lie apart: A is {a}, B is {b}."),
        _ => "How far two runs lie apart.".to_owned(),
    };
    for note in notes {
        lead.push_str(&format!(" Note: {note}."));
    }
    lead
}

fn stops(stops: &Value) -> Table {
    let mut table = Table::new(&["", "A", "B", "B \u{2212} A", "of A"]);
    for (key, change) in stops.as_object().into_iter().flatten() {
        let (name, scale) = in_words(key);
        let shown = |value: &Value| fixed(value.as_f64().map(|value| scale * value), 2);
        let [first, second] = [0, 1].map(|at| shown(&change["values"][at]));
        let relative = change["relative"].as_f64();
        let relative =
            relative.map_or("\u{2013}".to_owned(), |share| format!("{:+.1} %", 1e2 * share));
        table.rows.push(vec![name, first, second, shown(&change["difference"]), relative]);
    }
    table
}

/// A key of a result as it is said, with the unit it is shown in, and the factor to that.
fn in_words(key: &str) -> (String, f64) {
    let (name, unit, scale) = match (key.strip_suffix("_s"), key.strip_suffix("_m")) {
        (Some(name), _) => (name, " (ms)", 1e3),
        (_, Some(name)) => (name, " (mm)", 1e3),
        _ => (key, "", 1.0),
    };
    (format!("{}{unit}", name.replace('_', " ")), scale)
}

fn energies(comparison: &Value) -> Table {
    let mut table = Table::new(&["channel", "A", "B"]);
    let energy = |value: &Value| match value.as_f64() {
        Some(value) => with_prefix(value, "J"),
        None => "\u{2013}".to_owned(),
    };
    let channels = comparison["energy"]["dissipated_J"].as_object();
    for (name, values) in channels.into_iter().flatten() {
        let of = |at: usize| list(values).get(at).map_or(String::new(), energy);
        table.rows.push(vec![name.replace('_', " "), of(0), of(1)]);
    }
    table
}

#[cfg(test)]
mod tests {
    use exchange::read::EnergyBudgets;

    use super::*;

    #[test]
    fn the_page_says_what_is_easily_overlooked() {
        let names = ["low", "high"].map(str::to_owned);
        let notes = ["the log of low is cut".to_owned()];
        let said = lead(&names, &notes);
        assert!(said.ends_with("A is low, B is high. Note: the log of low is cut."), "{said}");
    }

    #[test]
    fn results_at_the_stop_are_in_words_and_in_the_units_of_the_other_pages() {
        let stop = serde_json::json!({
            "stopping_time_s": { "values": [0.2, 0.25], "difference": 0.05, "relative": 0.25 },
            "range_m": { "values": [0.0, 0.5], "difference": 0.5, "relative": null },
        });
        let rows = stops(&stop).rows;
        let row = |name: &str| rows.iter().find(|row| row[0] == name).expect("a row")[1..].to_vec();
        assert_eq!(row("stopping time (ms)"), ["200.00", "250.00", "50.00", "+25.0 %"]);
        assert_eq!(row("range (mm)"), ["0.00", "500.00", "500.00", "\u{2013}"]);
    }

    #[test]
    fn energies_count_from_the_start_and_only_where_a_program_tells_them() {
        let terms = ["kinetic_grains_rotation_J", "potential_grains_J", "dissipated_sliding_J"];
        let energy = EnergyBudgets {
            terms: terms.map(str::to_owned).into(),
            time: vec![0.0, 0.5],
            values: vec![vec![0.0, 0.25], vec![4.0, 4.5], vec![0.0, 8.0]],
            closing: None,
        };
        let forces = crate::scene::Forces::default();
        let bodies = Vec::new();
        let course = Course { bodies, energy: Some(energy), forces, complete: true, body: None };
        let grains = of_energies(&course, ["kinetic_grains", "potential_grains"], 1.0);
        // Sums of powers of two: exact.
        assert_eq!(grains, [[(0.0, 0.0), (0.5, 0.75)]]);
        let intruder = of_energies(&course, ["kinetic_intruder", "potential_intruder"], -1.0);
        assert!(intruder.is_empty(), "{intruder:?}");
    }
}
