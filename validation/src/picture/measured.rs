//! A measurement set as it was understood, before anything is fitted to it.

use measurements::{Condition, Kind, MeasurementSet, Run};
use plotters::prelude::*;

use plots::legend::{self, Sign};
use plots::{Area, Drawn, GREY, Hover, PictureError, colour, fitting, letters, padded, short, svg};

/// Size of a panel (pixels), and panels side by side.
const PANEL: (u32, u32) = (313, 220);
const COLUMNS: usize = 3;

/// Most conditions with a panel of their own.
const CONDITIONS: usize = 24;

/// Share of its time in which the speed of a run is near that of the impact.
const EARLY: f64 = 0.3;

/// What is drawn of sets without paths: a title, a factor, and the number of a run.
type Scalar = (&'static str, f64, fn(&Run) -> Option<f64>);

const SCALARS: [Scalar; 3] = [
    ("stopping time (ms)", 1e3, |run| run.stop_time),
    ("final depth (mm)", 1e3, |run| run.final_z),
    ("final range (mm)", 1e3, |run| run.final_x),
];

/// Depth over time of every run beside the stated impact speed, a panel per condition; of a set of
/// scalars, every number over the speed.
///
/// # Errors
/// If the drawing fails.
pub fn measured(set: &MeasurementSet) -> Result<String, PictureError> {
    match set.kind {
        Kind::Trajectory => paths(set),
        Kind::Scalar => scalars(set),
    }
}

fn paths(set: &MeasurementSet) -> Result<String, PictureError> {
    let n = set.conditions.len().min(CONDITIONS);
    let rows = n.div_ceil(COLUMNS).max(1);
    let all = set.conditions.len();
    let signs = [
        (Sign::Line(colour(0)), format!("depth, a line per run; {n} of {all} conditions")),
        (Sign::Dashed(colour(1)), "a fall at the stated speed: runs start along it".to_owned()),
    ];
    let height = PANEL.1 * rows as u32;
    svg((PANEL.0 * COLUMNS as u32, height + legend::height(signs.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        let panels = charts.split_evenly((rows, COLUMNS));
        for (at, (condition, panel)) in set.conditions.iter().zip(&panels).take(n).enumerate() {
            let own: Vec<&Run> = set.runs.iter().filter(|run| run.condition == at).collect();
            draw_paths(panel, condition, &own)?;
        }
        legend::draw(&below, &signs)
    })
}

fn draw_paths(area: &Area<'_>, condition: &Condition, runs: &[&Run]) -> Drawn {
    let Condition { id, speed, angle_deg, .. } = condition;
    let title = format!("{id}: {speed} m/s, {angle_deg}\u{b0}, {} runs", runs.len());
    area.draw(&Text::new(fitting(&title, PANEL.0 - 60), (52, 5), letters()))?;
    let frames = || runs.iter().flat_map(|run| &run.frames);
    let times = frames().map(|frame| 1e3 * frame.t);
    let (first, last) = (times.clone().fold(0.0, f64::min), times.fold(1e-3, f64::max));
    let depths = frames().map(|frame| 1e3 * frame.z);
    let (high, low) = (depths.clone().fold(0.0, f64::min), depths.fold(1e-3, f64::max));
    let down = padded(high, low);
    let mut chart = ChartBuilder::on(area)
        .margin_top(24)
        .margin_left(6)
        .margin_right(10)
        .x_label_area_size(34)
        .y_label_area_size(46)
        .build_cartesian_2d(padded(first, last), down.end..down.start)?;
    chart
        .configure_mesh()
        .x_labels(5)
        .y_labels(5)
        .x_desc("time (ms)")
        .y_desc("depth (mm)")
        .light_line_style(WHITE)
        .bold_line_style(GREY)
        .draw()?;
    let sinking = speed * libm::sin(angle_deg.to_radians());
    let fall = [first, EARLY * last].map(|t| (t, sinking * t));
    chart.draw_series(DashedLineSeries::new(fall, 5, 4, colour(1).stroke_width(2)))?;
    for run in runs {
        let line = run.frames.iter().map(|frame| (1e3 * frame.t, 1e3 * frame.z));
        chart.draw_series(LineSeries::new(line.clone(), colour(0).stroke_width(1)))?;
        chart.draw_series(
            line.map(|(t, z)| {
                Hover::at((t, z), format!("{}\n{t:.1} ms: {z:.2} mm deep", run.name))
            }),
        )?;
    }
    Ok(())
}

fn scalars(set: &MeasurementSet) -> Result<String, PictureError> {
    let has = |(.., of): &&Scalar| set.runs.iter().any(|run| of(run).is_some());
    let shown: Vec<&Scalar> = SCALARS.iter().filter(has).collect();
    let mut angles: Vec<f64> = set.conditions.iter().map(|one| one.angle_deg).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let signs: Vec<(Sign, String)> = angles
        .iter()
        .enumerate()
        .map(|(at, angle)| (Sign::Dot(colour(at)), format!("{angle}\u{b0}, every run")))
        .collect();
    svg((PANEL.0 * COLUMNS as u32, PANEL.1 + legend::height(signs.len())), |area| {
        let (charts, below) = area.split_vertically(PANEL.1);
        for (scalar, panel) in shown.iter().zip(charts.split_evenly((1, COLUMNS))) {
            draw_scalar(&panel, scalar, set, &angles)?;
        }
        legend::draw(&below, &signs)
    })
}

fn draw_scalar(
    area: &Area<'_>,
    &(title, scale, of): &Scalar,
    set: &MeasurementSet,
    angles: &[f64],
) -> Drawn {
    area.draw(&Text::new(title, (52, 5), letters()))?;
    let fastest = set.conditions.iter().fold(1e-9_f64, |most, one| most.max(one.speed));
    let most = set.runs.iter().filter_map(of).fold(1e-12_f64, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin_top(24)
        .margin_left(6)
        .margin_right(10)
        .x_label_area_size(34)
        .y_label_area_size(46)
        .build_cartesian_2d(0.0..1.05 * fastest, 0.0..1.1 * scale * most)?;
    chart
        .configure_mesh()
        .x_labels(5)
        .y_labels(5)
        .x_desc("impact speed (m/s)")
        .light_line_style(WHITE)
        .bold_line_style(GREY)
        .draw()?;
    for run in &set.runs {
        let Some(value) = of(run) else { continue };
        let condition = &set.conditions[run.condition];
        let of_angle = angles.iter().position(|angle| *angle >= condition.angle_deg);
        let place = (condition.speed, scale * value);
        chart.draw_series([Circle::new(place, 3, colour(of_angle.unwrap_or(0)).filled())])?;
        let text = format!("{}: {}\n{title}: {}", run.name, condition.id, short(scale * value));
        chart.draw_series([Hover::at(place, text)])?;
    }
    Ok(())
}
