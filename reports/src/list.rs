//! The report of a list of runs: how depth and stopping time go with speed and angle.

use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, short, svg};
use plotters::prelude::*;
use runner::run::{Group, ListSummary, Scatter};

use crate::ReportError;
use crate::figure::panel;
use crate::numbers::share;
use crate::page::{Number, Page, Part, Section};
use crate::run::origin;
use crate::tables::Table;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (400, 280);

/// Most runs that are listed one by one.
const MOST_RUNS: usize = 500;

/// What a panel shows of a group.
struct Quantity {
    title: &'static str,
    scale: f64,
    of: fn(&Group) -> Scatter,
}

const QUANTITIES: [Quantity; 2] = [
    Quantity { title: "depth (mm)", scale: 1e3, of: |group| group.depth_m },
    Quantity { title: "stopping time (ms)", scale: 1e3, of: |group| group.stopping_time_s },
];

pub(crate) fn page(summary: &ListSummary) -> Result<String, ReportError> {
    let stopped = summary.runs.iter().filter(|run| run.stop.stopped).count();
    let closure = summary.runs.iter().filter_map(|run| run.energy.closure).fold(0.0, f64::max);
    let n = summary.runs.len();
    let page = Page {
        title: summary.name.clone(),
        kind: "list of runs",
        lead: format!("{n} impacts under {} conditions.", summary.groups.len()),
        headline: vec![
            Number::new("impacts", n.to_string(), ""),
            Number::new("stopped", stopped.to_string(), ""),
            Number::new("closure", format!("{closure:.1e}"), "the worst of all"),
        ],
        sections: [
            Section::new(
                "Conditions",
                vec![Part::Panels(pictures(&summary.groups)?), Part::Table(groups(summary))],
            ),
            Section::new("Runs", runs(summary)),
        ]
        .into_iter()
        .flatten()
        .collect(),
        origin: origin(&summary.version, &summary.model_hash),
    };
    page.html()
}

fn groups(summary: &ListSummary) -> Table {
    let head =
        ["speed (m/s)", "angle (deg)", "n", "depth (mm)", "range (mm)", "stopping time (ms)"];
    let mut table = Table::new(&head);
    for group in &summary.groups {
        let shown = |scatter: Scatter| in_words(scatter, 1e3);
        table.rows.push(vec![
            group.speed_m_per_s.to_string(),
            group.angle_deg.to_string(),
            group.n.to_string(),
            shown(group.depth_m),
            shown(group.range_m),
            shown(group.stopping_time_s),
        ]);
    }
    table
}

fn runs(summary: &ListSummary) -> Vec<Part> {
    let head =
        ["folder", "speed (m/s)", "angle (deg)", "depth (mm)", "stopping time (ms)", "closure"];
    let mut table = Table::new(&head);
    for (at, run) in summary.runs.iter().take(MOST_RUNS).enumerate() {
        let time = run.stop.stopping_time_s.map(|time| 1e3 * time);
        table.rows.push(vec![
            format!("{:03}", at + 1),
            run.impact.speed_m_per_s.to_string(),
            run.impact.angle_deg.to_string(),
            format!("{:.2}", 1e3 * run.stop.depth_m),
            crate::numbers::fixed(time, 2),
            share(run.energy.closure),
        ]);
    }
    let mut parts = vec![Part::Table(table)];
    if summary.runs.len() > MOST_RUNS {
        parts.push(Part::Text(format!("The first {MOST_RUNS}; all are in summary.json.")));
    }
    parts
}

fn in_words(scatter: Scatter, scale: f64) -> String {
    match (scatter.mean, scatter.sd) {
        (Some(mean), Some(sd)) => format!("{:.2} \u{b1} {:.2}", scale * mean, scale * sd),
        (Some(mean), None) => format!("{:.2}", scale * mean),
        (None, _) => "not reached".to_owned(),
    }
}

/// What the groups are drawn over, and what tells their lines apart.
struct Axes {
    title: &'static str,
    across: fn(&Group) -> f64,
    line: fn(&Group) -> f64,
    unit_of_line: &'static str,
}

/// Over the speed; over the angle where there is one speed.
fn axes(groups: &[Group]) -> Axes {
    let first = groups.first().map(|group| group.speed_m_per_s.to_bits());
    let one_speed = groups.iter().all(|group| Some(group.speed_m_per_s.to_bits()) == first);
    match one_speed {
        true => Axes {
            title: "angle (deg)",
            across: |group| group.angle_deg,
            line: |group| group.speed_m_per_s,
            unit_of_line: " m/s",
        },
        false => Axes {
            title: "impact speed (m/s)",
            across: |group| group.speed_m_per_s,
            line: |group| group.angle_deg,
            unit_of_line: "\u{b0}",
        },
    }
}

/// Each quantity, with what it shows.
fn pictures(groups: &[Group]) -> Result<Vec<(String, String)>, PictureError> {
    let axes = axes(groups);
    let mut lines: Vec<f64> = groups.iter().map(axes.line).collect();
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    let signs: Vec<(Sign, String)> = lines
        .iter()
        .enumerate()
        .map(|(at, value)| (Sign::Dot(colour(at)), format!("{value}{}", axes.unit_of_line)))
        .collect();
    let picture = |quantity: &Quantity| {
        let picture = svg((PANEL.0, PANEL.1 + legend::height(signs.len())), |area| {
            let (chart, below) = area.split_vertically(PANEL.1);
            quantity.draw(&chart, groups, &axes, &lines)?;
            legend::draw(&below, &signs)
        })?;
        let (name, _) = quantity.title.split_once(" (").unwrap_or((quantity.title, ""));
        let caption = format!(
            "Mean {name} over the positions of each speed and angle, with the standard deviation between them."
        );
        Ok(panel(&picture, &caption))
    };
    QUANTITIES.iter().map(picture).collect()
}

impl Quantity {
    fn draw(&self, area: &Area<'_>, groups: &[Group], axes: &Axes, lines: &[f64]) -> Drawn {
        let value = |group: &Group| {
            let scatter = (self.of)(group);
            Some((self.scale * scatter.mean?, self.scale * scatter.sd.unwrap_or(0.0)))
        };
        let right = groups.iter().map(axes.across).fold(1e-9, f64::max);
        let top =
            groups.iter().filter_map(value).fold(1e-9, |top: f64, (mean, sd)| top.max(mean + sd));
        let over = [0.0..1.05 * right, 0.0..1.1 * top];
        let mut chart = plots::axes::chart(area, over, 6, [axes.title, self.title])?;
        for (at, line) in lines.iter().enumerate() {
            let own = groups.iter().filter(|group| (axes.line)(group).to_bits() == line.to_bits());
            let mut points: Vec<(f64, f64, f64, usize)> = own
                .filter_map(|group| {
                    let (mean, sd) = value(group)?;
                    Some(((axes.across)(group), mean, sd, group.n))
                })
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let style = colour(at).stroke_width(2);
            chart.draw_series(LineSeries::new(points.iter().map(|p| (p.0, p.1)), style))?;
            for (x, mean, sd, n) in points {
                let bar = [(x, mean - sd), (x, mean + sd)];
                chart.draw_series([PathElement::new(bar, colour(at).stroke_width(1))])?;
                chart.draw_series([Circle::new((x, mean), 4, colour(at).filled())])?;
                let text = format!(
                    "{}: {x}\n{line}{}\n{}: {} \u{b1} {}, {n} runs",
                    axes.title,
                    axes.unit_of_line,
                    self.title,
                    short(mean),
                    short(sd)
                );
                chart.draw_series([Hover::at((x, mean), text)])?;
            }
        }
        Ok(())
    }
}
