//! A measurement set as it was understood, before anything is fitted to it.

use measurements::{Condition, Kind, MeasurementSet, Run};
use plotters::prelude::*;

use super::curves::{COLUMNS, PANEL, a_panel_each, curves};
use super::panel::framed;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, fitting, letters, padded, short, svg};

/// Share of its time in which the speed of a run is near that of the impact.
const EARLY: f64 = 0.3;

/// What is drawn of sets without paths: a title, a factor, and the number of a run.
type Scalar = (&'static str, f64, fn(&Run) -> Option<f64>);

const SCALARS: [Scalar; 5] = [
    ("stopping time (ms)", 1e3, |run| run.stop_time),
    ("final depth (mm)", 1e3, |run| run.final_z),
    ("final range (mm)", 1e3, |run| run.final_x),
    ("crater depth (mm)", 1e3, |run| run.crater.depth),
    ("rim diameter (mm)", 1e3, |run| run.crater.rim_diameter),
];

/// Depth over time of every run beside the stated impact speed, or its curve, a panel per condition; of a set of
/// scalars, every number over the speed.
pub fn measured(set: &MeasurementSet) -> Result<String, PictureError> {
    match set.kind {
        Kind::Trajectory => paths(set),
        Kind::Scalar => scalars(set),
        Kind::ForceDepth | Kind::Acceleration | Kind::Velocity | Kind::Spin => curves(set),
    }
}

fn paths(set: &MeasurementSet) -> Result<String, PictureError> {
    let fall = "fall to first contact at the stated speed, and straight on: every run follows it before t = 0";
    let signs = [(Sign::Dashed(colour(1)), fall.to_owned())];
    a_panel_each(set, ("depth", &signs), |panel, condition, runs| {
        draw_paths(panel, condition, set.fall_of(condition), runs)
    })
}

fn draw_paths(area: &Area<'_>, condition: &Condition, falling: f64, runs: &[&Run]) -> Drawn {
    let Condition { id, speed, angle_deg, .. } = condition;
    let title =
        format!("{id}: {} m/s, {}\u{b0}, {} runs", short(*speed), short(*angle_deg), runs.len());
    area.draw(&Text::new(fitting(&title, PANEL.0 - 60), (52, 5), letters()))?;
    let frames = || runs.iter().flat_map(|run| &run.frames);
    let times = frames().map(|frame| 1e3 * frame.t);
    let (first, last) = (times.clone().fold(0.0, f64::min), times.fold(1e-3, f64::max));
    let depths = frames().map(|frame| 1e3 * frame.z);
    let (high, low) = (depths.clone().fold(0.0, f64::min), depths.fold(1e-3, f64::max));
    let down = padded(high, low);
    let mut chart =
        framed(area, [padded(first, last), down.end..down.start], ["time (ms)", "depth (mm)"])?;
    let sinking = speed * libm::sin(angle_deg.to_radians());
    let frame = [padded(first, last), down];
    let line = fall(sinking, falling, [first, EARLY * last], &frame);
    chart.draw_series(DashedLineSeries::new(line, 5, 4, colour(1).stroke_width(2)))?;
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

/// Points of the free fall before contact that are joined by straight lines.
const FALL_POINTS: usize = 24;

/// Free fall up to contact, then constant velocity: points (ms, mm) between the times `from` and `to`, clipped to the axes.
/// The velocity at contact is `speed` (m/s), the acceleration before it `falling` (m/s²).
fn fall(
    speed: f64,
    falling: f64,
    [from, to]: [f64; 2],
    [times, depths]: &[std::ops::Range<f64>; 2],
) -> Vec<(f64, f64)> {
    let before = (0..FALL_POINTS).map(|k| from * (1.0 - k as f64 / FALL_POINTS as f64));
    // In ms and mm, 1 m/s is 1 and 1 m/s² is 1/1000.
    let depth = |t: f64| speed * t + 0.5e-3 * falling * t.min(0.0).powi(2);
    let points: Vec<(f64, f64)> = before.chain([0.0, to]).map(|time| (time, depth(time))).collect();
    let mut line: Vec<(f64, f64)> = Vec::new();
    for (a, b) in points.iter().zip(&points[1..]) {
        let Some((a, b)) = clipped((*a, *b), times, depths) else { continue };
        if line.last() != Some(&a) {
            line.push(a);
        }
        line.push(b);
    }
    line
}

/// The part of a stretch that lies within both ranges.
fn clipped(
    (a, b): ((f64, f64), (f64, f64)),
    times: &std::ops::Range<f64>,
    depths: &std::ops::Range<f64>,
) -> Option<((f64, f64), (f64, f64))> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (start, way, range) in [(a.0, b.0 - a.0, times), (a.1, b.1 - a.1, depths)] {
        if way == 0.0 {
            if !(range.start..=range.end).contains(&start) {
                return None;
            }
            continue;
        }
        let [one, other] = [range.start, range.end].map(|edge| (edge - start) / way);
        (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
    }
    let at = |share: f64| (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1));
    (from < to).then(|| (at(from), at(to)))
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
    let mut chart =
        framed(area, [0.0..1.05 * fastest, 0.0..1.1 * scale * most], ["impact speed (m/s)", ""])?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_sets::{condition, set, trajectory_run};

    /// Numbers after `key="` in the text of an element.
    fn number(element: &str, key: &str) -> Option<f64> {
        let rest = element.split(&format!(" {key}=\"")).nth(1)?;
        rest.split('"').next()?.parse().ok()
    }

    /// Places in a drawing (pixels).
    type Places = Vec<(f64, f64)>;

    /// Points of the dashed line, and places of the readings in their order.
    fn drawn(speed: f64, path: impl Fn(f64) -> f64) -> (Places, Places) {
        let run = trajectory_run(0, |t| (path(t), 0.0));
        let set = set(Kind::Trajectory, vec![condition(speed, 90.0)], vec![run]);
        let svg = measured(&set).expect("a drawing");
        let red = colour(1).to_backend_color().rgb;
        let red = format!("#{:02X}{:02X}{:02X}", red.0, red.1, red.2);
        let ends = |line: &str| {
            let points = line.split(" points=\"").nth(1)?.split('"').next()?;
            let point = |text: &str| {
                let (x, y) = text.split_once(',')?;
                Some((x.parse().ok()?, y.parse().ok()?))
            };
            Some(points.split_whitespace().filter_map(point).collect::<Places>())
        };
        let panel = svg.lines().filter(|line| line.contains("polyline") && line.contains(&red));
        let points = panel.filter_map(ends).flatten();
        // Below the panels, the legend has a stretch of it too.
        let line: Vec<(f64, f64)> = points.filter(|point| point.1 < f64::from(PANEL.1)).collect();
        let circles = svg.split("<circle").skip(1);
        let readings = circles.filter_map(|one| Some((number(one, "cx")?, number(one, "cy")?)));
        (line, readings.collect())
    }

    #[test]
    fn the_line_of_the_fall_is_bent_before_contact_and_cut_off_where_it_leaves_the_frame() {
        let frame = [-60.0..550.0, -70.0..60.0];
        let line = fall(2.8, 9.81, [-50.0, 150.0], &frame);
        // At 2.8 m/s the line leaves 60 mm after 21.4 ms, far from the end of a long clip.
        let last = line[line.len() - 1];
        assert!((last.0 - 60.0 / 2.8).abs() < 1e-9 && (last.1 - 60.0).abs() < 1e-9, "{last:?}");
        for (t, z) in &line {
            let free = 2.8 * t + 0.5e-3 * 9.81 * t.min(0.0).powi(2);
            // Chords of two milliseconds lie 0.005 mm beside a parabola of that curvature.
            assert!((z - free).abs() < 0.01, "{t} {z}");
            assert!(frame[0].contains(t) && (*z <= 60.0 + 1e-9 && *z >= -70.0), "{t} {z}");
        }
        // Before the cut at the upper edge nothing is drawn.
        assert!(line[0].1 <= -69.0, "{:?}", line[0]);
    }

    #[test]
    fn the_line_as_drawn_has_the_slope_of_the_readings_at_contact() {
        // The clip goes on for half a second after a stop within 60 mm.
        let path = |t: f64| match t < 0.0 {
            true => 2.8 * t + 0.5 * 9.81 * t * t,
            false => 0.06 * (1.0 - libm::exp(-2.8 * t / 0.06)),
        };
        let (line, readings) = drawn(2.8, path);
        assert!(line.len() > 4 && readings.len() == 275, "{} {}", line.len(), readings.len());
        // Readings 25 frames before contact and at it: the line of the fall joins them, in pixels.
        let [before, contact] = [readings[0], readings[25]];
        for (x, y) in line.iter().filter(|point| point.0 <= contact.0) {
            let share = (x - before.0) / (contact.0 - before.0);
            // Between them the parabola bends by g T²/8 = 3 mm of 132 mm, less than 5 of 170 pixels.
            let chord = before.1 + share * (contact.1 - before.1);
            assert!((y - chord).abs() < 6.0, "{x} {y}, chord {chord}");
        }
        let beyond: Vec<_> = line.iter().filter(|point| point.0 > contact.0 + 1.0).collect();
        let last = beyond[beyond.len() - 1];
        let drawn = (last.1 - contact.1) / (last.0 - contact.0);
        let ms = (contact.0 - before.0) / 50.0;
        let mm = (contact.1 - before.1) / (2.8 * 50.0 - 0.5e-3 * 9.81 * 2500.0);
        // 2.8 mm in a millisecond; a pixel is a third of that.
        assert!((drawn / (2.8 * mm / ms) - 1.0).abs() < 0.15, "{drawn}, {}", 2.8 * mm / ms);
    }
}
