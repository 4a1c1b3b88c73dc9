//! Errors on what was fitted to and on what was held out, model after model, above the noise.

use plots::axes::Frame;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, centred, fitting, letters, short, svg};
use plotters::prelude::*;

use crate::forward::observable::Observable;
use crate::misfit::errors::Errors;
use crate::where_it_fails::WhereItFails;

/// Size of a panel, and the least width of all (pixels).
const PANEL: (u32, u32) = (230, 250);
const WIDTH: u32 = 640;

/// What is fitted to, and what is held out.
const ROLES: [RGBColor; 2] = [plots::COLOURS[0], plots::COLOURS[1]];

/// What the errors of a panel are of: a title, what they are multiplied with, and which they are.
struct Kind {
    title: &'static str,
    scale: f64,
    observable: Option<Observable>,
}

impl Kind {
    fn of(&self, errors: &Errors) -> Option<f64> {
        let error = match self.observable {
            None => errors.relative,
            Some(kind) => errors.of(kind),
        };
        error.map(|error| self.scale * error)
    }
}

/// A panel: the errors of each model, those that were fitted to first, and the noise of each role.
struct Panel<'a> {
    title: &'static str,
    models: Vec<&'a str>,
    bars: Vec<[Option<f64>; 2]>,
    floors: [Option<f64>; 2],
}

/// One panel per kind of number.
pub(crate) fn errors(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let panels = panels(found);
    if panels.is_empty() {
        return Ok(None);
    }
    let rows = rows(found);
    let wide = PANEL.0 * panels.len() as u32;
    svg((wide.max(WIDTH), PANEL.1 + legend::height(rows.len())), |area| {
        let (charts, below) = area.split_vertically(PANEL.1);
        let (charts, _) = charts.split_horizontally(wide);
        for (panel, chart) in panels.iter().zip(charts.split_evenly((1, panels.len()))) {
            draw_panel(&chart, panel)?;
        }
        legend::draw(&below, &rows)
    })
    .map(Some)
}

fn panels<'a>(found: &'a WhereItFails<'_>) -> Vec<Panel<'a>> {
    let kind = |title, scale, observable| Kind { title, scale, observable };
    let kinds = [
        kind("depth over time (mm)", 1e3, Some(Observable::Depth)),
        kind("range over time (mm)", 1e3, Some(Observable::Range)),
        kind("force over depth (N)", 1.0, Some(Observable::Force)),
        kind("acceleration over time (m/s²)", 1.0, Some(Observable::Acceleration)),
        kind("velocity over time (m/s)", 1.0, Some(Observable::Velocity)),
        kind("spin over time (rad/s)", 1.0, Some(Observable::Spin)),
        kind("stopping time (ms)", 1e3, Some(Observable::StopTime)),
        kind("final depth (mm)", 1e3, Some(Observable::FinalDepth)),
        kind("final range (mm)", 1e3, Some(Observable::FinalRange)),
        kind("crater depth (mm)", 1e3, Some(Observable::CraterDepth)),
        kind("rim diameter (mm)", 1e3, Some(Observable::RimDiameter)),
        kind("scalars, relative (%)", 1e2, None),
    ];
    let floors = found.noise_floors();
    let panel = |kind: &Kind| Panel {
        title: kind.title,
        models: found.models.iter().map(|model| model.model.as_str()).collect(),
        bars: found
            .models
            .iter()
            .map(|model| [&model.fit, &model.holdout].map(|errors| kind.of(errors.as_ref()?)))
            .collect(),
        floors: floors.each_ref().map(|errors| kind.of(errors)),
    };
    let drawn = |panel: &Panel<'_>| panel.bars.iter().flatten().any(Option::is_some);
    kinds.iter().map(panel).filter(drawn).collect()
}

fn rows(found: &WhereItFails<'_>) -> Vec<(Sign, String)> {
    let mut rows =
        vec![(Sign::Square(ROLES[0]), "root mean square where it was fitted".to_owned())];
    if found.models.iter().any(|model| model.holdout.is_some()) {
        rows.push((Sign::Square(ROLES[1]), "where it was not: held-out conditions".to_owned()));
    }
    rows.push((Sign::Dashed(BLACK), "what the noise of the means alone would give".to_owned()));
    let names = found.models.iter().enumerate();
    rows.extend(
        names.map(|(at, model)| (Sign::Dot(WHITE), format!("{}: {}", at + 1, model.model))),
    );
    rows
}

fn draw_panel(area: &Area<'_>, panel: &Panel<'_>) -> Drawn {
    let title = fitting(panel.title, PANEL.0 - 50);
    area.draw(&Text::new(title, (48, 8), letters()))?;
    let heights = panel.bars.iter().flatten().chain(&panel.floors).flatten();
    let highest = heights.fold(0.0_f64, |highest, height| highest.max(*height)).max(1e-9);
    let n = panel.bars.len();
    let mut chart = Frame {
        ranges: [0.0..n as f64, 0.0..1.08 * highest],
        ticks: [0, 6],
        names: ["", ""],
        above: 30,
        below: 24,
        grid: true,
    }
    .draw(area)?;
    for (model, bars) in panel.bars.iter().enumerate() {
        let roles = bars.iter().zip(panel.floors).enumerate();
        for (role, (height, floor)) in roles {
            let Some(height) = height else { continue };
            let left = model as f64 + 0.12 + 0.38 * role as f64;
            let bar = [(left, 0.0), (left + 0.36, *height)];
            chart.draw_series([Rectangle::new(bar, ROLES[role].filled())])?;
            if let Some(floor) = floor {
                let line = [(left - 0.02, floor), (left + 0.38, floor)];
                chart.draw_series(DashedLineSeries::new(line, 5, 3, BLACK.stroke_width(2)))?;
            }
            let noise = floor.map_or(String::new(), |floor| format!(", noise {}", short(floor)));
            let text = format!(
                "{}, {}\n{}: {}{noise}",
                panel.models[model],
                ["fitted", "held out"][role],
                panel.title,
                short(*height)
            );
            chart.draw_series([Hover::over([bar[0], (bar[1].0, 1.08 * highest)], text)])?;
        }
    }
    let plot = chart.plotting_area();
    for model in 0..n {
        let (x, _) = plot.map_coordinate(&(model as f64 + 0.5, 0.0));
        let left = area.get_pixel_range().0.start;
        let place = (x - left, PANEL.1 as i32 - 14);
        area.draw(&Text::new((model + 1).to_string(), place, centred()))?;
    }
    Ok(())
}
