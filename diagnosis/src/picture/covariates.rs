//! Force errors over each covariate, with their trends.

use plots::axes;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, padded, short, svg};
use plotters::prelude::*;

use crate::forward::NORMAL_95;
use crate::misfit::covariate::{self, Covariate};
use crate::misfit::force_error::{ForceError, Trend};
use crate::where_it_fails::WhereItFails;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (330, 260);

const COLUMNS: usize = 3;

/// Errors and trend of one model.
struct Series<'a> {
    model: &'a str,
    errors: Vec<&'a ForceError>,
    trend: Option<&'a Trend>,
}

/// One panel per covariate that was varied; `None` if none was.
pub(crate) fn covariates(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let mut names: Vec<&'static str> = Vec::new();
    for group in found.models.iter().flat_map(|model| &model.force_errors.groups) {
        if !names.contains(&group.error.over) {
            names.push(group.error.over);
        }
    }
    if names.is_empty() {
        return Ok(None);
    }
    let rows = rows(found);
    let columns = names.len().clamp(2, COLUMNS);
    let height = PANEL.1 * names.len().div_ceil(columns) as u32;
    let size = (PANEL.0 * columns as u32, height + legend::height(rows.len()));
    svg(size, |area| {
        let (charts, below) = area.split_vertically(height);
        let charts = charts.split_evenly((names.len().div_ceil(columns), columns));
        for (name, chart) in names.iter().zip(&charts) {
            if let Some(covariate) = covariate::named(name) {
                draw_panel(chart, covariate, &series(found, name))?;
            }
        }
        legend::draw(&below, &rows)
    })
    .map(Some)
}

fn rows(found: &WhereItFails<'_>) -> Vec<(Sign, String)> {
    let models = found.models.iter().enumerate();
    // A model whose errors are of no covariate has no points.
    let shown = models.filter(|(_, model)| !model.force_errors.groups.is_empty());
    let mut rows: Vec<_> =
        shown.map(|(at, model)| (Sign::Dot(colour(at)), model.model.clone())).collect();
    rows.push((
        Sign::Line(BLACK),
        "trend, significant at a false-discovery rate of 5 %; bars: 95 %, across: values taken together"
            .to_owned(),
    ));
    rows.push((Sign::Dashed(BLACK), "trend that chance explains".to_owned()));
    rows
}

fn series<'a>(found: &'a WhereItFails<'_>, name: &str) -> Vec<Series<'a>> {
    let of = |model: &'a crate::where_it_fails::Failing| {
        let errors = &model.force_errors;
        let groups = errors.groups.iter().map(|group| &group.error);
        Series {
            model: &model.model,
            errors: groups.filter(|error| error.over == name).collect(),
            trend: errors.trends.iter().find(|trend| trend.over == name),
        }
    };
    found.models.iter().map(of).collect()
}

fn draw_panel(area: &Area<'_>, covariate: Covariate, all: &[Series<'_>]) -> Drawn {
    let errors = || all.iter().flat_map(|series| &series.errors);
    let low = errors().fold(f64::INFINITY, |low, error| low.min(error.from));
    let high = errors().fold(f64::NEG_INFINITY, |high, error| high.max(error.to));
    let highest = errors().fold(0.0_f64, |highest, error| {
        highest.max(error.force_error.abs() + NORMAL_95 * error.se)
    });
    let across = padded(low, high);
    let shift = (across.end - across.start) / 60.0;
    let Covariate { heading, unit, .. } = covariate;
    let heading = if unit == "1" { heading.to_owned() } else { format!("{heading} ({unit})") };
    let over = [across, padded(-100.0 * highest, 100.0 * highest)];
    let mut chart = axes::chart(area, over, 6, [&heading, "force error (%)"])?;
    chart.draw_series([PathElement::new([(low, 0.0), (high, 0.0)], BLACK.stroke_width(1))])?;
    for (at, series) in all.iter().enumerate() {
        let colour = colour(at);
        // Side by side where models have their errors at the same value.
        let beside = shift * (at as f64 - 0.5 * (all.len() - 1) as f64);
        for error in &series.errors {
            let middle = 0.5 * (error.from + error.to) + beside;
            let (y, half) = (100.0 * error.force_error, 100.0 * NORMAL_95 * error.se);
            let bars = [
                vec![(middle, y - half), (middle, y + half)],
                vec![(error.from, y), (error.to, y)],
            ];
            chart.draw_series(bars.map(|bar| PathElement::new(bar, colour.stroke_width(1))))?;
            chart.draw_series([Circle::new((middle, y), 4, colour.filled())])?;
            let (from, to) = (short(error.from), short(error.to));
            let values = if from == to { from } else { format!("{from} to {to}") };
            let se = 100.0 * error.se;
            let text = format!(
                "{}\n{heading}: {values}\nforce error {y:+.1} \u{b1} {se:.1} %",
                series.model
            );
            chart.draw_series([Hover::at((middle, y), text)])?;
        }
        let Some(trend) = series.trend else { continue };
        let line = [low, high].map(|value| {
            (value, 100.0 * (trend.force_error + trend.slope * (value - trend.centre)))
        });
        if trend.significant {
            chart.draw_series([PathElement::new(line, colour.stroke_width(2))])?;
        } else {
            chart.draw_series(DashedLineSeries::new(line, 5, 4, colour.stroke_width(1)))?;
        }
    }
    Ok(())
}
