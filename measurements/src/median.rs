//! The median of several numbers, and the run that has it.

use crate::{MeasurementSet, Run};

/// The median of `numbers`, the upper of the two middle ones if their count is even; `None` if there are none. Numbers that are
/// not finite are ordered by [`f64::total_cmp`].
pub fn median(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = numbers.into_iter().collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied()
}

/// The median of the numbers that `of` gives for the runs of `set`, and the index of the run that has it. One wrong run does not
/// change it much.
pub(crate) fn of_runs(
    set: &MeasurementSet,
    of: impl Fn(&Run) -> Option<f64>,
) -> Option<(f64, usize)> {
    let each = set.runs.iter().enumerate();
    let mut all: Vec<(f64, usize)> = each.filter_map(|(at, run)| Some((of(run)?, at))).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.get(all.len() / 2).copied()
}

/// From the standard deviation of a normal number to the median of its size.
const MEDIAN_OF_SIZE: f64 = 0.6745;

/// The standard deviation of normal numbers of these `sizes`, by their median; zero where none is finite.
pub fn deviation_of(sizes: impl IntoIterator<Item = f64>) -> f64 {
    let finite = sizes.into_iter().filter(|size| size.is_finite());
    median(finite).unwrap_or(0.0) / MEDIAN_OF_SIZE
}
