//! The axes that figures of two numbers share.

use std::ops::Range;

use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::{Area, Canvas, GREY, letters, short};

/// A chart of two numbers.
pub type Chart<'a, 'b> = ChartContext<'a, Canvas<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A chart that fills `area`, over the ranges `x` and `y`, with a grid, about `labels` numbers along x, and `names`.
///
/// # Errors
/// What drawing comes to.
pub fn chart<'a, 'b>(
    area: &'a Area<'b>,
    [x, y]: [Range<f64>; 2],
    labels: usize,
    names: [&str; 2],
) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_labels(labels)
        .y_labels(6)
        .x_label_formatter(&|value| short(*value))
        .y_label_formatter(&|value| short(*value))
        .label_style(letters())
        .x_desc(names[0])
        .y_desc(names[1])
        .axis_desc_style(letters())
        .light_line_style(WHITE)
        .bold_line_style(GREY)
        .draw()?;
    Ok(chart)
}
