//! The axes that figures of two numbers share.

use std::ops::Range;

use plotters::chart::ChartContext;
use plotters::coord::ranged1d::{BoldPoints, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::{Area, Canvas, GREY, letters, rounded};

/// A chart of two numbers.
pub type Chart<'a, 'b> = ChartContext<'a, Canvas<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Width of a digit at the size of labels (pixels), of the widest letters that a browser may have.
const DIGIT: f64 = 7.4;

/// Least room around a chart, length of a tick with its gap, and height of a line of letters (pixels).
const MARGIN: u32 = 8;
const TICK: u32 = 10;
const LINE: u32 = 18;

/// Least gap between two numbers along x (pixels).
const GAP: f64 = 8.0;

/// Most digits behind the point of a number along an axis.
const MOST_DECIMALS: usize = 4;

/// A chart that leaves its numbers and names the room that they take.
pub struct Frame<'n> {
    /// What x and y run over.
    pub ranges: [Range<f64>; 2],
    /// About how many numbers stand along x and y; none along an axis of 0.
    pub ticks: [usize; 2],
    /// What the axes say; nothing for an empty name.
    pub names: [&'n str; 2],
    /// Room for a title above (pixels).
    pub above: u32,
    /// Room for what stands in place of numbers below (pixels).
    pub below: u32,
    /// Whether lines run through the numbers.
    pub grid: bool,
}

/// A chart that fills `area`, over the ranges `x` and `y`, with a grid, about `labels` numbers along x, and `names`.
pub fn chart<'a, 'b>(
    area: &'a Area<'b>,
    ranges: [Range<f64>; 2],
    labels: usize,
    names: [&str; 2],
) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
    Frame { ranges, ticks: [labels, 6], names, above: MARGIN, below: 0, grid: true }.draw(area)
}

impl Frame<'_> {
    /// Draws it in `area`.
    pub fn draw<'a, 'b>(
        self,
        area: &'a Area<'b>,
    ) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
        let [x, y] = self.ranges;
        let room = |name: &str| if name.is_empty() { 0 } else { LINE };
        let up = Ticks::of(&y, self.ticks[1]);
        let left = up.widest() as u32 + TICK + room(self.names[1]);
        let width = f64::from(area.dim_in_pixel().0.saturating_sub(left + 2 * MARGIN));
        let across = Ticks::that_fit(&x, self.ticks[0], width);
        let below = if across.texts.is_empty() { 0 } else { TICK + LINE };
        let below = below + room(self.names[0]) + self.below;
        let mut chart = ChartBuilder::on(area)
            .margin_top(self.above)
            .margin_left(MARGIN)
            .margin_right(MARGIN + across.beyond(&x, width))
            .margin_bottom(2)
            .x_label_area_size(below)
            .y_label_area_size(left)
            .build_cartesian_2d(x, y)?;
        let (step_x, step_y) = (across.step, up.step);
        let (format_x, format_y) =
            (move |value: &f64| tick(*value, step_x), move |value: &f64| tick(*value, step_y));
        let mut mesh = chart.configure_mesh();
        mesh.x_labels(across.asked)
            .y_labels(up.asked)
            .x_label_formatter(&format_x)
            .y_label_formatter(&format_y)
            .label_style(letters())
            .x_desc(self.names[0])
            .y_desc(self.names[1])
            .axis_desc_style(letters())
            .max_light_lines(0)
            .bold_line_style(GREY);
        if !self.grid {
            mesh.disable_mesh();
        } else {
            if across.asked == 0 {
                mesh.disable_x_mesh();
            }
            if up.asked == 0 {
                mesh.disable_y_mesh();
            }
        }
        mesh.draw()?;
        drop(mesh);
        Ok(chart)
    }
}

/// The numbers along an axis.
struct Ticks {
    /// How many of them are asked for.
    asked: usize,
    values: Vec<f64>,
    texts: Vec<String>,
    /// From one to the next.
    step: f64,
}

