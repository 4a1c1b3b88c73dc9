//! Points with their errors under curves, a panel per condition.

use plotters::prelude::*;

use plots::legend::{self, Sign};
use plots::{Area, Drawn, Hover, PictureError, colour, letters, short, svg};

/// Size of a panel (pixels).
const PANEL: (u32, u32) = (330, 240);

/// Most panels side by side.
const ACROSS: usize = 3;

/// Panels that share their axes' names and their legend.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Names and units of both axes.
    pub axes: [&'static str; 2],
    /// What the series are, by the numbers of their colours.
    pub names: Vec<String>,
    /// What is drawn.
    pub panels: Vec<Panel>,
}

/// One panel.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Its title.
    pub title: String,
    /// Points.
    pub points: Vec<Points>,
    /// Curves, by the numbers of their colours.
    pub curves: Vec<(usize, Vec<(f64, f64)>)>,
}

/// Points of one colour.
#[derive(Clone, Debug)]
pub struct Points {
    /// Number of the colour.
    pub series: usize,
    /// Where they are, and their standard errors upward and downward.
    pub places: Vec<(f64, f64, f64)>,
}

impl Plot {
    /// As SVG.
    pub fn draw(&self) -> Result<String, PictureError> {
        let columns = self.panels.len().clamp(1, ACROSS);
        let rows = self.panels.len().div_ceil(columns).max(1);
        let signs: Vec<(Sign, String)> = self
            .names
            .iter()
            .enumerate()
            .map(|(at, name)| (Sign::Line(colour(at)), name.clone()))
            .collect();
        let height = PANEL.1 * rows as u32;
        // One panel alone is as wide as two.
        let width = PANEL.0 * columns.max(2) as u32;
        svg((width, height + legend::height(signs.len())), |area| {
            let (charts, below) = area.split_vertically(height);
            let charts = charts.split_evenly((rows, columns));
            for (panel, chart) in self.panels.iter().zip(&charts) {
                self.draw_panel(panel, chart)?;
            }
            legend::draw(&below, &signs)
        })
    }

    fn draw_panel(&self, panel: &Panel, area: &Area<'_>) -> Drawn {
        area.draw(&Text::new(panel.title.clone(), (56, 6), letters()))?;
        let points = || panel.points.iter().flat_map(|one| &one.places);
        let curves = || panel.curves.iter().flat_map(|(_, curve)| curve);
        let x = range(points().map(|p| p.0).chain(curves().map(|p| p.0)));
        let ends = points().flat_map(|&(_, y, e)| [y - e, y + e]);
        let y = range(ends.chain(curves().map(|p| p.1)));
        let mut chart = ChartBuilder::on(area)
            .margin_top(24)
            .margin_left(4)
            .margin_right(10)
            .x_label_area_size(36)
            .y_label_area_size(52)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(5)
            .y_labels(5)
            .x_desc(self.axes[0])
            .y_desc(self.axes[1])
            .draw()?;
        for (series, curve) in &panel.curves {
            let stroke = colour(*series).stroke_width(2);
            chart.draw_series(LineSeries::new(curve.iter().copied(), stroke))?;
        }
        for Points { series, places } in &panel.points {
            let colour = colour(*series);
            for &(x, y, error) in places {
                let bar = vec![(x, y - error), (x, y + error)];
                chart.draw_series([PathElement::new(bar, colour.stroke_width(1))])?;
                chart.draw_series([Circle::new((x, y), 3, colour.filled())])?;
                let text = format!(
                    "{}, {}\n{}: {} ± {} at {}",
                    panel.title,
                    self.names[*series],
                    self.axes[1],
                    short(y),
                    short(error),
                    short(x)
                );
                chart.draw_series([Hover::at((x, y), text)])?;
            }
        }
        Ok(())
    }
}

/// From below the least of `values` to above the greatest.
fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return 0.0..1.0;
    }
    let pad = if high > low { 0.08 * (high - low) } else { 0.5 * high.abs().max(1.0) };
    low - pad..high + pad
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_says_its_value_and_no_panel_has_numbers_that_are_none() {
        let places = vec![(1.0, 0.2, 0.01), (2.0, 0.1, 0.0)];
        let panel = Panel {
            title: "90 deg".to_owned(),
            points: vec![Points { series: 0, places }],
            curves: vec![(1, vec![(1.0, 0.2), (2.0, 0.15)])],
        };
        let names = vec!["ours".to_owned(), "published".to_owned()];
        let empty = Panel::default();
        let plot = Plot { axes: ["speed (m/s)", "time (s)"], names, panels: vec![panel, empty] };
        let svg = plot.draw().expect("a picture");
        assert!(svg.contains("time (s): 0.2 ± 0.01 at 1"), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
