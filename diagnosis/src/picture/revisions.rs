//! The error of revision after revision, as stairs that go down to the noise.

use measurements::Kind;
use plots::axes::Frame;
use plots::legend::{self, Sign};
use plots::{Area, COLOURS, Drawn, Hover, PictureError, centred, fitting, short, svg};
use plotters::prelude::*;

use crate::misfit::error_unit::Unit;
use crate::misfit::errors::Errors;
use crate::where_it_fails::WhereItFails;

/// Height (pixels), least width, and least width of a step.
const HEIGHT: u32 = 300;
const WIDTH: u32 = 640;
const STEP: u32 = 150;

/// What stands at the left of the steps (pixels).
const LEFT: u32 = 64;

/// Where the model was fitted, and where it was not.
const ROLES: [(RGBColor, &str); 2] =
    [(COLOURS[0], "where it was fitted"), (COLOURS[1], "where it was not: held-out conditions")];

/// The errors of all revisions, and what noise alone would give, by role.
struct Stairs {
    axis: &'static str,
    names: Vec<String>,
    errors: [Vec<Option<f64>>; 2],
    floors: [Option<f64>; 2],
}

/// Of positions where there are paths, else relative; `None` for a model alone.
pub(crate) fn revisions(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    if found.models.len() < 2 {
        return Ok(None);
    }
    let stairs = Stairs::of(found);
    if stairs.errors.iter().flatten().all(Option::is_none) {
        return Ok(None);
    }
    let rows = stairs.rows();
    let step = ((WIDTH - LEFT) / stairs.names.len() as u32).max(STEP);
    let wide = LEFT + step * stairs.names.len() as u32;
    svg((wide, HEIGHT + legend::height(rows.len())), |area| {
        let (chart, below) = area.split_vertically(HEIGHT);
        stairs.draw(&chart, step)?;
        legend::draw(&below, &rows)
    })
    .map(Some)
}

impl Stairs {
    fn of(found: &WhereItFails<'_>) -> Self {
        let (axis, scale) = match found.set.kind {
            Kind::Trajectory => ("positions (mm)", 1e3),
            Kind::Scalar => ("scalars, relative (%)", 1e2),
            Kind::ForceDepth => ("forces (N)", 1.0),
            Kind::Acceleration => ("accelerations (m/s²)", 1.0),
            Kind::Velocity => ("velocities (m/s)", 1.0),
            Kind::Spin => ("spins (rad/s)", 1.0),
        };
        let unit = Unit::of(found.set.kind);
        let pick = |errors: &Errors| unit.pick(errors).map(|error| scale * error);
        let models = &found.models;
        Self {
            axis,
            names: models.iter().map(|model| model.model.clone()).collect(),
            errors: [
                models.iter().map(|model| pick(model.fit.as_ref()?)).collect(),
                models.iter().map(|model| pick(model.holdout.as_ref()?)).collect(),
            ],
            floors: found.noise_floors().each_ref().map(pick),
        }
    }

    fn rows(&self) -> Vec<(Sign, String)> {
        let roles = ROLES.iter().zip(&self.errors);
        let shown = roles.filter(|(_, errors)| errors.iter().any(Option::is_some));
        let mut rows: Vec<(Sign, String)> = shown
            .map(|((colour, what), _)| {
                (Sign::Line(*colour), format!("root mean square error {what}"))
            })
            .collect();
        rows.push((Sign::Dashed(BLACK), "what the noise of the means alone would give".to_owned()));
        rows
    }

    fn draw(&self, area: &Area<'_>, step: u32) -> Drawn {
        let n = self.names.len();
        let all = self.errors.iter().flatten().chain(&self.floors).flatten();
        let highest = all.fold(1e-9_f64, |highest, error| highest.max(*error));
        let mut chart = Frame {
            ranges: [0.0..n as f64, 0.0..1.12 * highest],
            ticks: [0, 6],
            names: ["", self.axis],
            above: 8,
            below: 34,
            grid: true,
        }
        .draw(area)?;
        for (role, errors) in self.errors.iter().enumerate() {
            let (colour, what) = ROLES[role];
            let steps = errors.iter().enumerate().filter_map(|(at, error)| Some((at, (*error)?)));
            let line = steps.clone().flat_map(|(at, e)| [(at as f64, e), (at as f64 + 1.0, e)]);
            chart.draw_series(LineSeries::new(line, colour.stroke_width(3)))?;
            if let (Some(floor), Some(_)) = (self.floors[role], steps.clone().next()) {
                let line = [(0.0, floor), (n as f64, floor)];
                chart.draw_series(DashedLineSeries::new(line, 5, 4, colour.stroke_width(1)))?;
            }
            for (at, error) in steps {
                let place = (at as f64 + 0.5, error);
                chart.draw_series([Circle::new(place, 4, colour.filled())])?;
                let floor = self.floors[role]
                    .map_or(String::new(), |floor| format!("\nnoise: {}", short(floor)));
                let name = &self.names[at];
                let text = format!("{name}\n{what}\n{}: {}{floor}", self.axis, short(error));
                chart.draw_series([Hover::at(place, text)])?;
            }
        }
        let plot = chart.plotting_area();
        let left = area.get_pixel_range().0.start;
        for (at, name) in self.names.iter().enumerate() {
            let (x, _) = plot.map_coordinate(&(at as f64 + 0.5, 0.0));
            let name = fitting(name, step - 8);
            area.draw(&Text::new(name, (x - left, HEIGHT as i32 - 18), centred()))?;
        }
        Ok(())
    }
}
