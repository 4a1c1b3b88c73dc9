//! Points that are drawn: shares of ranges, each between 0 and 1.

use super::file::{Sample, SampleMethod};
use rand::RngExt;
use rand_pcg::Pcg64;

/// The shares of every point: one per range.
pub(crate) fn shares(sample: &Sample) -> Vec<Vec<f64>> {
    match sample.method {
        SampleMethod::LatinHypercube => latin_hypercube(sample),
        SampleMethod::Sobol => sobol(sample),
    }
}

/// Each range in as many slices as there are points, in an order of its own, and a place in each slice.
fn latin_hypercube(sample: &Sample) -> Vec<Vec<f64>> {
    let n = sample.count;
    let columns: Vec<Vec<f64>> = (0..sample.ranges.len())
        .map(|range| {
            let mut random = Pcg64::new(u128::from(sample.seed), range as u128);
            let mut slices: Vec<usize> = (0..n).collect();
            for last in (1..n).rev() {
                slices.swap(last, random.random_range(0..=last));
            }
            let place = |slice: usize| (slice as f64 + random.random::<f64>()) / n as f64;
            slices.into_iter().map(place).collect()
        })
        .collect();
    (0..n).map(|point| columns.iter().map(|column| column[point]).collect()).collect()
}

fn sobol(sample: &Sample) -> Vec<Vec<f64>> {
    // Of the seed the generator takes so many bits; counts are limited to those it has.
    let seed = sample.seed as u32 ^ (sample.seed >> 32) as u32;
    let share = |point: usize, range: usize| {
        f64::from(sobol_burley::sample(point as u32, range as u32, seed))
    };
    (0..sample.count)
        .map(|point| (0..sample.ranges.len()).map(|range| share(point, range)).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use crate::campaign::file::{SampledRange, Scale};

    use super::*;

    fn sample(method: SampleMethod, count: usize, seed: u64) -> Sample {
        let range = |key: &str| SampledRange {
            key: key.to_owned(),
            from: 0.0,
            to: 1.0,
            unit: None,
            scale: Scale::Linear,
            span: None,
        };
        Sample { method, count, seed, ranges: ["a", "b", "c"].map(range).to_vec() }
    }

    #[test]
    fn every_slice_of_every_range_holds_one_point_of_a_latin_hypercube() {
        let points = shares(&sample(SampleMethod::LatinHypercube, 50, 1));
        for range in 0..3 {
            let mut slices: Vec<usize> =
                points.iter().map(|point| (50.0 * point[range]) as usize).collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..50).collect::<Vec<_>>());
        }
    }

    #[test]
    fn every_elementary_box_of_a_scrambled_sobol_sequence_holds_one_point() {
        let points = shares(&sample(SampleMethod::Sobol, 64, 3));
        // The first two dimensions are a (0, 6, 2)-net: all boxes of 1/64 hold one point, whatever
        // their sides.
        for across in 0..=6 {
            let (columns, rows) = (1_usize << across, 1_usize << (6 - across));
            let mut boxes: Vec<usize> = points
                .iter()
                .map(|point| {
                    let [x, y] = [(point[0], columns), (point[1], rows)]
                        .map(|(share, n)| (share * n as f64) as usize);
                    x * rows + y
                })
                .collect();
            boxes.sort_unstable();
            assert_eq!(boxes, (0..64).collect::<Vec<_>>(), "{columns} by {rows}");
        }
    }

    #[test]
    fn equal_seeds_draw_equal_points_and_others_others() {
        for method in [SampleMethod::LatinHypercube, SampleMethod::Sobol] {
            let draw = |seed| shares(&sample(method, 20, seed));
            assert_eq!(draw(7), draw(7), "{method:?}");
            assert_ne!(draw(7), draw(8), "{method:?}");
        }
    }
}
