//! The frame of a panel: room for its title, its axes and their names.

use std::ops::Range;

pub(super) use plots::axes::Chart;
use plots::{Area, GREY};
use plotters::prelude::*;

/// A chart in `area` over `x` and `y`, with a grid and the names `names` of its axes; no name for an empty one.
pub(super) fn framed<'a, 'b>(
    area: &'a Area<'b>,
    [x, y]: [Range<f64>; 2],
    names: [&str; 2],
) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin_top(24)
        .margin_left(6)
        .margin_right(10)
        .x_label_area_size(34)
        .y_label_area_size(46)
        .build_cartesian_2d(x, y)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_labels(5).y_labels(5).light_line_style(WHITE).bold_line_style(GREY);
    mesh.x_desc(names[0]).y_desc(names[1]).draw()?;
    Ok(chart)
}
