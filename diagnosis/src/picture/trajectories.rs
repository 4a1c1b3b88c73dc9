//! Paths and velocities, or forces and their slopes, as measured, under what each model predicts.

use measurements::Axis;
use plots::axes::Frame;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, GREY, Hover, PictureError, colour, fitting, letters, padded, svg};
use plotters::prelude::*;

use super::multiples::{Track, tracks};
use crate::forward::NORMAL_95;
use crate::where_it_fails::WhereItFails;

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (420, 230);

/// Most tracks.
const TRACKS: usize = 6;

/// A number over time or depth.
type Line = Vec<(f64, f64)>;

/// A track as it is drawn: its numbers on the left, their changes along the way on the right.
struct Row {
    title: String,
    /// Of the way, the numbers and the changes.
    axes: [Axis; 3],
    /// Place, and least and greatest number that noise allows, as drawn.
    band: Vec<(f64, f64, f64)>,
    measured: [Line; 2],
    predicted: Vec<[Line; 2]>,
}

/// Of the tracks that the first model misses most; `None` without trajectories.
///
/// Velocities are differences between successive readings, of the predictions too, so that both are
/// smoothed alike.
pub(crate) fn trajectories(found: &WhereItFails<'_>) -> Result<Option<String>, PictureError> {
    let Some(first) = found.models.first() else { return Ok(None) };
    let mut worst = tracks(&first.residuals);
    worst.retain(|track| track.places.len() > 1);
    if worst.is_empty() {
        return Ok(None);
    }
    worst.sort_by(|a, b| b.misfit(&first.residuals).total_cmp(&a.misfit(&first.residuals)));
    let all = worst.len();
    worst.truncate(TRACKS);
    let rows: Vec<Row> = worst.iter().map(|track| Row::of(track, found)).collect();
    let signs = signs(found, rows.len(), all);
    let height = PANEL.1 * rows.len() as u32;
    svg((2 * PANEL.0, height + legend::height(signs.len())), |area| {
        let (charts, below) = area.split_vertically(height);
        let charts = charts.split_evenly((rows.len(), 2));
        for (row, charts) in rows.iter().zip(charts.chunks(2)) {
            for (side, chart) in charts.iter().enumerate() {
                row.draw(chart, side)?;
            }
        }
        legend::draw(&below, &signs)
    })
    .map(Some)
}

fn signs(found: &WhereItFails<'_>, shown: usize, all: usize) -> Vec<(Sign, String)> {
    let mut signs = vec![
        (Sign::Dot(BLACK), format!("mean of the runs; {shown} of {all} tracks, worst first")),
        (Sign::Band, "95 % of means of so many runs around it".to_owned()),
    ];
    let models = found.models.iter().enumerate();
    signs.extend(models.map(|(at, model)| (Sign::Line(colour(at)), model.model.clone())));
    signs
}

impl Row {
    fn of(track: &Track, found: &WhereItFails<'_>) -> Self {
        let measured = &found.models[0].residuals;
        let path = track.along(measured, |_, one| one.measured);
        let errors = track.band(measured);
        let axes @ [across, up, change] = track.axes();
        let band = path.iter().zip(errors).map(|(&(t, y), (_, se))| {
            let half = NORMAL_95 * se;
            (across.scale * t, up.scale * (y - half), up.scale * (y + half))
        });
        let drawn = |line: Line, up: Axis| -> Line {
            line.into_iter().map(|(t, y)| (across.scale * t, up.scale * y)).collect()
        };
        let both = |path: Line| {
            let slopes = slopes(&path);
            [drawn(path, up), drawn(slopes, change)]
        };
        let models = found.models.iter();
        Self {
            title: track.title(found),
            axes,
            band: band.collect(),
            predicted: models
                .map(|model| both(track.along(&model.residuals, |_, one| one.predicted)))
                .collect(),
            measured: both(path),
        }
    }

    /// The numbers (0) or their changes (1).
    fn draw(&self, area: &Area<'_>, side: usize) -> Drawn {
        let [across, up] = [self.axes[0], self.axes[1 + side]];
        let unit = up.unit;
        let title = fitting(&self.title, PANEL.0 - 60);
        area.draw(&Text::new(title, (54, 5), letters()))?;
        let lines = self.predicted.iter().map(|both| &both[side]);
        let numbers = || lines.clone().chain([&self.measured[side]]).flatten();
        let ends = |of: fn(&(f64, f64)) -> f64| {
            let values = numbers().map(of);
            (values.clone().fold(0.0, f64::min), values.fold(0.0, f64::max))
        };
        let ((first, last), (low, high)) = (ends(|place| place.0), ends(|place| place.1));
        let mut chart = Frame {
            ranges: [padded(first, last), padded(low, high)],
            ticks: [6, 5],
            names: [&across.label(), &up.label()],
            above: 24,
            below: 0,
            grid: false,
        }
        .draw(area)?;
        if side == 0 {
            let lower = self.band.iter().map(|&(t, low, _)| (t, low));
            let upper = self.band.iter().rev().map(|&(t, _, high)| (t, high));
            let outline: Line = lower.chain(upper).collect();
            chart.draw_series([Polygon::new(outline, GREY.filled())])?;
        }
        for (at, both) in self.predicted.iter().enumerate() {
            let line = both[side].iter().copied();
            chart.draw_series(LineSeries::new(line, colour(at).stroke_width(2)))?;
        }
        let measured = self.measured[side].iter();
        chart.draw_series(measured.clone().map(|&at| Circle::new(at, 2, BLACK.filled())))?;
        chart.draw_series(measured.enumerate().map(|(place, &(t, y))| {
            let mut text =
                format!("{}\n{t:.1} {}: measured {y:.3} {unit}", self.title, across.unit);
            for both in &self.predicted {
                if let Some((_, predicted)) = both[side].get(place) {
                    text.push_str(&format!("\npredicted {predicted:.3} {unit}"));
                }
            }
            Hover::at((t, y), text)
        }))?;
        Ok(())
    }
}

/// Change along the way, halfway between the places of a path.
fn slopes(path: &[(f64, f64)]) -> Line {
    let pairs = path.windows(2).filter(|pair| pair[1].0 > pair[0].0);
    pairs
        .map(|pair| {
            let [(t0, y0), (t1, y1)] = [pair[0], pair[1]];
            (0.5 * (t0 + t1), (y1 - y0) / (t1 - t0))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fall_at_one_metre_per_second_has_that_velocity_between_its_readings() {
        let path = [(0.0, 0.0), (0.01, 0.01), (0.01, 0.01), (0.03, 0.03)];
        let velocities = slopes(&path);
        let times: Vec<f64> = velocities.iter().map(|(t, _)| *t).collect();
        // Halfway, and no reading that stands twice makes an infinite velocity.
        assert!((times[0] - 0.005).abs() < 1e-15 && (times[1] - 0.02).abs() < 1e-15);
        assert_eq!(times.len(), 2);
        assert!(velocities.iter().all(|(_, v)| (v - 1.0).abs() < 1e-12), "rounding of a division");
    }
}
