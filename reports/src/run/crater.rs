//! The surface that an impact has left, over the one that it met.

use exchange::frames::CraterPoint;
use plots::axes;
use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, svg};
use plotters::prelude::*;

/// Size of the figure without its legend (pixels).
const SIZE: (u32, u32) = (400, 250);

/// The surfaces before and after, seen from the side; planar ones to both sides of the axis. None without both.
pub(super) fn picture(
    [before, after]: [&[CraterPoint]; 2],
    planar: bool,
) -> Result<Option<String>, PictureError> {
    if before.len() < 2 || after.len() < 2 {
        return Ok(None);
    }
    let surfaces = [before, after].map(curve);
    let rows = [
        (Sign::Dashed(BLACK), "undisturbed, at contact".to_owned()),
        (Sign::Line(colour(1)), "at the end of the run".to_owned()),
    ];
    let picture = svg((SIZE.0, SIZE.1 + legend::height(rows.len())), |area| {
        let (chart, below) = area.split_vertically(SIZE.1);
        draw(&chart, &surfaces, planar)?;
        legend::draw(&below, &rows)
    });
    picture.map(Some)
}

/// Distances and depths (mm).
fn curve(surface: &[CraterPoint]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        surface.iter().map(|at| (1e3 * at.distance, -1e3 * at.position.z)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

fn draw(area: &Area<'_>, surfaces: &[Vec<(f64, f64)>; 2], planar: bool) -> Drawn {
    let all = || surfaces.iter().flatten();
    let span = |of: fn(&(f64, f64)) -> f64| {
        all().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
    };
    let [left, right] = span(|point| point.0);
    let [high, low] = span(|point| point.1);
    let pad = (0.1 * (low - high)).max(1.0);
    let deep = (low + pad)..(high - pad);
    let across = if planar { "x from the axis (mm)" } else { "distance from the axis (mm)" };
    let mut chart = axes::chart(area, [left..right, deep.clone()], 6, [across, "depth (mm)"])?;
    let [before, after] = surfaces;
    chart.draw_series(DashedLineSeries::new(
        before.iter().copied(),
        5,
        4,
        BLACK.stroke_width(1),
    ))?;
    chart.draw_series(LineSeries::new(after.iter().copied(), colour(1).stroke_width(2)))?;
    let half = 0.5 * (right - left) / after.len() as f64;
    let column = |(at, depth): &(f64, f64)| {
        let corners = [(at - half, deep.start), (at + half, deep.end)];
        Hover::over(corners, format!("{at:.1} mm from the axis\ndepth {depth:.1} mm"))
    };
    chart.draw_series(after.iter().map(column))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crater_is_drawn_with_depth_downward() {
        let surface = |depth: f64| -> Vec<CraterPoint> {
            (-5..=5)
                .map(|at| {
                    let distance = 1e-3 * f64::from(at);
                    let z = -depth * (1.0 - (distance / 5e-3).powi(2));
                    CraterPoint { position: [distance, 0.0, z].into(), distance }
                })
                .collect()
        };
        let (flat, bowl) = (surface(0.0), surface(0.02));
        let picture = picture([&flat, &bowl], true).expect("drawn").expect("a picture");
        assert!(picture.contains("0.0 mm from the axis\ndepth 20.0 mm"), "{picture}");
        let line = picture.split("<polyline").find(|part| part.contains("#D55E00"));
        let points = line.and_then(|part| part.split("points=\"").nth(1)).expect("the crater");
        let y = |point: &str| point.split(',').nth(1).and_then(|y| y.trim().parse::<f64>().ok());
        let ys: Vec<f64> =
            points.split('"').next().expect("points").split(' ').filter_map(y).collect();
        assert!(ys[5] > ys[0] + 50.0, "the middle is lower on the screen: {ys:?}");
        assert!(super::picture([&[], &bowl], true).expect("drawn").is_none());
    }
}
