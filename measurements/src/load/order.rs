//! The order of runs, which names and rows of the file do not decide.

use std::cmp::Ordering;

use crate::{Frame, Run, Sample};

/// Sorts by condition, then by repeat, place in time and the numbers measured.
pub(crate) fn sort(runs: &mut [Run]) {
    runs.sort_by(compare);
}

fn compare(a: &Run, b: &Run) -> Ordering {
    let labels = |run: &Run| (run.condition, run.repeat, run.order);
    let frames = || {
        let pairs = a.frames.iter().zip(&b.frames).map(|(a, b)| compare_frames(a, b));
        pairs.fold(Ordering::Equal, Ordering::then).then(a.frames.len().cmp(&b.frames.len()))
    };
    let samples = || {
        let pairs = a.samples.iter().zip(&b.samples).map(|(a, b)| compare_samples(a, b));
        pairs.fold(Ordering::Equal, Ordering::then).then(a.samples.len().cmp(&b.samples.len()))
    };
    labels(a)
        .cmp(&labels(b))
        .then_with(|| numbers(a.stop_time, b.stop_time))
        .then_with(|| numbers(a.final_z, b.final_z))
        .then_with(|| numbers(a.final_x, b.final_x))
        .then_with(|| numbers(a.crater.depth, b.crater.depth))
        .then_with(|| numbers(a.crater.rim_diameter, b.crater.rim_diameter))
        .then_with(frames)
        .then_with(samples)
        // Runs that are equal but for their name: nothing but the name is at stake.
        .then_with(|| a.name.cmp(&b.name))
}

fn compare_frames(a: &Frame, b: &Frame) -> Ordering {
    a.t.total_cmp(&b.t)
        .then(a.z.total_cmp(&b.z))
        .then(a.x.total_cmp(&b.x))
        .then(numbers(a.sigma, b.sigma))
}

fn compare_samples(a: &Sample, b: &Sample) -> Ordering {
    a.at.total_cmp(&b.at).then(a.value.total_cmp(&b.value)).then(numbers(a.sigma, b.sigma))
}

fn numbers(a: Option<f64>, b: Option<f64>) -> Ordering {
    match (a, b) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        (a, b) => a.is_some().cmp(&b.is_some()),
    }
}
