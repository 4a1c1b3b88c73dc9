//! Depth, velocity, force and acceleration over time.

use plots::axes;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, svg};
use plotters::prelude::*;

use super::Course;
use super::thin::places;
use exchange::read::{BodyState, BodyStates};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (400, 280);

/// Columns that say their values.
const COLUMNS: usize = 120;

/// A curve of one body.
struct Curve {
    name: String,
    sign: Sign,
    /// Dashed, along the horizontal motion.
    along: bool,
    points: Vec<(f64, f64)>,
}

/// A panel: a figure of its own.
struct Panel {
    axis: &'static str,
    unit: &'static str,
    curves: Vec<Curve>,
    /// Time (ms), least and greatest, of what a curve is the mean of.
    band: Vec<[f64; 3]>,
    /// Which way the axis runs.
    downward: bool,
    /// Whether there is nothing to see of numbers that are all zero.
    leaves_out_zero: bool,
}

/// Figures of `course` over time, each with what it shows: depth, velocity, force and acceleration. `stop` is
/// the stopping time (s), if there is one.
pub(super) fn pictures(
    course: &Course,
    stop: Option<f64>,
) -> Result<Vec<(String, String)>, PictureError> {
    let moves_along = course.bodies.iter().any(moves_along);
    let stop = stop.map(|stop| 1e3 * stop);
    let force = force(course, moves_along);
    let grey = !force.band.is_empty();
    let panels = [
        (position(course, moves_along), if moves_along { DEPTH_AND_WAY } else { DEPTH }),
        (velocity(course, moves_along), VELOCITY),
        (force, if grey { FORCE_AND_RANGE } else { FORCE }),
        (acceleration(course, moves_along), ACCELERATION),
    ];
    let there = panels.into_iter().filter(|(panel, _)| panel.shows_something());
    there
        .map(|(panel, caption)| {
            let line = if panel.downward && stop.is_some() { STOP } else { "" };
            Ok((panel.picture(stop)?, format!("{caption}{line}")))
        })
        .collect()
}

const DEPTH: &str = "Depth of the lowest point of the body below the undisturbed surface.";
const DEPTH_AND_WAY: &str = "Depth of the lowest point of the body below the undisturbed surface, and the way of its \
                             centre of mass along it.";
const STOP: &str = " The vertical dashed line is the stopping time.";
const VELOCITY: &str = "Velocity of the centre of mass, downward positive.";
const FORCE: &str =
    "Force of the ground on the body, without its weight: the mean over short spans of time.";
const FORCE_AND_RANGE: &str = "Force of the ground on the body, without its weight: the mean over short spans of time \
                               and, in grey, the least and the greatest magnitude within them.";
const ACCELERATION: &str = "Acceleration of the centre of mass between two samples, upward positive: what the body is \
                            braked by, in it the weight.";

fn position(course: &Course, moves_along: bool) -> Panel {
    let curves = curves(course, moves_along, ["downward", "along the surface"], |body, along| {
        let start = body.states.first().map_or(0.0, |first| first.position.x);
        let place = |state: &BodyState| if along { state.position.x - start } else { state.depth };
        body.states.iter().map(|state| (state.time, 1e3 * place(state))).collect()
    });
    let axis = if moves_along { "position (mm)" } else { "depth (mm)" };
    let band = Vec::new();
    Panel { axis, unit: "mm", curves, band, downward: true, leaves_out_zero: false }
}

fn velocity(course: &Course, moves_along: bool) -> Panel {
    let curves = curves(course, moves_along, ["downward", "along the surface"], |body, along| {
        let of = |state: &BodyState| if along { state.velocity.x } else { -state.velocity.z };
        body.states.iter().map(|state| (state.time, of(state))).collect()
    });
    let (axis, band) = ("velocity (m/s)", Vec::new());
    Panel { axis, unit: "m/s", curves, band, downward: false, leaves_out_zero: false }
}

fn force(course: &Course, moves_along: bool) -> Panel {
    let forces = &course.forces;
    let curves = curves(course, moves_along, ["upward", "along the surface"], |body, along| {
        let times = forces.time.iter();
        times
            .filter_map(|time| {
                let [x, _, z] = forces.on(&body.name, *time)?;
                Some((*time, if along { x } else { z }))
            })
            .collect()
    });
    // The magnitude is that of the curve where there is one, and it points up.
    let single = !moves_along && forces.ranges.len() == 1;
    let ranges = forces.ranges.iter().flatten().filter(|_| single);
    let band = forces.time.iter().zip(ranges).map(|(time, [low, high])| [1e3 * time, *low, *high]);
    let (axis, band) = ("force (N)", band.collect());
    Panel { axis, unit: "N", curves, band, downward: false, leaves_out_zero: false }
}

fn acceleration(course: &Course, moves_along: bool) -> Panel {
    let curves = curves(course, moves_along, ["upward", "along the surface"], |body, along| {
        let of = |state: &BodyState| if along { state.velocity.x } else { state.velocity.z };
        let between = |pair: &[BodyState]| {
            let [before, after] = [&pair[0], &pair[1]];
            let rate = (of(after) - of(before)) / (after.time - before.time);
            (0.5 * (before.time + after.time), rate)
        };
        body.states.windows(2).map(between).filter(|(_, rate)| rate.is_finite()).collect()
    });
    Panel {
        axis: "acceleration (m/s\u{b2})",
        unit: "m/s\u{b2}",
        curves,
        band: Vec::new(),
        downward: false,
        leaves_out_zero: true,
    }
}