impl Ticks {
    fn of(range: &Range<f64>, asked: usize) -> Self {
        let coordinate = RangedCoordf64::from(range.clone());
        let values = if asked > 0 { coordinate.key_points(BoldPoints(asked)) } else { Vec::new() };
        let step = match values[..] {
            [first, second, ..] => (second - first).abs(),
            _ => (range.end - range.start).abs(),
        };
        let texts = values.iter().map(|value| tick(*value, step)).collect();
        Self { asked, values, texts, step }
    }

    /// As many of those `asked` for as stand side by side along `width` (pixels).
    fn that_fit(range: &Range<f64>, asked: usize, width: f64) -> Self {
        let ticks = Self::of(range, asked);
        let apart = ticks.step / (range.end - range.start).abs() * width;
        match asked > 1 && ticks.values.len() > 1 && ticks.widest() + GAP > apart {
            true => Self::that_fit(range, asked - 1, width),
            false => ticks,
        }
    }

    /// Width of the longest (pixels).
    fn widest(&self) -> f64 {
        self.texts.iter().map(|text| text.chars().count()).max().unwrap_or(0) as f64 * DIGIT
    }

    /// How far the last reaches beyond the end of `range`, which is `width` long (pixels).
    fn beyond(&self, range: &Range<f64>, width: f64) -> u32 {
        let share = |value: f64| (value - range.start) / (range.end - range.start);
        let ends = self.values.iter().zip(&self.texts).map(|(value, text)| {
            0.5 * DIGIT * text.chars().count() as f64 - (1.0 - share(*value)) * width
        });
        ends.fold(0.0, f64::max) as u32
    }
}

/// A number of an axis whose numbers are `step` apart: as many digits behind the point as the step has.
fn tick(value: f64, step: f64) -> String {
    // Sums of steps miss zero by their rounding.
    if value.abs() < 1e-6 * step {
        return "0".to_owned();
    }
    let is_whole = |decimals: &usize| {
        let steps = step * 10_f64.powi(*decimals as i32);
        steps > 0.5 && (steps - steps.round()).abs() < 1e-6 * steps
    };
    match (0..=MOST_DECIMALS).find(is_whole) {
        Some(decimals) if value.abs() < 1e6 => format!("{value:.decimals$}"),
        _ => format!("{:e}", rounded(value, 3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg;

    #[test]
    fn numbers_have_the_digits_of_their_step_and_no_negative_zero() {
        assert_eq!(tick(-1e-17, 0.1), "0");
        assert_eq!(tick(0.5, 0.25), "0.50");
        assert_eq!(tick(-20.0, 10.0), "-20");
        assert_eq!(tick(2e-8, 1e-8), "2e-8");
        assert_eq!(tick(2.5e7, 5e6), "2.5e7");
    }

    #[test]
    fn numbers_along_x_stand_apart_however_long_they_are() {
        let ticks = Ticks::that_fit(&(0.0..0.0999), 10, 200.0);
        let apart = ticks.step / 0.0999 * 200.0;
        assert!(ticks.values.len() > 1 && apart > ticks.widest(), "{:?}", ticks.texts);
    }

    /// The left ends of letters, of those that end at their place too.
    fn left_ends(picture: &str) -> Vec<f64> {
        let of = |from: &str| {
            let x: f64 = from.split(" x=\"").nth(1)?.split('"').next()?.parse().ok()?;
            let text = from.split('>').nth(1)?.split('<').next()?.trim();
            let ends = from.contains("text-anchor=\"end\"");
            Some(x - if ends { DIGIT * text.chars().count() as f64 } else { 0.0 })
        };
        let upright = |from: &&str| !from.contains("rotate");
        picture.split("<text").skip(1).filter(upright).filter_map(of).collect()
    }

    #[test]
    fn long_numbers_end_beside_the_name_of_their_axis() {
        let picture = svg((400, 280), |area| {
            chart(area, [0.0..25_000.0, 0.0..0.0012], 6, ["time (ms)", "velocity (m/s)"])?;
            Ok(())
        })
        .expect("a picture");
        let ends = left_ends(&picture);
        // The name is a line of letters beside the margin.
        let name = f64::from(MARGIN + LINE) - 4.0;
        assert!(ends.len() > 8 && ends.iter().all(|left| *left >= name), "{ends:?}");
    }
}
