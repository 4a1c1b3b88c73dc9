//! The frame of a panel: room for its title, its axes and their names.

use std::ops::Range;

use plots::Area;
pub(super) use plots::axes::Chart;
use plots::axes::Frame;
use plotters::prelude::*;

/// A chart in `area` over `ranges`, with a grid and the names `names` of its axes; no name for an empty one.
pub(super) fn framed<'a, 'b>(
    area: &'a Area<'b>,
    ranges: [Range<f64>; 2],
    names: [&str; 2],
) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
    Frame { ranges, ticks: [5, 5], names, above: 24, below: 0, grid: true }.draw(area)
}