/// Whether a body goes anywhere but down: by more than a fiftieth of its depth.
fn moves_along(body: &BodyStates) -> bool {
    let start = body.states.first().map_or(0.0, |first| first.position.x);
    let most = |of: &dyn Fn(&BodyState) -> f64| {
        body.states.iter().fold(0.0_f64, |most, state| most.max(of(state).abs()))
    };
    most(&|state| state.position.x - start) > 0.02 * most(&|state| state.depth)
}

/// A curve for each body, and for each of two `directions` where bodies move along; `points` are times (s) and values.
fn curves(
    course: &Course,
    moves_along: bool,
    directions: [&str; 2],
    points: impl Fn(&BodyStates, bool) -> Vec<(f64, f64)>,
) -> Vec<Curve> {
    let one = course.bodies.len() == 1;
    let mut curves = Vec::new();
    for (at, body) in course.bodies.iter().enumerate() {
        let ways = if moves_along { &[false, true][..] } else { &[false] };
        for &along in ways {
            let direction = directions[usize::from(along)];
            let points = points(body, along).into_iter().map(|(time, value)| (1e3 * time, value));
            let points: Vec<_> = points.collect();
            if points.is_empty() {
                continue;
            }
            curves.push(Curve {
                name: if one {
                    direction.to_owned()
                } else {
                    format!("{}, {direction}", body.name)
                },
                sign: if along { Sign::Dashed(colour(at)) } else { Sign::Line(colour(at)) },
                along,
                points,
            });
        }
    }
    curves
}

/// Least acceleration that is more than the rounding of a set speed (m/s²).
const ROUNDING: f64 = 1e-6;

impl Panel {
    /// Whether it has curves, of an acceleration any that is not zero.
    fn shows_something(&self) -> bool {
        let mut points = self.curves.iter().flat_map(|curve| &curve.points);
        points.any(|(_, value)| !self.leaves_out_zero || value.abs() > ROUNDING)
    }

    fn picture(&self, stop: Option<f64>) -> Result<String, PictureError> {
        let rows: Vec<(Sign, String)> =
            self.curves.iter().map(|curve| (curve.sign, curve.name.clone())).collect();
        // What a single curve is, the axis says.
        let rows = if rows.len() > 1 { rows } else { Vec::new() };
        let legend = if rows.is_empty() { 0 } else { legend::height(rows.len()) };
        svg((PANEL.0, PANEL.1 + legend), |area| {
            let (chart, below) = area.split_vertically(PANEL.1);
            self.draw(&chart, stop)?;
            legend::draw(&below, &rows)
        })
    }

    fn draw(&self, area: &Area<'_>, stop: Option<f64>) -> Drawn {
        let points = || {
            let band =
                self.band.iter().flat_map(|[time, low, high]| [(*time, *low), (*time, *high)]);
            self.curves.iter().flat_map(|curve| curve.points.iter().copied()).chain(band)
        };
        let last = points().fold(0.0_f64, |last, point| last.max(point.0)).max(1e-9);
        let low = points().fold(0.0_f64, |low, point| low.min(point.1));
        let high = points().fold(1e-9_f64, |high, point| high.max(point.1));
        let pad = 0.06 * (high - low);
        let (low, high) = (if low < 0.0 { low - pad } else { low }, high + pad);
        let up = if self.downward { high..low } else { low..high };
        let mut chart = axes::chart(area, [0.0..last, up], 6, ["time (ms)", self.axis])?;
        let lower = self.band.iter().map(|[time, low, _]| (*time, *low));
        let upper = self.band.iter().rev().map(|[time, _, high]| (*time, *high));
        let outline: Vec<(f64, f64)> = lower.chain(upper).collect();
        if !outline.is_empty() {
            chart.draw_series([Polygon::new(outline, plots::GREY.filled())])?;
        }
        if let Some(stop) = stop.filter(|stop| *stop <= last) {
            let line = [(stop, low), (stop, high)];
            chart.draw_series(DashedLineSeries::new(line, 4, 4, BLACK.stroke_width(1)))?;
        }
        for curve in &self.curves {
            let points = curve.points.iter().copied();
            let (Sign::Line(ink) | Sign::Dashed(ink)) = curve.sign else { continue };
            let style = ink.stroke_width(2);
            match curve.along {
                true => chart.draw_series(DashedLineSeries::new(points, 6, 4, style))?,
                false => chart.draw_series(LineSeries::new(points, style))?,
            };
        }
        chart.draw_series(
            self.columns(last)
                .into_iter()
                .map(|([from, to], text)| Hover::over([(from, low), (to, high)], text)),
        )?;
        Ok(())
    }

    /// Parts of the time up to `last` (ms) with the values in them.
    fn columns(&self, last: f64) -> Vec<([f64; 2], String)> {
        let Some(first) = self.curves.first() else { return Vec::new() };
        let times: Vec<f64> = first.points.iter().map(|point| point.0).collect();
        let kept = places(&times, COLUMNS);
        let middle = |a: usize, b: usize| 0.5 * (times[a] + times[b]);
        let column = |(at, &place): (usize, &usize)| {
            let from = at.checked_sub(1).map_or(0.0, |before| middle(kept[before], place));
            let to = kept.get(at + 1).map_or(last, |&after| middle(place, after));
            let mut text = format!("{:.2} ms", times[place]);
            for curve in &self.curves {
                if let Some((_, value)) = curve.points.get(place) {
                    text.push_str(&format!("\n{}: {value:.3} {}", curve.name, self.unit));
                }
            }
            ([from, to], text)
        };
        kept.iter().enumerate().map(column).collect()
    }
}
