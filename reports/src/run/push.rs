//! An intruder that a drive pushes: the force along its way, and the work of the drive.

use plots::axes;
use plots::legend::{self, Sign};
use plots::{Hover, PictureError, colour, svg};
use plotters::prelude::*;
use runner::run::{IntrusionSummary, Summary};

use crate::numbers::{share, with_prefix};
use crate::page::Number;

/// Size of the panel without its legend (pixels).
const PANEL: (u32, u32) = (400, 280);

/// Share of the greatest force from which on a push has a force sideways.
const SIDEWAYS: f64 = 0.02;

/// What one wants to know first of `push`.
pub(super) fn headline(summary: &Summary, push: &IntrusionSummary) -> Vec<Number> {
    let stop = &summary.stop;
    let way = match stop.stopped {
        true => "as far as it is to go".to_owned(),
        false => format!("of the {} mm that it is to go", plots::short(1e3 * push.to_depth_m)),
    };
    let forces: Vec<(f64, f64)> = push.depth_m.iter().copied().zip(magnitudes(push)).collect();
    let greatest = forces.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
    let force = |name: &str, at: Option<(f64, f64)>| {
        at.map(|(depth, force)| {
            let place = format!("{} mm deep", plots::short(1e3 * depth));
            Number::new(name, with_prefix(force, "N"), place)
        })
    };
    let mut numbers = vec![Number::new("depth", format!("{:.2} mm", 1e3 * stop.depth_m), way)];
    numbers.extend(force("greatest force", greatest));
    numbers.extend(force("force at the end", forces.last().copied()));
    let supplied = summary.energy.shares().percent(push.work);
    let note = supplied.map_or(String::new(), |share| format!("{share:.1} % of what was supplied"));
    numbers.push(Number::new("work of the drive", with_prefix(push.work, "J"), note));
    let note = "largest energy unaccounted for, over that given to the bed";
    numbers.push(Number::new("closure", share(summary.energy.closure), note));
    numbers
}

/// Along the depth (N).
fn magnitudes(push: &IntrusionSummary) -> impl Iterator<Item = f64> {
    push.force_x.iter().zip(&push.force_z).map(|(x, z)| libm::hypot(*x, *z))
}

/// The force of the ground over the depth, with what it shows; `None` of a push without samples.
pub(super) fn picture(push: &IntrusionSummary) -> Result<Option<(String, String)>, PictureError> {
    let top = magnitudes(push).fold(0.0, f64::max);
    let Some(deepest) = push.depth_m.last().filter(|_| top > 0.0) else { return Ok(None) };
    let is_sideways = push.force_x.iter().any(|force| force.abs() > SIDEWAYS * top);
    let mut curves = vec![("upward", Sign::Line(colour(0)), &push.force_z)];
    if is_sideways {
        curves.push(("along the surface", Sign::Line(colour(1)), &push.force_x));
    }
    let rows: Vec<(Sign, String)> = match &curves[..] {
        [_] => Vec::new(),
        all => all.iter().map(|(name, sign, _)| (*sign, (*name).to_owned())).collect(),
    };
    let legend = if rows.is_empty() { 0 } else { legend::height(rows.len()) };
    let forces = || curves.iter().flat_map(|(.., forces)| forces.iter().copied());
    let (low, high) = (forces().fold(0.0, f64::min), forces().fold(0.0, f64::max));
    let pad = 0.06 * (high - low);
    let up = if low < 0.0 { low - pad } else { 0.0 }..high + pad;
    let picture = svg((PANEL.0, PANEL.1 + legend), |area| {
        let (above, below) = area.split_vertically(PANEL.1);
        let ranges = [0.0..1e3 * deepest, up];
        let mut chart = axes::chart(&above, ranges, 6, ["depth (mm)", "force (N)"])?;
        for (at, (name, _, forces)) in curves.iter().enumerate() {
            let points = || push.depth_m.iter().zip(*forces).map(|(z, force)| (1e3 * z, *force));
            chart.draw_series(LineSeries::new(points(), colour(at).stroke_width(2)))?;
            let text = |(depth, force): (f64, f64)| {
                format!("{depth:.2} mm deep\n{name}: {}", with_prefix(force, "N"))
            };
            chart.draw_series(points().map(|point| Hover::at(point, text(point))))?;
        }
        legend::draw(&below, &rows)
    })?;
    let caption = "Force of the ground on the body over its depth, without its weight: means over equal parts of the \
                   way.";
    Ok(Some((picture, caption.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_sideways_is_drawn_where_there_is_one() {
        let push = |force_x: f64| IntrusionSummary {
            to_depth_m: 0.02,
            work: 0.1,
            depth_m: vec![0.005, 0.015],
            force_x: vec![0.0, force_x],
            force_z: vec![2.0, 8.0],
            torque_y: vec![0.0; 2],
        };
        let drawn = |force_x| picture(&push(force_x)).expect("a picture").expect("forces").0;
        assert!(!drawn(0.0).contains("along the surface"), "{}", drawn(0.0));
        let both = drawn(-4.0);
        assert!(both.contains("along the surface: -4 N") && both.contains("upward: 8 N"), "{both}");
        let none = IntrusionSummary { depth_m: Vec::new(), force_z: Vec::new(), ..push(0.0) };
        assert!(picture(&none).expect("no fault").is_none());
    }
}
